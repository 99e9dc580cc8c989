// The point that best fits a set of tangent planes (Ju et al. 2002): the feature a cell's vertex is put on.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// Sum over planes of (n . (x - p))^2. Normals have unit length; any length unit, best with values near 1.
class Qef {
 public:
  void add(const Vec3& point, const Vec3& normal);
  void clear() { *this = Qef{}; }

  struct Solution {
    Vec3 point{0.0};
    int rank = 0;      ///< directions that the planes determine: 1 on a flat patch, 2 on an edge, 3 in a corner
  };
  /// The minimum nearest to `near`: directions along which the planes say little (eigenvalue below a twentieth of the largest)
  /// keep the coordinate of `near`.
  Solution solve(const Vec3& near) const;

 private:
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;   // sum of n n^T
  Vec3 b_{0.0};                                                   // sum of n (n . p)
};

/// Eigenvalues (not sorted) and unit eigenvectors (columns) of a symmetric matrix, by cyclic Jacobi rotations.
void symmetric_eigen(const Mat3& matrix, Vec3& values, Mat3& vectors);

}  // namespace cambium
