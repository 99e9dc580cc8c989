// The vertices and polygons of a contour near a box, of one box after another.
#pragma once

#include "polygonize/polygon_split.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

/// Where the vertices are, by patch, and how polygons are cut, by edge; where that is not told, as split_of() would.
struct PlacedPolygons {
  const std::vector<Vec3>& positions;
  const std::vector<std::optional<Split>>& splits;
  double tolerance;   ///< metres
};

/// A cube of the octree's grid, of 2^level units along its edge, that need not be a leaf.
struct GridCube {
  CellPlace place{};
  int level = 0;
  GridCube part(std::uint32_t child) const {
    GridCube made{place, level - 1};
    for (int a = 0; a < 3; ++a) made.place[a] += (child >> a & 1) << made.level;
    return made;
  }
};

/// The living patches of each leaf.
class PatchesOfLeaves {
 public:
  PatchesOfLeaves(const Contour& contour, std::size_t leaves);
  std::span<const std::uint32_t> of(std::uint32_t leaf) const { return {patches_.data() + first_[leaf], first_[leaf + 1] - first_[leaf]}; }

 private:
  std::vector<std::uint32_t> first_, patches_;
};

/// Vertices and polygons are found when they are first asked for. Scratch of one thread; what it is made of outlives it.
class NearbyPolygons {
 public:
  NearbyPolygons(const SurfaceOctree& tree, const Contour& contour, const PlacedPolygons& placed, const PatchesOfLeaves& patches)
      : tree_(tree), contour_(contour), placed_(placed), positions_(placed.positions), patches_of_(patches) {}

  /// From now on the vertices are those of the leaves that reach to within `reach` of a box, metres, and the polygons those around them.
  /// Where the box, is small beside it they are looked for near by first.
  void turn_to(const Box& box, double reach) {
    center_ = box;
    farthest_ = reach;
    const double edge = box.hi.x - box.lo.x;
    look_within(edge > 0 ? std::min(reach, kFirstReach * edge) : reach);
  }
  /// To the nearest polygon; infinite if there are none. Where it is less than `enough`, anything between.
  double distance(const Vec3& p, double enough);
  /// To the nearest vertex that is in a box.
  double distance_to_vertex(const Vec3& p, const Box& in);

 private:
  struct Triangle {
    Vec3 a, b, c;
    Ball around;
  };
  /// Of an edge, cut as it will be: a fan of four at most.
  struct Polygon {
    std::uint32_t edge = 0xffffffffu;
    std::size_t count = 0;
    std::array<Triangle, 4> triangles;
    void add(const Vec3& a, const Vec3& b, const Vec3& c);
  };

  static constexpr double kFirstReach = 2, kWiden = 4;   // box edges; and times, where that is not enough
  void look_within(double reach) {
    reach_ = reach;
    box_ = center_.padded(reach);
    knows_patches_ = knows_triangles_ = false;
  }
  bool widen() {
    if (reach_ >= farthest_) return false;
    look_within(std::min(kWiden * reach_, farthest_));
    return true;
  }
  double distance_here(const Vec3& p, double enough);
  double distance_to_vertex_here(const Vec3& p, const Box& in);
  void find_patches();
  void append_patches(SurfaceOctree::Node node, const GridCube& cube);
  void find_triangles();
  const Polygon& polygon_of(std::uint32_t edge);
  void cut(std::uint32_t edge, Polygon& polygon) const;

  const SurfaceOctree& tree_;
  const Contour& contour_;
  const PlacedPolygons& placed_;
  const std::vector<Vec3>& positions_;
  const PatchesOfLeaves& patches_of_;
  Box center_, box_;
  double reach_ = 0, farthest_ = 0;
  bool knows_patches_ = false, knows_triangles_ = false;
  std::vector<std::uint32_t> near_, edges_;   // patches, and the edges around them
  std::vector<Triangle> triangles_;
  std::vector<Polygon> kept_ = std::vector<Polygon>(512);   // by edge; another takes its place
};

}  // namespace cambium
