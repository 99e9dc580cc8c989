#include "polygonize/polygonize.h"

#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "polygonize/lattice.h"
#include "polygonize/mesh_components.h"
#include "polygonize/patch_polygons.h"
#include "polygonize/thinnest_radius.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kMostRounds = 12;
constexpr std::size_t kMostCells = 400'000'000;
constexpr double kCellsAround = 8;    // a circle of one radius crosses so many squares with that edge
// Cells of sqrt(kSagitta tolerance radius) are about as large as keeps their polygons within the tolerance: the rest is refined.
// From 5 to 16 the poplar takes 5.0 to 3.6 million triangles at 0.5 mm, but as many more rounds.
constexpr double kSagitta = 8;
constexpr int kFinestHalvings = 19;   // of the field's bounds

struct Plan {
  LeafRule leaves;
  CoverOptions cover;
  int finer = 0;
  double tolerance = 0;   // infinite where cells are given
};

Plan make_plan(const Field& field, const PolygonizeOptions& options) {
  const Vec3 size = field.bounds().size();
  const double across = glm::length(size);
  Plan plan;
  plan.cover.max_cells = kMostCells;
  if (options.voxel) {
    plan.tolerance = kInfinity;
    plan.finer = 3;
    plan.leaves.radii = 0;
    plan.leaves.shortest_gap = *options.voxel;
    plan.cover.cell = *options.voxel * 8;
    return plan;
  }
  const double thinnest = thinnest_radius(field);
  plan.tolerance = options.tolerance.value_or(std::max(across / 20000, std::isfinite(thinnest) ? thinnest / 8 : across / 1000));
  double sides = options.min_sides;
  if (options.preview) plan.tolerance *= 16, sides = std::min(sides, 4.0);
  plan.leaves.radii = kCellsAround / sides;
  plan.leaves.sagitta = kSagitta * plan.tolerance;
  plan.leaves.longest = across / 16;
  plan.leaves.shortest_gap = 2 * plan.tolerance;
  // Leaves halve from one that is just right for the thinnest twig, of which there is most, down to a quarter of the tolerance.
  double unit = std::isfinite(thinnest) ? plan.leaves.edge(thinnest) : plan.leaves.longest;
  const double finest = std::max(plan.tolerance / 4, std::max({size.x, size.y, size.z}) * std::ldexp(1.0, -kFinestHalvings));
  while (unit / 2 >= finest) unit /= 2;
  plan.cover.unit = unit;
  plan.cover.cell_radii = 3.2;
  plan.cover.sagitta = 64 * plan.leaves.sagitta;
  return plan;
}

// The larger leaves of polygons that are too far from the surface.
std::vector<std::uint32_t> leaves_to_refine(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges,
                                            const std::vector<float>& errors, double tolerance) {
  std::vector<std::uint32_t> leaves;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!(errors[i] > tolerance)) continue;
    int largest = 0;
    for (const std::uint32_t leaf : edges[i].leaves) largest = std::max<int>(largest, tree.leaves()[leaf].level);
    if (largest == 0) continue;
    for (const std::uint32_t leaf : edges[i].leaves)
      if (tree.leaves()[leaf].level == largest) leaves.push_back(leaf);
  }
  std::sort(leaves.begin(), leaves.end());
  leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
  return leaves;
}

/// An octree fine enough, and what was contoured on it.
struct Contoured {
  SurfaceOctree tree;
  Contour contour;
  BalancedVertices balanced;
  std::size_t rounds = 0;
};

/// Edges and patches of the octree, which is cut where they would not make a manifold. nullopt if cancelled.
std::optional<Contour> find_topology(SurfaceOctree& tree, const SurfaceCover& cover, const RunOptions& run) {
  for (;;) {
    auto found = crossed_minimal_edges(tree, run);
    if (!found) return std::nullopt;
    if (!found->to_split.empty()) {
      if (!tree.split(cover, std::move(found->to_split), run)) return std::nullopt;
      continue;
    }
    auto patches = find_patches(tree, found->edges, run);
    if (!patches) return std::nullopt;
    if (patches->to_split.empty()) return Contour{std::move(found->edges), std::move(*patches), {}, {}};
    if (!tree.split(cover, std::move(patches->to_split), run)) return std::nullopt;
  }
}

