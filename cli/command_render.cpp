// render: a still of the field, with its auxiliary images.
#include <memory>
#include <set>
#include <tuple>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "cli/units.h"
#include "raytrace/film.h"
#include "raytrace/render.h"

namespace cambium {
namespace {

std::set<std::string> requested_aovs(const CommandLine& line) {
  std::set<std::string> aovs;
  for (const std::string& name : line.aovs) {
    if (name != "depth" && name != "normal" && name != "albedo" && name != "branch")
      throw InputError({"--aov"}, "'" + name + "'", "depth, normal, albedo or branch");
    aovs.insert(name);
  }
  return aovs;
}

RenderOptions render_options(const Job& job) {
  RenderOptions options = job.recipe.render;
  const CommandLine& line = job.line;
  if (!line.size.empty()) std::tie(options.width, options.height) = parse_image_size(line.size, {"--size"});
  if (line.samples) {
    if (*line.samples < 1 || *line.samples > 65536)
      throw InputError({"--samples"}, std::to_string(*line.samples), "1 to 65536");
    options.samples = *line.samples;
  }
  options.bark = load_bark(job.recipe);
  return options;
}

/// An auxiliary image beside a PNG: tree.png has tree.depth.png.
struct AovFile {
  std::string name;
  std::filesystem::path path;
  std::unique_ptr<OutputFile> file;
};

std::vector<AovFile> aov_files(const std::filesystem::path& image, const std::set<std::string>& aovs) {
  std::vector<AovFile> files;
  for (const std::string& name : aovs) {
    std::filesystem::path path = image;
    path.replace_extension("." + name + image.extension().string());
    files.push_back({name, path, std::make_unique<OutputFile>(path)});
  }
  return files;
}

}  // namespace

Outcome run_render(Job& job) {
  const std::string format = require_extension(job.line.output, {".png", ".exr"});
  const std::set<std::string> aovs = requested_aovs(job.line);
  const RenderOptions options = render_options(job);
  OutputFile output(job.line.output);
  const std::vector<AovFile> beside = format == ".png" ? aov_files(job.line.output, aovs) : std::vector<AovFile>{};
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  std::optional<Rendered> rendered;
  {
    const StageTimer timer(job.figures, "render");
    rendered = render(*field, options, job.run);
  }
  if (!rendered) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  write_image(rendered->film, output.temporary(), format, aovs);
  for (const AovFile& aov : beside) write_aov(rendered->film, aov.file->temporary(), aov.name);
  const RenderReport& report = rendered->report;
  job.figures.set("width", rendered->film.width);
  job.figures.set("height", rendered->film.height);
  job.figures.set("primitives", field->atom_count());
  job.figures.set("cells", report.cells);
  job.figures.set("rays", report.rays);
  job.figures.set("samples_per_pixel", report.samples_per_pixel);
  job.figures.add_seconds("render_cover", report.seconds_cover);
  job.figures.add_seconds("render_trace", report.seconds_trace);
  Json names = Json::object();
  for (const AovFile& aov : beside) names[aov.name] = aov.path.string();
  if (!names.empty()) job.figures.set("aovs", names);
  if (job.run.cancelled()) return Outcome::kInterrupted;
  for (const AovFile& aov : beside) aov.file->commit();
  output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
