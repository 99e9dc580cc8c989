// Surface that a contour passes over: a sheet, a bump or a fin in leaves that show another part of it, or beside them. Corners tell
// nothing of it, and polygons are measured only where they are.
#pragma once

#include "polygonize/nearby_polygons.h"

#include <optional>
#include <vector>

namespace cambium {

/// Goes through the leaves of a contour that is refined. Every part of a leaf must be free of surface, near the polygons, or hold one
/// sheet only, that of a vertex near by: bounds of the field's values and slopes say so for certain, or the part is cut in eight, down
/// to the smallest cubes. Where primitives only blend (ActiveChain::only_blend) all is left out: no wood there is thinner than the
/// radii that leaves were sized by, but for webs between two of them.
class MissedSurface {
 public:
  /// Of the leaves made since the last call, those that hold surface farther than 1.8 tolerances from all polygons, so thick that
  /// smaller leaves would show it; ascending. nullopt if cancelled. The same at any thread count. Cost: a bound for every leaf, some
  /// thousands where that is not enough.
  std::optional<std::vector<std::uint32_t>> find(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour,
                                                 const PlacedPolygons& placed, const RunOptions& run);

  /// Where surface is missed that is too thin to be shown, or may be: the field's bounds do not rule it out. Gaps narrower than tree.narrow() do not count.
  std::vector<Vec3> uncertain(const SurfaceOctree& tree) const;

 private:
  struct Doubt {
    std::uint32_t leaf = 0;
    Vec3 place{0.0};
  };
  struct Found;
  class Search;

  std::size_t first_new_ = 0;
  std::vector<Doubt> doubts_;
};

}  // namespace cambium
