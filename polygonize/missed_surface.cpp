#include "polygonize/missed_surface.h"

#include "blobtree/lone_chain.h"
#include "polygonize/nearby_polygons.h"
#include "polygonize/ordered_chunks.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

constexpr double kReach = 2;               // tolerances: how far polygons are looked for
constexpr double kFar = 1.8;               // from the polygons, in tolerances: these are measured to be within one, but at a few places
constexpr double kFinest = 0.5;            // the smallest cubes, in tolerances, or down to half of that
constexpr double kMostCubes = 8;           // of one leaf, for each of the smallest on a face: bounds of warped fields tell little
constexpr std::size_t kLeavesPerTask = 64;
constexpr int kRegionLevels = 2;           // above a leaf: what is active in so much of its cell is found anew
constexpr std::uint32_t kNoCell = 0xffffffffu;

}  // namespace

struct MissedSurface::Found {
  std::vector<std::uint32_t> leaves;   // to be cut
  std::vector<Doubt> doubts;
};

/// Looks through one leaf after another. Scratch of one thread.
class MissedSurface::Search {
 public:
  Search(const SurfaceOctree& tree, const SurfaceCover& cover, const NearbyPolygons& polygons, double tolerance, const RunOptions& run)
      : tree_(tree), cover_(cover), polygons_(polygons), tolerance_(tolerance), run_(run) {
    while (std::ldexp(tree.grid().cell, finest_ + 1) <= kFinest * tolerance) ++finest_;
  }

  void look_through(std::uint32_t leaf, Found& found) {
    const OctreeLeaf& l = tree_.leaves()[leaf];
    enter_region_of(l);
    if (only_blends_) return;
    const Box box = tree_.box(l);
    if (!l.uniform() && falls_throughout(circumscribed_ball(box))) return;
    polygons_.turn_to(box, kReach * tolerance_);
    cubes_ = 0;
    most_cubes_ = static_cast<int>(kMostCubes * std::pow(4.0, std::max(l.level - finest_, 3)));
    places_.clear();
    if (look_into({l.place, l.level}) && l.level > 0) return found.leaves.push_back(leaf);
    for (const Vec3& place : places_) found.doubts.push_back({leaf, place});
  }

 private:
  /// Leaves come in the order of the octree, mostly: those of one region share a field.
  void enter_region_of(const OctreeLeaf& leaf) {
    const int level = leaf.level + kRegionLevels;
    CellPlace place = leaf.place;
    for (std::uint32_t& along : place) along = along >> level << level;
    if (leaf.cell == cell_ && place == region_.place && level == region_.level) return;
    cell_ = leaf.cell;
    region_ = {place, level};
    const PrunedField whole = cover_.cube_field(leaf.cell);
    const Box around = tree_.grid().box(place, level).padded(tree_.edge(leaf));
    field_ = whole.narrowed(Box::intersection(around, whole.box()));
    only_blends_ = ActiveChain::only_blend(field_);
  }

  bool is_bare(const Box& box) { return !evaluator_.interval(field_, box).contains(kIso); }

  static Vec3 direction_of(const Vec3& gradient) {
    const double slope = glm::length(gradient);
    return slope > 0 ? gradient / slope : Vec3(0.0);
  }
  Vec3 uphill(const Vec3& p) { return direction_of(evaluator_.sample(field_, p).gradient); }

  /// The way it falls in the middle: then no wedge of wood or air is sharper than a right angle there.
  bool falls_throughout(const Ball& ball) { return evaluator_.course(field_, ball, uphill(ball.center)).slope.lo > 0; }

  /// Whether there is no surface in a ball, or one sheet at most that a vertex near by is on.
  bool is_settled(const Ball& ball, const Vec3& up) {
    const Course course = evaluator_.course(field_, ball, up);
    if (!course.value.contains(kIso)) return true;
    if (!(course.slope.lo >= 0)) return false;
    const double reach = polygons_.distance_to_vertex(ball.center, field_.box());
    return reach <= ball.radius || (reach < kInfinity && evaluator_.course(field_, {ball.center, reach}, up).slope.lo >= 0);
  }

  /// Whether no slope leads from the middle of a cube to the surface in it. Where fields take from each other their slopes cancel, and
  /// bounds of their values do not.
  bool is_out_of_reach(const Box& box, const Ball& ball, const Sample& middle) {
    const double half_edge = 0.5 * (box.hi.x - box.lo.x), farthest = std::abs(middle.value - kIso);
    const auto reached = [&](const Vec3& steepest) { return half_edge * (steepest.x + steepest.y + steepest.z) >= farthest; };
    if (reached(glm::abs(middle.gradient))) return false;   // before much is asked
    Vec3 steepest(0.0);
    for (int a = 0; a < 3; ++a) {
      Vec3 along(0.0);
      along[a] = 1;
      const Interval slope = evaluator_.course(field_, ball, along).slope;
      steepest[a] = std::max(-slope.lo, slope.hi);
      if (reached(steepest)) return false;
    }
    return true;
  }

