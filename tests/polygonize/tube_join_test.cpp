// How tubes are joined to the open ends of meshes.
#include "polygonize/tube_join.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kRadius = 0.01, kTolerance = 0.001;
constexpr std::uint32_t kSides = 12, kRings = 4;

/// The lower part of an upright twig, open above: vertex kSides i + k is corner k of ring i, a radius apart.
struct OpenTwig {
  std::vector<ChainNode> nodes{{{0, 0, 0}, kRadius}, {{0, 0, 0.2}, kRadius}};
  ChainPath path{nodes};
  Mesh mesh;
  MeshBorder border;

  OpenTwig() {
    for (std::uint32_t i = 0; i < kRings; ++i)
      for (std::uint32_t k = 0; k < kSides; ++k) mesh.positions.push_back(corner(k, 0.05 + kRadius * i));
    for (std::uint32_t i = 0; i + 1 < kRings; ++i)
      for (std::uint32_t k = 0; k < kSides; ++k) {
        const std::uint32_t a = kSides * i + k, b = kSides * i + (k + 1) % kSides;
        mesh.triangles.push_back({a, b, b + kSides});
        mesh.triangles.push_back({a, b + kSides, a + kSides});
      }
    std::vector<std::uint8_t> may_be_open(mesh.positions.size(), 1);
    std::fill_n(may_be_open.begin(), kSides, std::uint8_t{0});
    border = find_border(mesh, may_be_open);
  }
  static Vec3 corner(double k, double z) {
    const double angle = 2 * std::numbers::pi * k / kSides;
    return {kRadius * std::cos(angle), kRadius * std::sin(angle), z};
  }
  std::uint32_t at_end(std::uint32_t k) const { return kSides * (kRings - 1) + k; }
  static TubeRing ring() { return {0.11, {0, 0, 0.11}, {0, 0, 1}, {1, 0, 0}, 8}; }
  TubeJoin join() const { return {path, ring(), false, mesh, border, 0, kTolerance}; }
  bool joins() const {
    Tube tube;
    std::uint32_t first = 0;
    for (std::uint32_t k = 0; k < ring().sides; ++k) {
      const std::uint32_t added = tube.add(ring_corner(path, ring(), k));
      if (k == 0) first = added;
    }
    return join().add_to(tube, first);
  }
};

TEST(TubeJoin, AnEvenEndIsJoined) {
  const OpenTwig twig;
  ASSERT_EQ(twig.border.loops.size(), 1u);
  EXPECT_TRUE(twig.joins());
  EXPECT_TRUE(twig.join().is_untangled());
}

TEST(TubeJoin, AKnotInTheLineIsInTheWayUntilItIsEased) {
  OpenTwig twig;
  std::swap(twig.mesh.positions[twig.at_end(3)], twig.mesh.positions[twig.at_end(4)]);   // the line goes back and forth
  EXPECT_FALSE(twig.joins());
  EXPECT_FALSE(twig.join().is_untangled());
  for (int round = 0; round < 4 && !(twig.joins() && twig.join().is_untangled()); ++round) {
    for (const auto& [vertex, to] : twig.join().eased()) twig.mesh.positions[vertex] = to.position;
  }
  EXPECT_TRUE(twig.joins());
  EXPECT_TRUE(twig.join().is_untangled());
}

TEST(TubeJoin, WhatIsEasedIsAtTheEndAndOnTheSurface) {
  const OpenTwig twig;
  const auto eased = twig.join().eased();
  ASSERT_EQ(eased.size(), 2 * kSides);
  for (std::size_t i = 0; i < eased.size(); ++i) {
    EXPECT_EQ(eased[i].vertex, kSides * (kRings - 2) + i);
    EXPECT_NEAR(std::hypot(eased[i].to.position.x, eased[i].to.position.y), kRadius, 1e-9);
    EXPECT_NEAR(glm::dot(eased[i].to.normal, eased[i].to.position), kRadius, 1e-9);   // straight out
    EXPECT_LE(glm::distance(eased[i].to.position, twig.mesh.positions[eased[i].vertex]), kRadius);
  }
}

}  // namespace
}  // namespace cambium
