// render: a still of the field, with its auxiliary images.
#include <fmt/format.h>

#include <memory>
#include <set>
#include <tuple>

#include "cli/close_up.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/output_file.h"
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

/// The files of one picture: itself, and beside a PNG its auxiliary images: tree.png has tree.depth.png.
class PictureFiles {
 public:
  PictureFiles(const std::filesystem::path& path, const ImageFormat& format, const std::set<Aov>& aovs)
      : format_(format), image_(path) {
    if (format.extension != ".png") return;
    for (const Aov aov : aovs) {
      std::filesystem::path beside = path;
      beside.replace_extension(std::string(".") + info_of(aov).name + path.extension().string());
      beside_.push_back({aov, beside, std::make_unique<OutputFile>(beside)});
    }
  }

  void write(const Film& film) {
    write_image(film, image_.temporary(), format_);
    for (const Beside& aov : beside_) write_aov(film, aov.file->temporary(), aov.aov);
  }

  void commit() {
    for (const Beside& aov : beside_) aov.file->commit();
    image_.commit();
  }

  /// Their names by what they show; empty for an EXR.
  Json names_beside() const {
    Json names = Json::object();
    for (const Beside& aov : beside_) names[info_of(aov.aov).name] = aov.path.string();
    return names;
  }

 private:
  struct Beside {
    Aov aov;
    std::filesystem::path path;
    std::unique_ptr<OutputFile> file;
  };

  ImageFormat format_;
  OutputFile image_;
  std::vector<Beside> beside_;
};

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

/// Renders and writes one picture. Interrupted after its first pass it is still written.
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
  job.warnings.push_back(fmt::format("{} holds the last finished pass: up to {} of {} samples a pixel", job.line.output,
                                     rendered->report.samples, options.sampling.max));
  return Outcome::kInterrupted;
}

}  // namespace

Outcome run_render(Job& job) {
  const ImageFormat format{require_extension(job.line.output, {".png", ".exr"}), job.line.bits};
  RenderOptions options = render_options(job);
  PictureFiles files(job.line.output, format, options.aovs);
  const auto built = build_tree(job);
  if (!built || job.run.cancelled()) return Outcome::kInterrupted;
  const Field field = compile_field(job, built->tree);
  job.figures.set("primitives", field.atom_count());
  aim_at_branches(job.recipe.render, field, built->branches);
  options.camera = job.recipe.render.camera;
  const auto renderer = [&] {
    const StageTimer timer(job.figures, "render_cover");
    return Renderer::make(field, job.run);
  }();
  if (!renderer) return Outcome::kInterrupted;
  const Outcome outcome = make_picture(job, *renderer, options, files);
  if (const Json names = files.names_beside(); !names.empty()) job.figures.set("aovs", names);
  return outcome;
}

}  // namespace cambium
