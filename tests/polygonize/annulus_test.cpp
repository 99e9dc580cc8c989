// That an annulus between two lines is filled once, whatever the lower line is.
#include "polygonize/annulus.h"


#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace cambium {
namespace {

using Line = std::vector<glm::dvec2>;
constexpr double kGirth = 6;

Line upper_line(int sides) {
  Line line;
  for (int k = 0; k < sides; ++k) line.emplace_back(kGirth * (k + 0.3) / sides, 1);
  return line;
}

// Steps up and down, and here and there back around.
Line random_line(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  Line line;
  for (double x = 0; x < kGirth - 0.9;) {
    line.emplace_back(x, -unit(random));
    if (unit(random) < 0.3) {   // a tooth that leans back
      const double y = std::max(line.back().y, -0.6);
      line.back().y = -1.2;
      line.emplace_back(x - 0.1, y);
      line.emplace_back(x + 0.2, y);
      x += 0.3;
    }
    x += 0.35 + 0.5 * unit(random);
  }
  if (kGirth - line.back().x > 0.9) line.emplace_back((line.back().x + kGirth) / 2, -0.5);
  return line;
}

double area_below(const Line& line) {   // of one turn, down to y = -2
  double area = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    glm::dvec2 next = line[(i + 1) % line.size()];
    if (i + 1 == line.size()) next.x += kGirth;
    area += (next.x - line[i].x) * ((line[i].y + next.y) / 2 + 2);
  }
  return area;
}

void expect_filled(const Line& lower, const Line& upper, const AnnulusTriangles& found) {
  Line points = lower;
  points.insert(points.end(), upper.begin(), upper.end());
  points.insert(points.end(), found.added.begin(), found.added.end());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  double area = 0;
  for (const auto& t : found.triangles) {
    const auto from_first = [&](int k) {   // the nearest copy
      const glm::dvec2 d = points[t[k]] - points[t[0]];
      return glm::dvec2(std::remainder(d.x, kGirth), d.y);
    };
    const glm::dvec2 a = from_first(1), b = from_first(2);
    const double doubled = a.x * b.y - a.y * b.x;
    EXPECT_GT(doubled, 0);
    area += doubled / 2;
    for (int k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  }
  EXPECT_NEAR(area, area_below(upper) - area_below(lower), 1e-9);
  const auto n = static_cast<std::uint32_t>(lower.size()), m = static_cast<std::uint32_t>(upper.size());
  std::size_t open = 0;
  for (const auto& [side, times] : sides) {
    EXPECT_EQ(times, 1);
    open += !sides.contains({side.second, side.first});
  }
  EXPECT_EQ(open, lower.size() + upper.size());
  for (std::uint32_t i = 0; i < n; ++i) EXPECT_TRUE(sides.contains({i, (i + 1) % n}));
  for (std::uint32_t k = 0; k < m; ++k) EXPECT_TRUE(sides.contains({n + (k + 1) % m, n + k}));
}

const ChordExcess kAnyChord = [](const glm::dvec2&, const glm::dvec2&) { return 0.0; };

TEST(Annulus, BetweenRandomSimpleLinesIsFilledOnce) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const Line lower = random_line(random), upper = upper_line(4 + round % 9);
    const auto found = triangulate_annulus(lower, upper, kGirth, kAnyChord);
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->added.empty());
    EXPECT_EQ(found->triangles.size(), lower.size() + upper.size());
    expect_filled(lower, upper, *found);
  }
}

TEST(Annulus, DoesNotDependOnWhereItsLinesBegin) {
  const Line lower = {{0, -0.4}, {1, -0.3}, {2, -0.7}, {3, -0.5}, {4, -0.2}, {5, -0.6}}, upper = upper_line(7);
  Line turned(lower.begin() + 2, lower.end());
  for (std::size_t i = 0; i < 2; ++i) turned.emplace_back(lower[i].x + kGirth, lower[i].y);
  auto found = triangulate_annulus(lower, upper, kGirth, kAnyChord)->triangles;
  auto other = triangulate_annulus(turned, upper, kGirth, kAnyChord)->triangles;
  const auto from_lowest = [](auto& triangles) {
    for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
  };
  for (auto& t : other)
    for (std::uint32_t& corner : t)
      if (corner < lower.size()) corner = static_cast<std::uint32_t>((corner + 2) % lower.size());
  from_lowest(found);
  from_lowest(other);
  EXPECT_EQ(found, other);
}

TEST(Annulus, ChordsThatAreTooWideAreHalved) {
  std::mt19937 random(11);
  std::size_t added = 0;
  const double widest = 1.1;   // no side of these lines is wider
  const ChordExcess excess = [&](const glm::dvec2& a, const glm::dvec2& b) { return std::abs(a.x - b.x) / widest; };
  for (int round = 0; round < 40; ++round) {
    const Line lower = random_line(random), upper = upper_line(7);
    const auto found = triangulate_annulus(lower, upper, kGirth, excess);
    ASSERT_TRUE(found);
    added += found->added.size();
    expect_filled(lower, upper, *found);
    Line points = lower;
    points.insert(points.end(), upper.begin(), upper.end());
    points.insert(points.end(), found->added.begin(), found->added.end());
    const auto on_a_line = [&](std::uint32_t i, std::uint32_t j) {
      const auto neighbours = [](std::size_t a, std::size_t b, std::size_t n) { return (a + 1) % n == b || (b + 1) % n == a; };
      if (i < lower.size() && j < lower.size()) return neighbours(i, j, lower.size());
      const std::size_t end = lower.size() + upper.size();
      if (i >= lower.size() && j >= lower.size() && i < end && j < end) return neighbours(i - lower.size(), j - lower.size(), upper.size());
      return false;
    };
    for (const auto& t : found->triangles)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t i = t[k], j = t[(k + 1) % 3];
        if (!on_a_line(i, j)) { EXPECT_LE(std::abs(std::remainder(points[i].x - points[j].x, kGirth)), widest + 1e-12); }
      }
  }
  EXPECT_GT(added, 40u);
}

TEST(Annulus, ThereIsNoneBetweenLinesThatMeet) {
  const Line crossing = {{0, -0.5}, {2, -0.4}, {1, -0.3}, {1.5, -0.7}, {4, -0.5}};
  EXPECT_FALSE(triangulate_annulus(crossing, upper_line(6), kGirth, kAnyChord));
  const Line above = {{0, -0.5}, {2, 1.1}, {4, -0.5}};
  EXPECT_FALSE(triangulate_annulus(above, upper_line(6), kGirth, kAnyChord));
}

}  // namespace
}  // namespace cambium
