#include "polygonize/missed_surface.h"

#include "blobtree/lone_chain.h"
#include "polygonize/mesh_distance.h"
#include "polygonize/ordered_chunks.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace cambium {
namespace {

constexpr double kReach = 2;               // tolerances: how far polygons are looked for
constexpr double kFar = 1.8;               // from the polygons, in tolerances: these are measured to be within one, but at a few places
constexpr double kFinest = 0.5;            // the smallest cubes, in tolerances, or down to half of that
constexpr double kMostCubes = 8;           // of one leaf, for each of the smallest on a face: bounds of warped fields tell little
constexpr std::size_t kLeavesPerTask = 64;
constexpr int kRegionLevels = 2;           // above a leaf: what is active in so much of its cell is found anew
constexpr std::uint32_t kNoCell = 0xffffffffu, kNoEdge = 0xffffffffu;

using PlacedPolygons = MissedSurface::PlacedPolygons;
const Box kEverywhere{Vec3(-kInfinity), Vec3(kInfinity)};

struct Cube {
  CellPlace place;
  int level = 0;
};

Cube part_of(const Cube& cube, std::uint32_t child) {
  Cube part{cube.place, cube.level - 1};
  for (int a = 0; a < 3; ++a) part.place[a] += (child >> a & 1) << part.level;
  return part;
}

bool overlap(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.hi[k] < b.lo[k] || b.hi[k] < a.lo[k]) return false;
  return true;
}

/// The living patches of each leaf.
class PatchesOfLeaves {
 public:
  PatchesOfLeaves(const Contour& contour, std::size_t leaves) : first_(leaves + 1, 0) {
    for (const Patch& patch : contour.patches)
      if (patch.alive()) ++first_[patch.leaf + 1];
    for (std::size_t i = 0; i < leaves; ++i) first_[i + 1] += first_[i];
    patches_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t p = 0; p < contour.patches.size(); ++p)
      if (contour.patches[p].alive()) patches_[next[contour.patches[p].leaf]++] = p;
  }
  std::span<const std::uint32_t> of(std::uint32_t leaf) const { return {patches_.data() + first_[leaf], first_[leaf + 1] - first_[leaf]}; }

 private:
  std::vector<std::uint32_t> first_, patches_;
};

/// The vertices near a box and the polygons around these, each found when it is first asked for. Scratch.
class PolygonsNearby {
 public:
  PolygonsNearby(const SurfaceOctree& tree, const Contour& contour, const PlacedPolygons& placed, const PatchesOfLeaves& patches)
      : tree_(tree), contour_(contour), placed_(placed), positions_(placed.positions), patches_of_(patches) {}

  void turn_to(const Box& box) {
    box_ = box;
    knows_patches_ = knows_triangles_ = false;
  }
  /// Infinite if there are none. `enough`: a distance that need not be told from smaller ones.
  double distance(const Vec3& p, double enough) {
    double least = distance_to_vertex(p, kEverywhere);
    if (least <= enough) return least;
    if (!knows_triangles_) find_triangles();
    for (const Triangle& t : triangles_) {
      const double possible = least + t.around.radius;
      const Vec3 away = p - t.around.center;
      if (glm::dot(away, away) < possible * possible) least = std::min(least, std::sqrt(distance2_to_triangle(p, t.a, t.b, t.c)));
    }
    return least;
  }
  double distance_to_vertex(const Vec3& p, const Box& in) {
    if (!knows_patches_) find_patches();
    double least = kInfinity;
    for (const std::uint32_t patch : near_)
      if (const Vec3& v = positions_[patch]; in.contains(v)) least = std::min(least, glm::dot(v - p, v - p));
    return std::sqrt(least);
  }

 private:
  struct Triangle {
    Vec3 a, b, c;
    Ball around;
  };

  void find_patches() {
    knows_patches_ = true;
    near_.clear();
    SurfaceOctree::Node node = tree_.root();
    Cube cube{{0, 0, 0}, tree_.root_level()};
    while (node.has_children()) {   // down to where the box lies in several
      const Vec3 middle = tree_.grid().box(cube.place, cube.level).center();
      std::uint32_t child = 0;
      bool lies_in_one = true;
      for (int a = 0; a < 3; ++a) {
        if (box_.lo[a] > middle[a]) child |= 1u << a;
        lies_in_one = lies_in_one && (box_.lo[a] > middle[a] || box_.hi[a] < middle[a]);
      }
      if (!lies_in_one) break;
      node = tree_.child(node, static_cast<int>(child));
      cube = part_of(cube, child);
    }
    visit(node, cube);
  }

