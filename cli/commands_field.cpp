// eval, mesh, volume: what can be made of the field without looking at it.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "cli/points_csv.h"
#include "cli/units.h"
#include "polygonize/mesh_io.h"
#include "polygonize/polygonize.h"
#include "polygonize/volume.h"
#include "raytrace/bark.h"

namespace cambium {
namespace {

/// nullopt if interrupted.
std::optional<std::vector<Sample>> sample_field(const Field& field, const std::vector<Vec3>& points, const RunOptions& run) {
  std::vector<Sample> samples(points.size());
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 64), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end() && !run.cancelled(); ++i) samples[i] = field.sample(points[i]);
    });
  });
  if (run.cancelled()) return std::nullopt;
  return samples;
}

std::uint8_t srgb_byte(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double srgb = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

PolygonizeOptions mesh_options(const Job& job) {
  PolygonizeOptions options = job.recipe.mesh;
  const CommandLine& line = job.line;
  if (!line.voxel.empty()) {
    options.voxel = parse_positive_length(line.voxel, {"--voxel"});
    options.tolerance.reset();
  }
  if (!line.tolerance.empty()) {
    options.tolerance = parse_positive_length(line.tolerance, {"--tolerance"});
    options.voxel.reset();
  }
  if (line.max_triangles) options.max_triangles = line.max_triangles;
  if (options.max_triangles && *options.max_triangles == 0) throw InputError({"--max-triangles"}, "0", "at least 1");
  return options;
}

UpAxis up_axis(const std::string& name) {
  if (name.empty() || name == "z") return UpAxis::kZ;
  if (name == "y") return UpAxis::kY;
  throw InputError({"--up"}, "'" + name + "'", "y or z");
}

VolumeOptions volume_options(const Job& job) {
  VolumeOptions options = job.recipe.volume;
  const CommandLine& line = job.line;
  if (!line.voxel.empty()) options.voxel = parse_positive_length(line.voxel, {"--voxel"});
  if (line.kind == "sdf")
    options.kind = VolumeKind::kSdf;
  else if (line.kind == "field")
    options.kind = VolumeKind::kField;
  else if (line.kind == "fog")
    options.kind = VolumeKind::kFog;
  else if (!line.kind.empty())
    throw InputError({"--kind"}, "'" + line.kind + "'", "sdf, field or fog");
  return options;
}

}  // namespace

Outcome run_eval(Job& job) {
  OutputFile output(job.line.output);
  const std::vector<Vec3> points = read_points(job.line.points);
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  std::optional<std::vector<Sample>> samples;
  {
    const StageTimer timer(job.figures, "evaluate");
    samples = sample_field(*field, points, job.run);
  }
  if (!samples) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  write_text(output.temporary(), samples_as_csv(points, *samples));
  job.figures.set("points", points.size());
  if (job.run.cancelled()) return Outcome::kInterrupted;
  output.commit();
  return Outcome::kDone;
}

Outcome run_mesh(Job& job) {
  const std::string format = require_extension(job.line.output, {".obj", ".ply", ".stl", ".off", ".glb"});
  PolygonizeOptions options = mesh_options(job);
  const UpAxis up = up_axis(job.line.up);
  OutputFile output(job.line.output);
  const Bark bark(load_bark(job.recipe), job.recipe.render.seed);
  if (format != ".stl")  // which has no colours
    options.color = [&bark](Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal) {
      const Vec3 albedo = bark.albedo(evaluator, field, p, normal);
      return std::array<std::uint8_t, 4>{srgb_byte(albedo.x), srgb_byte(albedo.y), srgb_byte(albedo.z), 255};
    };
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  std::optional<Polygonized> made;
  {
    const StageTimer timer(job.figures, "polygonize");
    made = polygonize(*field, options, job.run);
  }
  if (!made) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  write_mesh(made->mesh, output.temporary(), format, up);
  const PolygonizeReport& report = made->report;
  job.figures.set("primitives", field->atom_count());
  job.figures.set("triangles", made->mesh.triangles.size());
  job.figures.set("vertices", made->mesh.positions.size());
  job.figures.set("components", report.components);
  job.figures.set("voxel", report.voxel);
  job.figures.set("cells", report.cells);
  job.figures.set("thin_primitives", report.thin_primitives);
  job.figures.set("thin_length", report.thin_length);
  job.figures.set("thinnest_radius", report.thinnest_radius);
  job.figures.set("ambiguous_faces", report.ambiguous_faces);
  job.figures.set("largest_distance", report.largest_distance);
  if (job.run.cancelled()) return Outcome::kInterrupted;
  output.commit();
  return Outcome::kDone;
}

Outcome run_volume(Job& job) {
  require_extension(job.line.output, {".vdb"});
  const VolumeOptions options = volume_options(job);
  OutputFile output(job.line.output);
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  std::optional<VolumeReport> report;
  {
    const StageTimer timer(job.figures, "volume");
    report = write_volume(*field, options, output.temporary(), job.run);
  }
  if (!report || job.run.cancelled()) return Outcome::kInterrupted;
  job.figures.set("active_voxels", report->active_voxels);
  job.figures.set("voxel", report->voxel);
  output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
