#include "polygonize/polygonize.h"

#include "blobtree/input_error.h"
#include "blobtree/lone_chain.h"
#include "blobtree/progress_meter.h"
#include "polygonize/contour_refiner.h"
#include "polygonize/crowded_leaves.h"
#include "polygonize/lattice.h"
#include "polygonize/mesh_components.h"
#include "polygonize/missed_surface.h"
#include "polygonize/patch_polygons.h"
#include "polygonize/thinnest_radius.h"
#include "polygonize/tube_mesh.h"
#include "polygonize/unseen_surface.h"
#include "polygonize/vertex_balance.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace cambium {
namespace {

constexpr std::size_t kMostRounds = 16;
// From here on only what is off by so much more is cut: along a trunk one cut may take the next leaf over the tolerance by a hair, and
// that the next, a leaf a round.
constexpr std::size_t kLateRound = 6;
constexpr double kLateCare = 1.25;
constexpr std::size_t kMostUniformCells = 400'000'000;
// Of a cover that follows the radii: with more there would be too many leaves. Of hairs metres long it is made coarser instead, so that
// it does not take minutes to find that out.
constexpr std::size_t kMostCells = 4'000'000;
constexpr double kWhole = 1.1;        // in radii: of larger cells the corners may miss a twig, or meet only across a diagonal
constexpr double kCellsAround = 8;    // a circle of one radius crosses so many squares with that edge
// Cells of sqrt(kSagitta tolerance radius) are about as large as keeps their polygons within the tolerance: the rest is refined.
// From 8 to 12 the poplar takes a ninth fewer triangles at 0.5 mm in the same time, but 10^4 internodes at 0.25 mm take a quarter longer.
// At 16 whole trunks come to lie at the very tolerance, and more of the palm than a thousandth beyond it.
constexpr double kSagitta = 8;
constexpr int kFinestHalvings = 19;   // of the field's bounds

constexpr double kPlaceTolerances = 4;   // the edge of cubes of which one place is reported

/// Of those in one cube of a grid the first.
std::vector<Vec3> one_a_cube(const std::vector<Vec3>& places, double edge) {
  std::vector<Vec3> kept;
  std::set<std::array<double, 3>> taken;
  for (const Vec3& p : places)
    if (taken.insert({std::floor(p.x / edge), std::floor(p.y / edge), std::floor(p.z / edge)}).second) kept.push_back(p);
  return kept;
}

/// What remains of the doubts that there were before there were polygons: where primitives only blend they stay, elsewhere others are
/// known since.
std::vector<Vec3> settled_doubts(const SurfaceCover& cover, std::vector<Vec3> first, const std::vector<Vec3>& since, double tolerance) {
  std::erase_if(first, [&](const Vec3& p) {
    const PrunedField field = cover.cube_field(*cover.find(p));
    return !ActiveChain::only_blend(field.narrowed(Box::intersection(field.box(), Box{p, p}.padded(tolerance))));
  });
  first.insert(first.end(), since.begin(), since.end());
  return one_a_cube(first, kPlaceTolerances * tolerance);
}

struct Plan {
  LeafRule leaves;
  CoverOptions cover;
  int finer = 0;
  double tolerance = 0;   // infinite where cells are given
  double crumb = 0;       // see drop_small_components
  bool search = false;    // for surface that cells do not show
  std::optional<TubeRule> tubes;
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
    plan.cover.max_cells = kMostUniformCells;
    plan.cover.cell = *options.voxel * 8;
    return plan;
  }
  const double thinnest = thinnest_radius(field);
  plan.tolerance = options.tolerance.value_or(std::max(across / 20000, std::isfinite(thinnest) ? thinnest / 8 : across / 1000));
  double sides = options.min_sides;
  if (options.preview) plan.tolerance *= 16, sides = std::min(sides, 4.0);
  plan.tubes = TubeRule{plan.tolerance, sides};
  plan.crumb = std::min(plan.tolerance, thinnest);
  plan.search = !options.preview;
  plan.leaves.radii = std::min(kCellsAround / sides, kWhole);
  plan.leaves.sagitta = kSagitta * plan.tolerance;
  plan.leaves.longest = across / 16;
  plan.leaves.shortest_gap = 0.5001 * plan.tolerance;   // narrow() is the next cell, at most the tolerance and a hair
  // Leaves halve from one that is just right for the thinnest twig, of which there is most, down to a quarter of the tolerance.
  double unit = std::isfinite(thinnest) ? plan.leaves.edge(thinnest) : plan.leaves.longest;
  const double finest = std::max(plan.tolerance / 4, std::max({size.x, size.y, size.z}) * std::ldexp(1.0, -kFinestHalvings));
  while (unit / 2 >= finest) unit /= 2;
  plan.cover.unit = unit;
  plan.cover.cell_radii = 3.2;
  plan.cover.shared_radii = 1.6;   // so that tubes come nearer to forks: of half that, cells cost more than they save
  plan.cover.sagitta = 64 * plan.leaves.sagitta;
  return plan;
}

