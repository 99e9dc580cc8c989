// How a polygon is cut into triangles that stay inside its edge's envelope (Ju & Udeshi 2006).
#pragma once

#include "polygonize/contour.h"
#include "polygonize/polygon_ring.h"

namespace cambium {

/// A minimal edge in the frame of its polygon: coordinates along it and across it.
struct EdgeFrame {
  int a = 0, b = 1, c = 2;
  double low = 0, high = 0;          // along a
  double at_b = 0, at_c = 0;

  EdgeFrame(const SurfaceOctree& tree, const MinimalEdge& edge)
      : a(edge.axis), b((edge.axis + 1) % 3), c((edge.axis + 2) % 3) {
    const Vec3 from = edge_point(tree, edge, 0), to = edge_point(tree, edge, 1);
    low = from[a], high = to[a], at_b = from[b], at_c = from[c];
  }
  /// Across, then along.
  Vec3 local(const Vec3& p) const { return {p[b] - at_b, p[c] - at_c, p[a]}; }
};

enum class Split : std::uint8_t {
  kFirst,    ///< by the diagonal from corner 0; a triangle as it is
  kSecond,   ///< by that from corner 1
  kFan       ///< around the place where the surface crosses the edge
};

/// Which of kFirst and kSecond keep inside the envelope; the fan always does.
std::array<bool, 2> fitting_splits(const SurfaceOctree& tree, const Contour& contour, std::uint32_t edge, const Ring& ring,
                                   const std::vector<Vec3>& positions);

/// The diagonal that suits better of those that fit, as crossings, normals and shapes tell: where one is off by more than half of
/// `tolerance` (metres), the other if it is less. The fan if none fits.
Split split_of(const SurfaceOctree& tree, const Contour& contour, std::uint32_t edge, const Ring& ring,
               const std::vector<Vec3>& positions, double tolerance);

}  // namespace cambium