// Contours, measures, and cuts the leaves of polygons that are off, until none is.
std::optional<Contoured> contour(const SurfaceCover& cover, const Plan& plan, const RunOptions& run) {
  auto tree = SurfaceOctree::build(cover, plan.finer, plan.leaves, run);
  if (!tree) return std::nullopt;
  Contoured result{std::move(*tree), {}, {}, 0};
  ProgressMeter progress(run, "contouring");
  progress.add(0.3);
  for (;; ++result.rounds) {
    auto next = find_topology(result.tree, cover, run);
    if (!next) return std::nullopt;
    const std::vector<std::uint32_t> earlier = earlier_edges(result.tree, next->edges, result.contour.edges);
    auto crossings = find_crossings(result.tree, cover, next->edges, earlier, result.contour.crossings, run);
    if (!crossings) return std::nullopt;
    next->crossings = std::move(*crossings);
    auto placed = place_vertices(result.tree, cover, *next, earlier, result.contour, run);
    if (!placed) return std::nullopt;
    next->placed = std::move(*placed);
    result.contour = std::move(*next);
    result.balanced = balance_vertices(result.tree, result.contour, plan.tolerance);
    const auto leaves = leaves_to_refine(result.tree, result.contour.edges, result.balanced.errors, plan.tolerance);
    progress.add(std::ldexp(0.35, -static_cast<int>(result.rounds)));
    if (leaves.empty() || result.rounds >= kMostRounds) break;
    if (!result.tree.split(cover, leaves, run)) return std::nullopt;
  }
  progress.finish();
  return result;
}

void report_cells(const Contoured& made, PolygonizeReport& report) {
  const SurfaceOctree& tree = made.tree;
  report.rounds = made.rounds;
  report.cells = made.contour.patches.patches.size();
  report.relinked_faces = made.contour.patches.relinked_faces;
  int finest = kMostLevels, coarsest = 0;
  for (const Patch& patch : made.contour.patches.patches) {
    const int level = tree.leaves()[patch.leaf].level;
    finest = std::min(finest, level), coarsest = std::max(coarsest, level);
  }
  if (report.cells > 0) {
    report.smallest_cell = std::ldexp(tree.grid().cell, finest);
    report.largest_cell = std::ldexp(tree.grid().cell, coarsest);
  }
  for (const float error : made.balanced.errors) report.largest_error = std::max(report.largest_error, static_cast<double>(error));
  for (const std::uint32_t leaf : made.contour.patches.crowded) report.uncertain.push_back(tree.box(tree.leaves()[leaf]).center());
}

std::optional<Polygonized> polygonize_in_arena(const Field& field, const PolygonizeOptions& options, const RunOptions& run) {
  if (options.voxel) require_length(*options.voxel, "voxel");
  if (options.tolerance) require_length(*options.tolerance, "tolerance");
  if (options.voxel && options.tolerance) throw InputError({}, "both a voxel and a tolerance", "one of them");
  if (!(options.min_sides >= 4 && options.min_sides <= 64)) {
    throw InputError({}, fmt::format("{:g} sides at least", options.min_sides), "4 to 64");
  }
  Polygonized result;
  if (field.bounds().empty()) return result;
  const Plan plan = make_plan(field, options);
  const auto cover = cover_surface(field, plan.cover, run);
  if (!cover) return std::nullopt;
  const auto made = contour(*cover, plan, run);
  if (!made) return std::nullopt;
  ProgressMeter progress(run, "joining polygons");
  auto built = build_polygons(made->tree, *cover, made->contour, made->balanced.positions, run);
  if (!built) return std::nullopt;
  progress.add(0.7);
  result.mesh = std::move(built->mesh);
  PolygonizeReport& report = result.report;
  if (!options.voxel) report.tolerance = plan.tolerance;
  report_cells(*made, report);
  report.face_vertices = built->face_vertices;
  report.edge_vertices = built->edge_vertices;
  const auto components = close_thin_voids(result.mesh, plan.leaves.shortest_gap, run);
  if (!components) return std::nullopt;
  report.components = components->components;
  report.closed_voids = components->closed_voids;
  progress.finish();
  return result;
}

}  // namespace

std::optional<Polygonized> polygonize(const Field& field, const PolygonizeOptions& options, const RunOptions& run) {
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  std::optional<Polygonized> result;
  arena.execute([&] { result = polygonize_in_arena(field, options, run); });
  return result;
}

}  // namespace cambium