// The larger leaves of polygons that are too far from the surface.
std::vector<std::uint32_t> leaves_to_refine(const ContourRefiner& refiner, const VertexBalance& balance, double tolerance) {
  const std::vector<OctreeLeaf>& leaves = refiner.tree().leaves();
  std::vector<std::uint32_t> found;
  for (const std::uint32_t e : balance.changed_edges()) {
    if (!(balance.error(e) > tolerance)) continue;
    int largest = 0;
    for (const std::uint32_t leaf : refiner.contour().edges[e].leaves) largest = std::max<int>(largest, leaves[leaf].level);
    if (largest == 0) continue;
    for (const std::uint32_t leaf : refiner.contour().edges[e].leaves)
      if (leaves[leaf].level == largest) found.push_back(leaf);
  }
  return found;
}

/// A contour that is being refined, and how well its polygons fit.
struct Contouring {
  ContourRefiner refiner;
  VertexBalance balance;
  MissedSurface missed;

  std::optional<DualMesh> polygons(const SurfaceCover& cover, const Plan& plan, const RunOptions& run) const {
    return build_polygons(refiner.tree(), cover, refiner.contour(), balance.positions(), balance.splits(), plan.tolerance, run);
  }
};

std::optional<Contouring> begin_contouring(const SurfaceCover& cover, const Plan& plan, const TubeRuns& tubes, PolygonizeReport& report,
                                           const RunOptions& run) {
  auto tree = SurfaceOctree::build(cover, plan.finer, plan.leaves, run, &tubes);
  if (!tree) return std::nullopt;
  if (plan.search && !show_unseen_surface(*tree, cover, report.unseen, run)) return std::nullopt;
  auto refiner = ContourRefiner::begin(*std::move(tree), cover, run);
  if (!refiner) return std::nullopt;
  return Contouring{*std::move(refiner), VertexBalance(plan.tolerance), {}};
}

// Measures, and cuts the leaves of polygons that are off, then those of surface that no polygon is near, until there are none. False if
// cancelled.
bool refine(Contouring& contouring, const SurfaceCover& cover, const Plan& plan, PolygonizeReport& report, ProgressMeter& progress,
            const RunOptions& run) {
  auto& [refiner, balance, missed] = contouring;
  for (std::size_t round = 0;; ++round, ++report.rounds) {
    if (!refiner.place(run)) return false;
    if (!balance.update(refiner.tree(), cover, refiner.contour(), refiner.new_patches(), run)) return false;
    progress.add(std::ldexp(0.35, -static_cast<int>(round)));
    std::vector<std::uint32_t> leaves;
    const double care = round < kLateRound ? kAim : kLateCare;
    if (round < kMostRounds) leaves = leaves_to_refine(refiner, balance, care * plan.tolerance);
    if (leaves.empty() && plan.search) {
      auto found = missed.find(refiner.tree(), cover, refiner.contour(), {balance.positions(), balance.splits(), plan.tolerance}, run);
      if (!found) return false;
      leaves = *std::move(found);
    }
    if (leaves.empty()) break;
    if (!refiner.split(std::move(leaves), run)) return false;
  }
  const Living living = living_part(refiner.contour());
  balance.keep(living);
  refiner.compact(living);
  return true;
}

