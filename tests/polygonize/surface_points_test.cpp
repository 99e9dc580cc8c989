#include "polygonize/surface_points.h"

#include "blobtree/input_error.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cambium {
namespace {

struct Placed {
  Vec3 at, normal;
};

std::vector<Placed> points_of(const Field& field, double voxel) {
  const Lattice lattice = make_lattice(field.bounds(), voxel);
  const auto points = surface_points(field, lattice, {});
  EXPECT_TRUE(std::is_sorted(points->begin(), points->end(), [](const auto& a, const auto& b) { return a.block < b.block; }));
  std::vector<Placed> placed;
  for (const SurfacePoint& point : *points) {
    CellPlace place{};
    for (int bit = 0; bit < kMostLevels; ++bit)
      for (int a = 0; a < 3; ++a) place[a] |= static_cast<std::uint32_t>(point.block >> (3 * bit + a) & 1) << bit;
    placed.push_back({lattice.box(place).lo + voxel * Vec3(point.at), Vec3(point.normal)});
  }
  return placed;
}

TEST(SurfacePoints, LieOnTheSurfaceAndFaceOutwards) {
  for (const Field& field : {testing::torus_field(), testing::fork_field(), testing::random_field(4)}) {
    const double voxel = 0.05;
    const auto points = points_of(field, voxel);
    EXPECT_GT(points.size(), 300u);
    for (const Placed& p : points) {
      const Sample s = field.sample(p.at);
      const double slope = glm::length(s.gradient);
      EXPECT_LT(std::abs(s.value - kIso) / slope, 0.06 * voxel);
      EXPECT_NEAR(glm::length(p.normal), 1, 1e-4);
    }
  }
}

TEST(SurfacePoints, LeaveNoPlaceOfASphereOrOfATwigWithoutOneNearBy) {
  const double voxel = 0.1;
  const auto on_sphere = points_of(testing::sphere_field(1, Vec3(0)), voxel);
  for (int i = 0; i < 2000; ++i) {   // a spiral over the sphere
    const double z = -1 + (i + 0.5) / 1000, angle = 2.4 * i, across = std::sqrt(1 - z * z);
    const Vec3 at(across * std::cos(angle), across * std::sin(angle), z);
    double nearest = kInfinity;
    for (const Placed& p : on_sphere) nearest = std::min(nearest, glm::distance(p.at, at));
    EXPECT_LT(nearest, 0.9 * voxel);
  }
  const double radius = 0.03;
  const auto on_twig = points_of(testing::field_of(Capsule{Vec3(0), Vec3(0, 0.4, 1), radius, 1}), voxel);
  const Vec3 along = glm::normalize(Vec3(0, 0.4, 1)), side(1, 0, 0), other = glm::cross(along, side);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 at = 0.001 * i * Vec3(0, 0.4, 1) + radius * (std::cos(2.4 * i) * side + std::sin(2.4 * i) * other);
    double nearest = kInfinity;
    for (const Placed& p : on_twig) nearest = std::min(nearest, glm::distance(p.at, at));
    EXPECT_LT(nearest, 1.2 * radius);
  }
}

}  // namespace
}  // namespace cambium
