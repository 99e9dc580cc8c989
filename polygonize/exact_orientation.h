// On which side of a line or plane a point lies, decided exactly: rounded arithmetic where its error bound allows, expansions of
// doubles where it does not (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
#pragma once

#include "blobtree/geometry.h"

#include <cmath>
#include <limits>

namespace cambium {

/// Of orientation_3d(a, b, c, d) by rounded arithmetic alone: its sign where that is certain, else 0.
inline int quick_orientation_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double adx = a.x - d.x, ady = a.y - d.y, adz = a.z - d.z;
  const double bdx = b.x - d.x, bdy = b.y - d.y, bdz = b.z - d.z;
  const double cdx = c.x - d.x, cdy = c.y - d.y, cdz = c.z - d.z;
  const double bc1 = bdx * cdy, bc2 = cdx * bdy, ca1 = cdx * ady, ca2 = adx * cdy, ab1 = adx * bdy, ab2 = bdx * ady;
  const double det = adz * (bc1 - bc2) + bdz * (ca1 - ca2) + cdz * (ab1 - ab2);
  const double permanent = (std::abs(bc1) + std::abs(bc2)) * std::abs(adz) + (std::abs(ca1) + std::abs(ca2)) * std::abs(bdz) +
                           (std::abs(ab1) + std::abs(ab2)) * std::abs(cdz);
  // Shewchuk's bound is (7 + 56 e) e of the permanent, e = 2^-53; the constant is what underflow of products may add.
  const double bound = 8 * 0x1p-53 * permanent + 1e-290;
  return det > bound ? 1 : det < -bound ? -1 : 0;
}

/// Likewise of orientation_2d(a, b, c, axis).
inline int quick_orientation_2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double left = (a[u] - c[u]) * (b[v] - c[v]), right = (a[v] - c[v]) * (b[u] - c[u]);
  const double bound = 4 * 0x1p-53 * (std::abs(left) + std::abs(right)) + 1e-290;
  return left - right > bound ? 1 : left - right < -bound ? -1 : 0;
}

/// Sign of the determinant |a-d; b-d; c-d|: 1 where a, b, c run clockwise seen from the side on which d is not; 0 where the four
/// points lie in one plane. Exact for finite coordinates whose differences, where not 0, lie in 1e-90 to 1e90.
/// Cost: 10 ns; a microsecond or two where it is close.
int orientation_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The same of |a-c; b-c| with coordinate `axis` dropped, the next axis first: 0 where the three lie on a line there.
int orientation_2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis);

/// The three lie on one line, or some of them in one place.
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace cambium
