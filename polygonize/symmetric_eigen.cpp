#include "polygonize/symmetric_eigen.h"

#include <algorithm>
#include <cmath>

namespace cambium {

void symmetric_eigen(const Mat3& matrix, Vec3& values, Mat3& vectors) {
  Mat3 a = matrix;
  vectors = Mat3(1.0);
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    const double on = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
    if (off <= 1e-28 * on) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {   // columns, then rows
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
        const Vec3 vp = vectors[p], vq = vectors[q];
        vectors[p] = c * vp - s * vq;
        vectors[q] = s * vp + c * vq;
      }
    }
  }
  values = {a[0][0], a[1][1], a[2][2]};
}

}  // namespace cambium