double largest_error(const Contouring& contouring) {
  float largest = 0;
  for (std::uint32_t e = 0; e < contouring.refiner.contour().edges.size(); ++e) largest = std::max(largest, contouring.balance.error(e));
  return static_cast<double>(largest);
}

/// What was contoured, with its mesh, closed by tubes.
struct Built {
  Contouring contouring;
  DualMesh polygons;
};

// Stretches whose tubes do not fit the mesh at their ends are contoured like all else. They are of one lone chain, whose leaves show all
// there is.
std::optional<Built> build_mesh(const SurfaceCover& cover, const Plan& plan, PolygonizeReport& report, const RunOptions& run) {
  auto tubes = plan.tubes ? TubeRuns::find(cover, plan.leaves, *plan.tubes, run) : TubeRuns{};
  if (!tubes) return std::nullopt;
  ProgressMeter progress(run, "contouring");
  auto contouring = begin_contouring(cover, plan, *tubes, report, run);
  if (!contouring) return std::nullopt;
  progress.add(0.3);
  for (;;) {
    if (!refine(*contouring, cover, plan, report, progress, run)) return std::nullopt;
    auto polygons = contouring->polygons(cover, plan, run);
    if (!polygons) return std::nullopt;
    const auto added = add_tubes(contouring->refiner.tree(), cover, contouring->refiner.contour(), *tubes, plan.tolerance, *polygons, run);
    if (!added) return std::nullopt;
    if (added->failed.empty()) {
      progress.finish();
      report.unseen = settled_doubts(cover, std::move(report.unseen), contouring->missed.uncertain(contouring->refiner.tree()), plan.tolerance);
      report.relinked_faces = contouring->refiner.relinked_faces();
      report.largest_error = std::max(largest_error(*contouring), added->largest_error);
      return Built{*std::move(contouring), *std::move(polygons)};
    }
    report.misfit_tubes += added->failed.size();
    tubes->remove(added->failed);
    polygons.reset();
    if (!contouring->refiner.fill(run)) return std::nullopt;
  }
}

void report_cells(const ContourRefiner& made, PolygonizeReport& report) {
  const std::vector<Patch>& patches = made.contour().patches;
  report.cells = patches.size();
  int finest = kMostLevels, coarsest = 0;
  for (const Patch& patch : patches) {
    const int level = made.tree().leaves()[patch.leaf].level;
    finest = std::min(finest, level), coarsest = std::max(coarsest, level);
  }
  if (!patches.empty()) {
    report.smallest_cell = std::ldexp(made.tree().grid().cell, finest);
    report.largest_cell = std::ldexp(made.tree().grid().cell, coarsest);
  }
  report.uncertain = entangled_leaves(made.tree(), made.contour());
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
  auto built = build_mesh(*cover, plan, result.report, run);
  if (!built) return std::nullopt;
  result.mesh = std::move(built->polygons.mesh);
  PolygonizeReport& report = result.report;
  if (!options.voxel) report.tolerance = plan.tolerance;
  report_cells(built->contouring.refiner, report);
  report.face_vertices = built->polygons.face_vertices;
  report.edge_vertices = built->polygons.edge_vertices;
  const double thin = std::max(built->contouring.refiner.tree().narrow(), report.smallest_cell);   // wider ones are no cracks: their walls count
  const auto components = drop_small_components(result.mesh, thin, plan.crumb, run);
  if (!components) return std::nullopt;
  report.components = components->components;
  report.closed_voids = components->closed_voids;
  report.crumbs = components->crumbs;
  report.left_out = one_a_cube(components->removed, kPlaceTolerances * std::min(plan.tolerance, thin));
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
