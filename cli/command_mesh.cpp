// mesh: closed triangle meshes of the surface, in stages: what is asked, the field, the mesh, its levels of detail, what they
// carry, what they are worth, the files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "cli/commands.h"
#include "cli/leaves.h"
#include "cli/mesh_figures.h"
#include "cli/mesh_look.h"
#include "cli/output_file.h"
#include "cli/units.h"
#include "polygonize/decimate.h"
#include "polygonize/mesh_io.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"

namespace cambium {
namespace {

constexpr double kThinnestOfPreviews = 1.0 / 1250;   // of a tree's diagonal: cells follow the thinnest twigs, of which there is most

/// What the recipe and the flags ask for, checked before any work.
struct MeshRequest {
  std::string format;   ///< extension of the output, with its dot
  UpAxis up = UpAxis::kZ;
  MeshRecipe mesh;
};

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
  if (line.min_sides) options.min_sides = *line.min_sides;
  if (line.preview) options.preview = true;
  if (!line.max_triangles.empty()) request.mesh.lod = {parse_count(line.max_triangles, {"--max-triangles"})};
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
                                                           MeshAttributeOptions options) {
  const StageTimer timer(job.figures, "attributes");
  std::vector<MeshAttributes> attributes;
  for (const Mesh& level : levels) {
    auto made = mesh_attributes(field, level, options, job.run);
    if (!made) return std::nullopt;
    if (attributes.empty() && made->tile > 0) options.tile = made->tile;  // the texture lies alike on every level
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

/// None, with a warning, where the file has no place for them.
std::vector<MeshLeaves> make_leaves(Job& job, const BuiltTree& built, const std::string& format) {
  if (built.foliage.organs.empty()) return {};
  if (!holds_leaves(format)) {
    job.warnings.push_back("the leaves are left out: a " + format + " holds the closed wood alone; .glb and .obj take them");
    return {};
  }
  return merged_leaves(job.recipe, dress_leaves(job, built), job.warnings);
}

/// Down to which share of the screen's height a level is for: where the next has as many triangles to the pixel as the first one
/// when it fills the screen.
double screen_coverage(const std::vector<Mesh>& levels, std::size_t level) {
  if (level + 1 == levels.size()) return 0;
  const auto triangles = [&](std::size_t i) { return static_cast<double>(levels[i].triangles.size()); };
  return triangles(0) > 0 ? std::sqrt(triangles(level + 1) / triangles(0)) : 0;
}

void write_levels(Job& job, const std::vector<Mesh>& levels, const std::vector<MeshAttributes>& attributes,
                  std::vector<MeshMaterial> materials, std::span<const MeshLeaves> leaves, const MeshRequest& request,
                  std::deque<OutputFile>& outputs) {
  const StageTimer timer(job.figures, "write");
  MeshFile all;
  all.materials = std::move(materials);
  all.leaves = leaves;
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
  MeshLook look = mesh_look(job.recipe, request.format == ".glb");
  job.warnings.insert(job.warnings.end(), look.warnings.begin(), look.warnings.end());
  const bool preview = request.mesh.polygonize.preview;
  const auto built = build_tree(job, preview ? kThinnestOfPreviews : 0);
  if (!built || job.run.cancelled()) return Outcome::kInterrupted;
  const Field field = compile_field(job, built->tree);
  const std::vector<MeshLeaves> leaves = make_leaves(job, *built, request.format);
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
    options.aspect = look.aspect;
    options.color = vertex_colors(look.bark);
    if (request.mesh.occlusion && !preview && (request.format == ".glb" || request.format == ".ply")) options.occlusion.emplace();
    auto carried = make_attributes(job, *levels, field, options);
    if (!carried) return Outcome::kInterrupted;
    attributes = std::move(*carried);
  }
  if (job.line.verify) {
    VerifyOptions options;
    options.tolerance = made->report.tolerance;
    const auto verified = verify_levels(job, *levels, field, options);
    if (!verified) return Outcome::kInterrupted;
    set_verify_figures(job, *verified, options.tolerance);
  }
  write_levels(job, *levels, attributes, std::move(look.materials), leaves, request, outputs);
  if (job.run.cancelled()) return Outcome::kInterrupted;
  for (OutputFile& output : outputs) output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
