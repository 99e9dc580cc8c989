// mesh: a closed triangle mesh of the surface, in stages: what is asked, the field, the mesh, the file.
#include <algorithm>
#include <array>
#include <cmath>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "cli/units.h"
#include "polygonize/mesh_io.h"
#include "polygonize/polygonize.h"
#include "raytrace/bark.h"

namespace cambium {
namespace {

/// What the recipe and the flags ask for, checked before any work.
struct MeshRequest {
  std::string format;   ///< extension of the output, with its dot
  UpAxis up = UpAxis::kZ;
  PolygonizeOptions polygonize;
};

std::uint8_t srgb_byte(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double srgb = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

UpAxis up_axis(const std::string& name) {
  if (name.empty() || name == "z") return UpAxis::kZ;
  if (name == "y") return UpAxis::kY;
  throw InputError({"--up"}, "'" + name + "'", "y or z");
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

MeshRequest read_request(const Job& job) {
  MeshRequest request;
  request.format = require_extension(job.line.output, {".obj", ".ply", ".stl", ".off", ".glb"});
  request.polygonize = mesh_options(job);
  request.up = up_axis(job.line.up);
  return request;
}

void colour_with(const Bark& bark, PolygonizeOptions& options) {
  options.color = [&bark](Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal) {
    const Vec3 albedo = bark.albedo(evaluator, field, p, normal);
    return std::array<std::uint8_t, 4>{srgb_byte(albedo.x), srgb_byte(albedo.y), srgb_byte(albedo.z), 255};
  };
}

std::optional<Polygonized> polygonize_field(Job& job, const Field& field, const PolygonizeOptions& options) {
  const StageTimer timer(job.figures, "polygonize");
  return polygonize(field, options, job.run);
}

void report_mesh(Job& job, const Field& field, const Polygonized& made) {
  const PolygonizeReport& report = made.report;
  job.figures.set("primitives", field.atom_count());
  job.figures.set("triangles", made.mesh.triangles.size());
  job.figures.set("vertices", made.mesh.positions.size());
  job.figures.set("components", report.components);
  job.figures.set("voxel", report.voxel);
  job.figures.set("cells", report.cells);
  job.figures.set("thin_primitives", report.thin_primitives);
  job.figures.set("thin_length", report.thin_length);
  job.figures.set("thinnest_radius", report.thinnest_radius);
  job.figures.set("ambiguous_faces", report.ambiguous_faces);
  job.figures.set("largest_distance", report.largest_distance);
}

}  // namespace

Outcome run_mesh(Job& job) {
  MeshRequest request = read_request(job);
  OutputFile output(job.line.output);
  const Bark bark(load_bark(job.recipe), job.recipe.render.seed);
  if (request.format != ".stl") colour_with(bark, request.polygonize);  // which has no colours
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  const auto made = polygonize_field(job, *field, request.polygonize);
  if (!made) return Outcome::kInterrupted;
  report_mesh(job, *field, *made);
  const StageTimer timer(job.figures, "write");
  write_mesh(made->mesh, output.temporary(), request.format, request.up);
  if (job.run.cancelled()) return Outcome::kInterrupted;
  output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
