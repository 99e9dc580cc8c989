// render: a still of the field, with its auxiliary images.
#include <fmt/format.h>

#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "cli/close_up.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/leaves.h"
#include "cli/picture_files.h"
#include "cli/recipe_render.h"
#include "cli/units.h"
#include "raytrace/film.h"
#include "raytrace/render.h"

namespace cambium {
namespace {

std::set<Aov> requested_aovs(const CommandLine& line) {
  std::set<Aov> aovs;
  for (const std::string& name : line.aovs) {
    if (name == "all") {
      for (const AovInfo& info : all_aovs()) aovs.insert(info.aov);
      continue;
    }
    try {
      aovs.insert(aov_named(name));
    } catch (const InputError& error) {
      throw InputError({"--aov"}, error.found(), "all or " + error.expected());
    }
  }
  return aovs;
}

RenderOptions render_options(const Job& job) {
  RenderOptions options = job.recipe.render;
  const CommandLine& line = job.line;
  if (!line.size.empty()) std::tie(options.width, options.height) = parse_image_size(line.size, {"--size"});
  if (!line.samples.empty()) set_samples(parse_samples(line.samples, {"--samples"}), options.sampling);
  if (line.noise) {
    if (!(*line.noise >= 0 && *line.noise <= 1)) throw InputError({"--noise"}, fmt::format("{}", *line.noise), "a number from 0 to 1");
    options.sampling.noise = *line.noise;
  }
  if (line.bounces) {
    if (*line.bounces < 0 || *line.bounces > kMostBounces)
      throw InputError({"--bounces"}, fmt::format("{}", *line.bounces), fmt::format("0 to {}", kMostBounces));
    options.paths.bounces = *line.bounces;
  }
  if (!line.crop.empty()) options.crop = parse_crop(line.crop, {"--crop"});
  check_crop(options, {line.crop.empty() ? line.input : "--crop"});
  options.bark = load_bark(job.recipe);
  options.aovs = requested_aovs(line);
  options.light.environment = load_surroundings(job.recipe.render);
  return options;
}

/// One picture of those that a command line asks for.
struct Picture {
  std::filesystem::path path;
  std::optional<Turntable> turn;
};

/// One, those of a turntable, or a single frame of it.
std::vector<Picture> pictures_of(const CommandLine& line) {
  if (!line.turntable) {
    if (line.frame) throw InputError({"--frame"}, fmt::format("frame {} without a turntable", *line.frame), "--turntable N beside it");
    return {{line.output, {}}};
  }
  const int frames = *line.turntable;
  if (line.frame && *line.frame > frames) {
    throw InputError({"--frame"}, fmt::format("frame {}", *line.frame), fmt::format("1 to {}", frames));
  }
  std::vector<Picture> pictures;
  for (int number = line.frame.value_or(1); number <= line.frame.value_or(frames); ++number)
    pictures.push_back({numbered_path(line.output, number), Turntable{number - 1, frames}});
  return pictures;
}

void refuse_for_jpeg(const CommandLine& line, const RenderOptions& options) {
  if (line.bits != 8) throw InputError({"--bits"}, fmt::format("{} bits of a .jpg", line.bits), "8, or a .png");
  if (options.light.backdrop == Backdrop::kTransparent) throw InputError({line.output}, "a .jpg of a transparent picture", ".png or .exr");
}

void report(Job& job, const Rendered& rendered) {
  const RenderReport& report = rendered.report;
  job.figures.set("width", rendered.film.width);
  job.figures.set("height", rendered.film.height);
  job.figures.set("cells", report.cells);
  job.figures.set("rays", report.rays);
  job.figures.set("samples", report.samples);
  job.figures.set("samples_per_pixel", report.samples_per_pixel);
  job.figures.add_seconds("render_trace", report.seconds_trace);
  job.figures.add_seconds("render_develop", report.seconds_develop);
}

/// Renders and writes one picture. Interrupted after its first pass it is still written, and job.warnings says so.
Outcome make_picture(Job& job, const Renderer& renderer, const RenderOptions& options, PictureFiles& files) {
  const auto rendered = [&] {
    const StageTimer timer(job.figures, "render");
    return renderer.render(options, job.run, [](int) { take_time_to_finish(); });
  }();
  if (!rendered) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  files.write(rendered->film);
  files.commit();
  report(job, *rendered);
  if (!rendered->interrupted) return Outcome::kDone;
  job.warnings.push_back(fmt::format("{} holds the last finished pass: up to {} of {} samples a pixel", files.path().string(),
                                     rendered->report.samples, options.sampling.max));
  return Outcome::kInterrupted;
}

}  // namespace

Outcome run_render(Job& job) {
  const ImageFormat format{require_extension(job.line.output, {".png", ".jpg", ".exr"}), job.line.bits};
  RenderOptions options = render_options(job);
  if (format.extension == ".jpg") refuse_for_jpeg(job.line, options);
  const std::vector<Picture> pictures = pictures_of(job.line);
  std::optional<PictureFiles> files(std::in_place, pictures.front().path, format, options.aovs);   // so that a bad path fails now
  const auto built = build_tree(job);
  if (!built || job.run.cancelled()) return Outcome::kInterrupted;
  const Field field = compile_field(job, built->tree);
  job.figures.set("primitives", field.atom_count());
  if (job.line.close_up) job.recipe.render.close_up = NamedBranch{*job.line.close_up, {"--close-up"}};
  aim_at_branches(job.recipe.render, field, built->branches);
  options.camera = job.recipe.render.camera;
  if (!options.light.ground_height) options.light.ground_height = built->ground;
  Leaves leaves = dress_leaves(job, *built);
  const auto renderer = [&] {
    const StageTimer timer(job.figures, "render_cover");
    return Renderer::make(field, job.run, std::move(leaves.scene));
  }();
  if (!renderer) return Outcome::kInterrupted;
  Json written = Json::array();
  for (const Picture& picture : pictures) {
    if (!files) files.emplace(picture.path, format, options.aovs);
    options.camera.turntable = picture.turn;
    if (make_picture(job, *renderer, options, *files) == Outcome::kInterrupted) return Outcome::kInterrupted;
    if (const Json names = files->names_beside(); !names.empty()) job.figures.set("aovs", names);
    written.push_back(picture.path.string());
    files.reset();
  }
  if (job.line.turntable) job.figures.set("frames", written);
  return Outcome::kDone;
}

}  // namespace cambium
