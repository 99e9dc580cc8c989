#include "polygonize/qef.h"

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

void Qef::add(const Vec3& point, const Vec3& n) {
  xx_ += n.x * n.x;
  xy_ += n.x * n.y;
  xz_ += n.x * n.z;
  yy_ += n.y * n.y;
  yz_ += n.y * n.z;
  zz_ += n.z * n.z;
  b_ += n * glm::dot(n, point);
}

namespace {

constexpr double kTruncation = 0.05;   // keeps edges sharper than about 25 degrees, drops the curvature of round twigs

/// The largest eigenvalue and its vector where all others are dropped, which on smooth surfaces they are: each round of the power
/// method then leaves at most a twentieth of the error. False elsewhere.
bool single_direction(const Mat3& a, double& value, Vec3& vector) {
  const int largest = a[0][0] >= a[1][1] && a[0][0] >= a[2][2] ? 0 : a[1][1] >= a[2][2] ? 1 : 2;
  const double trace = a[0][0] + a[1][1] + a[2][2];
  Vec3 v = a[largest];
  for (int round = 0; round < 12; ++round) {
    const double length = glm::length(v);
    if (!(length > 0)) return false;
    v = a * (v / length);
  }
  value = glm::length(v);
  vector = v / value;
  return trace - value <= kTruncation * value;
}

}  // namespace

Qef::Solution Qef::solve(const Vec3& near) const {
  const Mat3 a(xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_);
  Vec3 values;
  Mat3 vectors;
  const Vec3 residual = b_ - a * near;
  double value = 0;
  if (Vec3 direction; single_direction(a, value, direction)) {
    return {near + direction * (glm::dot(direction, residual) / value), 1};
  }
  symmetric_eigen(a, values, vectors);
  const double largest = std::max({values.x, values.y, values.z});
  Solution solution{near, 0};
  if (!(largest > 0)) return solution;
  for (int i = 0; i < 3; ++i) {
    if (values[i] <= kTruncation * largest) continue;
    solution.point += vectors[i] * (glm::dot(vectors[i], residual) / values[i]);
    ++solution.rank;
  }
  return solution;
}

}  // namespace cambium
