// Eigenvalues of small symmetric matrices.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// Eigenvalues (not sorted) and unit eigenvectors (columns) of a symmetric matrix, by cyclic Jacobi rotations.
void symmetric_eigen(const Mat3& matrix, Vec3& values, Mat3& vectors);

}  // namespace cambium