  void visit(SurfaceOctree::Node node, const Cube& cube) {
    if (node.is_void() || !overlap(tree_.grid().box(cube.place, cube.level), box_)) return;
    if (node.has_children()) {
      for (std::uint32_t c = 0; c < 8; ++c) visit(tree_.child(node, static_cast<int>(c)), part_of(cube, c));
      return;
    }
    const auto patches = patches_of_.of(node.leaf());
    near_.insert(near_.end(), patches.begin(), patches.end());
  }

  void find_triangles() {
    if (!knows_patches_) find_patches();
    knows_triangles_ = true;
    edges_.clear();
    triangles_.clear();
    for (const std::uint32_t p : near_) {
      const auto ring = contour_.ring(p);
      edges_.insert(edges_.end(), ring.begin(), ring.end());
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    for (const std::uint32_t e : edges_) {
      const Polygon& polygon = polygon_of(e);
      triangles_.insert(triangles_.end(), polygon.triangles.begin(), polygon.triangles.begin() + polygon.count);
    }
  }

  /// Of an edge, cut as it will be: a fan of four at most.
  struct Polygon {
    std::uint32_t edge = kNoEdge;
    int count = 0;
    std::array<Triangle, 4> triangles;
    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
      const Vec3 middle = (a + b + c) / 3.0;
      const double farthest2 = std::max({glm::dot(a - middle, a - middle), glm::dot(b - middle, b - middle), glm::dot(c - middle, c - middle)});
      triangles[static_cast<std::size_t>(count++)] = {a, b, c, {middle, std::sqrt(farthest2)}};
    }
  };

  /// Each is near several leaves, which come one after another.
  const Polygon& polygon_of(std::uint32_t e) {
    Polygon& kept = kept_[e % kept_.size()];
    if (kept.edge != e) {
      kept.edge = e;
      kept.count = 0;
      cut(e, kept);
    }
    return kept;
  }

  void cut(std::uint32_t e, Polygon& polygon) const {
    const auto& patches = contour_.patch_of_quadrant[e];
    if (std::find(patches.begin(), patches.end(), kNoPatch) != patches.end()) return;   // the surface ends here
    const Ring ring = ring_of(contour_.edges[e], patches);
    const auto corner = [&](int k) { return positions_[ring.patches[k % ring.count]]; };
    const Split split = placed_.splits[e] ? *placed_.splits[e] : split_of(tree_, contour_, e, ring, positions_, placed_.tolerance);
    if (split == Split::kFan) {
      const Vec3 center = crossing_point(tree_, contour_, e);
      for (int k = 0; k < ring.count; ++k) polygon.add(center, corner(k), corner(k + 1));
    } else {
      const int first = split == Split::kSecond ? 1 : 0;
      for (int k = 2; k < ring.count; ++k) polygon.add(corner(first), corner(first + k - 1), corner(first + k));
    }
  }

  const SurfaceOctree& tree_;
  const Contour& contour_;
  const PlacedPolygons& placed_;
  const std::vector<Vec3>& positions_;
  const PatchesOfLeaves& patches_of_;
  Box box_;
  bool knows_patches_ = false, knows_triangles_ = false;
  std::vector<std::uint32_t> near_, edges_;   // patches, and the edges around them
  std::vector<Triangle> triangles_;
  std::vector<Polygon> kept_ = std::vector<Polygon>(512);   // by edge; another takes its place
};

}  // namespace

struct MissedSurface::Found {
  std::vector<std::uint32_t> leaves;   // to be cut
  std::vector<Doubt> doubts;
};

/// Looks through one leaf after another. Scratch of one thread.
class MissedSurface::Search {
 public:
  Search(const SurfaceOctree& tree, const SurfaceCover& cover, const PolygonsNearby& polygons, double tolerance, const RunOptions& run)
      : tree_(tree), cover_(cover), polygons_(polygons), tolerance_(tolerance), run_(run) {
    while (std::ldexp(tree.grid().cell, finest_ + 1) <= kFinest * tolerance) ++finest_;
  }

  void look_through(std::uint32_t leaf, Found& found) {
    const OctreeLeaf& l = tree_.leaves()[leaf];
    enter_region_of(l);
    if (only_blends_) return;
    const Box box = tree_.box(l);
    if (!l.uniform() && falls_throughout(circumscribed_ball(box))) return;
    polygons_.turn_to(box.padded(kReach * tolerance_));
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
  bool look_into(const Cube& cube) {
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
      if (look_into(part_of(cube, c))) return true;
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
  PolygonsNearby polygons_;
  double tolerance_;
  const RunOptions& run_;
  Evaluator evaluator_;
  std::uint32_t cell_ = kNoCell;
  Cube region_{};
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
  const PolygonsNearby polygons(tree, contour, placed, patches);
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