  /// True as soon as surface is found that must be shown.
  bool look_into(const GridCube& cube) {
    const Box box = tree_.grid().box(cube.place, cube.level);
    if (run_.cancelled()) return false;
    if (++cubes_ > most_cubes_) return places_.push_back(box.center()), false;
    if (is_bare(box)) return false;
    const Ball ball = circumscribed_ball(box);
    const double far = kFar * tolerance_;
    if (ball.radius <= far && polygons_.distance(ball.center, far - ball.radius) <= far - ball.radius) return false;
    const Sample middle = evaluator_.sample(field_, ball.center);
    if (is_settled(ball, direction_of(middle.gradient)) || is_out_of_reach(box, ball, middle)) return false;
    const bool is_last = cube.level <= finest_;
    if (is_last || polygons_.distance(ball.center, far + ball.radius) > far + ball.radius) {
      const Kinds kinds = kinds_in(box);
      if (kinds.thick_wood && kinds.thick_air) return places_.push_back(ball.center), true;
      if (is_last && kinds.may_hide_wood()) places_.push_back(ball.center);
    }
    if (is_last) return false;
    for (std::uint32_t c = 0; c < 8; ++c)
      if (look_into(cube.part(c))) return true;
    return false;
  }

  bool is_inside(const Vec3& p) { return evaluator_.value(field_, p) >= kIso; }

  /// Whether the wood or air that a point is in is no thinner beside it than what leaves can show.
  bool is_thick(const Vec3& beside, bool inside) {
    const Vec3 p = beside + (inside ? 0.5 : -0.5) * tree_.narrow() * uphill(beside);
    if (is_inside(p) != inside) return false;
    for (int a = 0; a < 3; ++a)
      for (const double side : {-0.5, 0.5}) {
        Vec3 q = p;
        q[a] += 0.98 * side * tree_.narrow();
        if (is_inside(q) != inside) return false;
      }
    return true;
  }

  /// What is seen of a cube at its corners and in its middle.
  struct Kinds {
    bool wood = false, air = false;
    bool thick_wood = false, thick_air = false;   // looked for only where there are both
    /// All wood, or thick wood and a gap that is too narrow: what is hidden is air.
    bool may_hide_wood() const { return !wood || (air && !thick_wood); }
  };
  Kinds kinds_in(const Box& box) {
    std::array<Vec3, 9> places;
    std::array<bool, 9> inside{};
    Kinds kinds;
    for (std::size_t c = 0; c < places.size(); ++c) {
      places[c] = box.center();
      for (int a = 0; a < 3 && c < 8; ++a) places[c][a] = c >> a & 1 ? box.hi[a] : box.lo[a];
      inside[c] = is_inside(places[c]);
      (inside[c] ? kinds.wood : kinds.air) = true;
    }
    if (!kinds.wood || !kinds.air) return kinds;
    for (std::size_t c = 0; c < places.size(); ++c) {
      bool& thick = inside[c] ? kinds.thick_wood : kinds.thick_air;
      thick = thick || is_thick(places[c], inside[c]);
    }
    return kinds;
  }

  const SurfaceOctree& tree_;
  const SurfaceCover& cover_;
  NearbyPolygons polygons_;
  double tolerance_;
  const RunOptions& run_;
  Evaluator evaluator_;
  std::uint32_t cell_ = kNoCell;
  GridCube region_;
  PrunedField field_;   // of the cell in the region and a little around it
  bool only_blends_ = false;
  int finest_ = 0;
  int cubes_ = 0, most_cubes_ = 0;
  std::vector<Vec3> places_;
};

std::optional<std::vector<std::uint32_t>> MissedSurface::find(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour,
                                                              const PlacedPolygons& placed, const RunOptions& run) {
  const std::size_t first = std::exchange(first_new_, tree.leaves().size());
  auto listed = in_chunks<std::vector<std::uint32_t>>(first_new_ - first, 4096, [&](auto& part, std::size_t begin, std::size_t end) {
    std::uint32_t cell = kNoCell;
    bool only_blends = false;   // in that cell
    for (std::size_t i = first + begin; i < first + end; ++i) {
      const OctreeLeaf& leaf = tree.leaves()[i];
      if (leaf.cell != cell) only_blends = ActiveChain::only_blend(cover.cube_field(cell = leaf.cell));
      if (!only_blends && tree.find(leaf.place) == i) part.push_back(static_cast<std::uint32_t>(i));
    }
  });
  std::vector<std::uint32_t> leaves, to_cut;
  append_parts(listed, leaves);
  if (leaves.empty()) return to_cut;
  const PatchesOfLeaves patches(contour, tree.leaves().size());
  const NearbyPolygons polygons(tree, contour, placed, patches);
  tbb::enumerable_thread_specific<Search> searches([&] { return Search(tree, cover, polygons, placed.tolerance, run); });
  const auto parts = in_chunks<Found>(leaves.size(), kLeavesPerTask, [&](Found& part, std::size_t begin, std::size_t end) {
    Search& search = searches.local();
    for (std::size_t i = begin; i < end && !run.cancelled(); ++i) search.look_through(leaves[i], part);
  });
  if (run.cancelled()) return std::nullopt;
  for (const Found& part : parts) {
    to_cut.insert(to_cut.end(), part.leaves.begin(), part.leaves.end());
    doubts_.insert(doubts_.end(), part.doubts.begin(), part.doubts.end());
  }
  return to_cut;
}

std::vector<Vec3> MissedSurface::uncertain(const SurfaceOctree& tree) const {
  std::vector<Vec3> places;
  for (const Doubt& doubt : doubts_)
    if (tree.find(tree.leaves()[doubt.leaf].place) == doubt.leaf) places.push_back(doubt.place);
  return places;
}

}  // namespace cambium
