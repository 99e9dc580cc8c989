// mesh: closed triangle meshes of the surface, in stages: what is asked, the field, the mesh, its levels of detail, what they
// carry, what they are worth, the files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <string_view>

#include "cli/commands.h"
#include "cli/mesh_figures.h"
#include "cli/output_file.h"
#include "cli/read_text.h"
#include "cli/units.h"
#include "polygonize/decimate.h"
#include "polygonize/mesh_io.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "raytrace/bark.h"

namespace cambium {
namespace {

/// What the recipe and the flags ask for, checked before any work.
struct MeshRequest {
  std::string format;   ///< extension of the output, with its dot
  UpAxis up = UpAxis::kZ;
  MeshRecipe mesh;
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

MeshRequest read_request(const Job& job) {
  const CommandLine& line = job.line;
  MeshRequest request;
  request.format = require_extension(line.output, {".obj", ".ply", ".stl", ".off", ".glb"});
  request.up = up_axis(line.up);
  request.mesh = job.recipe.mesh;
  PolygonizeOptions& options = request.mesh.polygonize;
  if (!line.voxel.empty()) {
    options.voxel = parse_positive_length(line.voxel, {"--voxel"});
    options.tolerance.reset();
  }
  if (!line.tolerance.empty()) {
    options.tolerance = parse_positive_length(line.tolerance, {"--tolerance"});
    options.voxel.reset();
  }
  if (!line.max_triangles.empty()) options.max_triangles = parse_count(line.max_triangles, {"--max-triangles"});
  if (!line.lod.empty()) request.mesh.lod = parse_levels(line.lod, {"--lod"});
  if (line.no_ao) request.mesh.occlusion = false;
  return request;
}

/// One for each level of formats that hold one mesh a file, made before the work.
std::deque<OutputFile> make_outputs(const std::filesystem::path& target, const MeshRequest& request) {
  std::deque<OutputFile> outputs;
  const std::size_t levels = request.mesh.lod.size();
  if (levels <= 1 || request.format == ".glb") {
    outputs.emplace_back(target);
    return outputs;
  }
  const std::string name = target.filename().string(), stem = name.substr(0, name.size() - request.format.size());
  for (std::size_t i = 0; i < levels; ++i)
    outputs.emplace_back(target.parent_path() / fmt::format("{}_lod{}{}", stem, i, name.substr(stem.size())));
  return outputs;
}

SurfaceColor colours_of(const Bark& bark) {
  return [&bark](Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal) {
    const Vec3 albedo = bark.albedo(evaluator, field, p, normal);
    return std::array<std::uint8_t, 4>{srgb_byte(albedo.x), srgb_byte(albedo.y), srgb_byte(albedo.z), 255};
  };
}

std::array<float, 3> as_floats(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

bool fits_gltf(std::string_view image) { return image.starts_with("\x89PNG") || image.starts_with("\xff\xd8\xff"); }

/// The barks of a .glb, by order. Where one has an image, images and plain colours take the place of vertex colours, which would
/// darken them.
std::vector<MeshMaterial> materials_of(Job& job, bool& has_images) {
  const std::vector<BarkRecipe>& barks = job.recipe.bark;
  std::vector<MeshMaterial> materials(barks.size());
  has_images = false;
  for (std::size_t i = 0; i < barks.size(); ++i) {
    if (barks.size() > 1) materials[i].name = fmt::format("bark of order {}", i);
    if (!barks[i].texture) continue;
    auto image = std::make_shared<const std::string>(read_text(*barks[i].texture));
    if (fits_gltf(*image))
      materials[i].texture = std::move(image), has_images = true;
    else
      job.warnings.push_back(barks[i].texture->string() + " is neither PNG nor JPEG: a .glb takes no other images");
  }
  for (std::size_t i = 0; i < barks.size() && has_images; ++i)
    if (!materials[i].texture) materials[i].color = as_floats(barks[i].material.color);
  return materials;
}

// Each stage times itself and gives nullopt when interrupted.

std::optional<Polygonized> polygonize_field(Job& job, const Field& field, const PolygonizeOptions& options) {
  const StageTimer timer(job.figures, "polygonize");
  return polygonize(field, options, job.run);
}

/// The mesh itself if no levels are asked for; else each from the one before. Takes `mesh` away.
std::optional<std::vector<Mesh>> make_levels(Job& job, Mesh& mesh, const std::vector<std::size_t>& most) {
  std::vector<Mesh> levels;
  if (most.empty()) levels.push_back(std::move(mesh));
  const StageTimer timer(job.figures, "lod");
  for (const std::size_t triangles : most) {
    auto level = decimate(levels.empty() ? mesh : levels.back(), {.triangles = triangles}, job.run);
    if (!level) return std::nullopt;
    if (levels.empty()) mesh = {};
    levels.push_back(std::move(*level));
  }
  return levels;
}

std::optional<std::vector<MeshAttributes>> make_attributes(Job& job, const std::vector<Mesh>& levels, const Field& field,
                                                           const MeshAttributeOptions& options) {
  const StageTimer timer(job.figures, "attributes");
  std::vector<MeshAttributes> attributes;
  for (const Mesh& level : levels) {
    auto made = mesh_attributes(field, level, options, job.run);
    if (!made) return std::nullopt;
    attributes.push_back(std::move(*made));
  }
  return attributes;
}

std::optional<std::vector<Verification>> verify_levels(Job& job, const std::vector<Mesh>& levels, const Field& field,
                                                       const VerifyOptions& options) {
  const StageTimer timer(job.figures, "verify");
  std::vector<Verification> verified;
  for (const Mesh& level : levels) {
    const auto verification = verify_mesh(level, field, options, job.run);
    if (!verification) return std::nullopt;
    verified.push_back(*verification);
  }
  return verified;
}

/// Down to which share of the screen's height a level is for: where the next has as many triangles to the pixel as the first one
/// when it fills the screen.
double screen_coverage(const std::vector<Mesh>& levels, std::size_t level) {
  if (level + 1 == levels.size()) return 0;
  const auto triangles = [&](std::size_t i) { return static_cast<double>(levels[i].triangles.size()); };
  return triangles(0) > 0 ? std::sqrt(triangles(level + 1) / triangles(0)) : 0;
}

void write_levels(Job& job, const std::vector<Mesh>& levels, const std::vector<MeshAttributes>& attributes,
                  std::vector<MeshMaterial> materials, const MeshRequest& request, std::deque<OutputFile>& outputs) {
  const StageTimer timer(job.figures, "write");
  MeshFile all;
  all.materials = std::move(materials);
  for (std::size_t i = 0; i < levels.size(); ++i)
    all.levels.push_back({&levels[i], attributes.empty() ? nullptr : &attributes[i], screen_coverage(levels, i)});
  if (outputs.size() == 1) {
    write_mesh(all, outputs.front().temporary(), request.format, request.up);
    return;
  }
  for (std::size_t i = 0; i < levels.size() && !job.run.cancelled(); ++i) {
    MeshFile one = all;
    one.levels = {all.levels[i]};
    write_mesh(one, outputs[i].temporary(), request.format, request.up);
  }
}

}  // namespace

Outcome run_mesh(Job& job) {
  const MeshRequest request = read_request(job);
  std::deque<OutputFile> outputs = make_outputs(job.line.output, request);
  const Bark bark(load_bark(job.recipe), job.recipe.render.seed);
  bool has_images = false;
  std::vector<MeshMaterial> materials;
  if (request.format == ".glb") materials = materials_of(job, has_images);
  const auto built = build_tree(job);
  if (!built || job.run.cancelled()) return Outcome::kInterrupted;
  const Field field = compile_field(job, built->tree);
  auto made = polygonize_field(job, field, request.mesh.polygonize);
  if (!made) return Outcome::kInterrupted;
  const auto levels = make_levels(job, made->mesh, request.mesh.lod);
  if (!levels) return Outcome::kInterrupted;
  job.figures.set("primitives", field.atom_count());
  set_level_figures(job, *levels, request.mesh.lod);
  set_polygonize_figures(job, made->report);

  std::vector<MeshAttributes> attributes;
  if (request.format != ".stl") {  // which has no place for any
    MeshAttributeOptions options;
    options.branches = built->branches;
    if (!has_images) options.color = colours_of(bark);
    if (request.mesh.occlusion && (request.format == ".glb" || request.format == ".ply")) options.occlusion.emplace();
    auto carried = make_attributes(job, *levels, field, options);
    if (!carried) return Outcome::kInterrupted;
    attributes = std::move(*carried);
  }
  if (job.line.verify) {
    VerifyOptions options;
    options.tolerance = request.mesh.polygonize.tolerance.value_or(0);
    const auto verified = verify_levels(job, *levels, field, options);
    if (!verified) return Outcome::kInterrupted;
    set_verify_figures(job, *verified, options.tolerance);
  }
  write_levels(job, *levels, attributes, std::move(materials), request, outputs);
  if (job.run.cancelled()) return Outcome::kInterrupted;
  for (OutputFile& output : outputs) output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
