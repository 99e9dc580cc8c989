#include "lsystem/outline_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <random>

namespace cambium {
namespace {

using Outline = std::vector<Vec3>;

OutlineTriangles cut(const Outline& outline) { return triangulated(outline, {}).value(); }

double area_of(const Outline& outline, const OutlineTriangles& triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles)
    area += 0.5 * glm::length(glm::cross(outline[b] - outline[a], outline[c] - outline[a]));
  return area;
}

double area_inside(const Outline& outline) {
  Vec3 twice(0.0);
  for (std::size_t i = 0; i < outline.size(); ++i) twice += glm::cross(outline[i], outline[(i + 1) % outline.size()]);
  return 0.5 * glm::length(twice);
}

/// A star: corners at random distances, in order around the origin.
Outline star(std::size_t corners, std::uint32_t seed, const Vec3& u, const Vec3& v) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> distance(0.05, 1);
  Outline out;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    out.push_back(distance(random) * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return out;
}

TEST(OutlineTriangles, CoverTheInsideOfConcaveOutlinesOnce) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const Outline outline = star(3 + seed % 40, seed, glm::normalize(Vec3(1, 2, 3)), glm::normalize(Vec3(3, 0, -1)));
    const OutlineTriangles triangles = cut(outline);
    EXPECT_EQ(triangles.size(), outline.size() - 2) << seed;
    EXPECT_NEAR(area_of(outline, triangles), area_inside(outline), 1e-12) << seed;
  }
}

TEST(OutlineTriangles, RunAsTheOutlineDoes) {
  Outline outline = star(17, 4, {1, 0, 0}, {0, 1, 0});
  for (const double side : {1.0, -1.0}) {
    for (const auto& [a, b, c] : cut(outline))
      EXPECT_GT(side * glm::cross(outline[b] - outline[a], outline[c] - outline[a]).z, 0);
    std::reverse(outline.begin(), outline.end());
  }
}

TEST(OutlineTriangles, StraightCornersAndSpikesMakeNone) {
  const Outline square = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_NEAR(area_of(square, cut(square)), 1, 1e-12);
}

TEST(OutlineTriangles, BentOutlinesKeepTheirCorners) {
  Outline leaf = star(12, 9, {1, 0, 0}, {0, 1, 0});
  for (Vec3& corner : leaf) corner.z = 0.2 * corner.x * corner.x;
  EXPECT_EQ(cut(leaf).size(), 10u);
}

TEST(OutlineTriangles, WhatHasNoAreaHasNone) {
  EXPECT_TRUE(cut({}).empty());
  EXPECT_TRUE(cut({{1, 0, 0}}).empty());
  EXPECT_TRUE(cut({{1, 0, 0}, {0, 1, 0}}).empty());
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}, {0.2, 0.2, 0.2}}).empty());
  EXPECT_TRUE(cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).empty());
}

TEST(OutlineTriangles, CrossingEdgesDoNotHangIt) {
  EXPECT_FALSE(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).empty());  // an eight without an area of its own
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 100; ++round) {
    Outline outline;
    for (int i = 0; i < 30; ++i) outline.push_back({place(random), place(random), 0.1 * place(random)});
    EXPECT_LE(cut(outline).size(), 28u);
  }
}

TEST(OutlineTriangles, IsCancelled) {
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(triangulated(star(2000, 1, {1, 0, 0}, {0, 1, 0}), run));
}

}  // namespace
}  // namespace cambium
