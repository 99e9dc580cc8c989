#include "skeletons/graph/revolution.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/solids.h"
#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
using Stroke = std::vector<glm::dvec2>;

/// A crown with bays all the way up.
Stroke wavy(int points) {
  Stroke stroke;
  for (int i = 0; i <= points; ++i) {
    const double t = i / double(points);
    stroke.emplace_back(std::sin(kPi * t) * (1 + 0.3 * std::sin(40 * t)), 3 * t + 0.03 * std::sin(80 * t));
  }
  stroke.front().x = stroke.back().x = 0;
  return stroke;
}

Vec3 at(double r, double z, double angle = 0.7) { return {r * std::cos(angle), r * std::sin(angle), z}; }

/// By a walk along all lines.
bool contains_slowly(const Stroke& stroke, double r, double z) {
  bool inside = false;
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const glm::dvec2 a = i > 0 ? stroke[i - 1] : glm::dvec2{0, stroke[0].y}, b = stroke[i];
    if ((a.y > z) != (b.y > z) && a.x + (z - a.y) / (b.y - a.y) * (b.x - a.x) > r) inside = !inside;
  }
  return inside;
}

TEST(Revolution, OfALineIsACylinderAConeOrWhatIsBetween) {
  Draws draws(1);
  const RevolvedStroke upright(Stroke{{1, 0}, {1, 2}}), leaning(Stroke{{2, -1}, {0, 1}}), flat(Stroke{{0, 3}, {1, 3}, {1, 4}});
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = draws.point({Vec3(-2.2, -2.2, -1.2), Vec3(2.2, 2.2, 4.2)});
    const double r = std::hypot(p.x, p.y);
    EXPECT_EQ(upright.contains(p), r < 1 && 0 < p.z && p.z < 2);
    EXPECT_EQ(leaning.contains(p), p.z > -1 && r < 1 - p.z);
    EXPECT_EQ(flat.contains(p), r < 1 && 3 < p.z && p.z < 4);
    if (!upright.contains(p)) continue;
    EXPECT_NEAR(upright.depth(p), std::min({p.z, 2 - p.z, 1 - r}), 1e-12);
  }
}

TEST(Revolution, ContainsWhatAWalkAlongTheStrokeSays) {
  Draws draws(2);
  for (const int points : {3, 40, 10000}) {
    const Stroke stroke = wavy(points);
    const RevolvedStroke solid(stroke);
    for (int i = 0; i < 3000; ++i) {
      const double r = draws.in(0, 1.5), z = draws.in(-0.2, 3.2);
      EXPECT_EQ(solid.contains(at(r, z, draws.in(0, 6))), contains_slowly(stroke, r, z)) << r << " " << z;
    }
  }
}

TEST(Revolution, AClosedStrokeOffItsAxisIsARing) {
  Stroke stroke;
  for (int i = 0; i < 200; ++i) stroke.emplace_back(3 + std::cos(kPi * i / 100), std::sin(kPi * i / 100));
  stroke.push_back(stroke.front());
  validate_stroke(stroke);
  const RevolvedStroke ring(stroke);
  EXPECT_TRUE(ring.contains(at(3, 0)));
  EXPECT_FALSE(ring.contains(at(0, 0)));
  EXPECT_FALSE(ring.contains(at(1.9, 0)));
  EXPECT_NEAR(ring.depth(at(3, 0)), 1, 1e-3);
  EXPECT_FALSE(ring.meets({0, 0, -9}, {0, 0, 9}));
  EXPECT_TRUE(ring.meets({-9, 0, 0}, {9, 0, 0}));
}

TEST(Revolution, IsAsDeepAsTheNearestPointOfItsSurfaceIsFar) {
  Draws draws(3);
  const Stroke stroke = wavy(300);
  const RevolvedStroke solid(stroke);
  for (int i = 0; i < 500; ++i) {
    const double r = draws.in(0, 1.3), z = draws.in(0, 3);
    if (!solid.contains(at(r, z))) continue;
    double least = kInfinity;
    for (std::size_t k = 1; k < stroke.size(); ++k)
      for (int s = 0; s <= 20; ++s) least = std::min(least, glm::length(glm::mix(stroke[k - 1], stroke[k], s / 20.0) - glm::dvec2{r, z}));
    EXPECT_LE(solid.depth(at(r, z)), least + 1e-12);
    EXPECT_GE(solid.depth(at(r, z)), least - 1e-3);
  }
}

TEST(Revolution, StraightWaysMeetItWhereTheirPointsAreInIt) {
  Draws draws(4);
  const RevolvedStroke solids[] = {RevolvedStroke(wavy(80)), RevolvedStroke(Stroke{{1, 0}, {1, 2}}),
                                   RevolvedStroke(Stroke{{0.3, 0}, {1.2, 1}, {0.1, 1}, {0, 3}})};
  const Box around{Vec3(-1.5, -1.5, -0.5), Vec3(1.5, 1.5, 3.5)};
  int met = 0, missed = 0;
  for (const RevolvedStroke& solid : solids)
    for (int i = 0; i < 2000; ++i) {
      const Vec3 a = draws.point(around), b = i % 3 ? draws.point(around) : a + draws.in(0, 0.3) * draws.direction();
      int inside = 0;
      for (int s = 0; s <= 400; ++s) inside += solid.contains(glm::mix(a, b, s / 400.0));
      const bool meets = solid.meets(a, b);
      (meets ? met : missed) += 1;
      EXPECT_TRUE(meets || inside == 0);
      // What sampling misses is a short way below the surface.
      if (inside == 0 && meets) {
        double least = kInfinity;
        for (int s = 0; s <= 400; ++s) least = std::min(least, solid.depth(glm::mix(a, b, s / 400.0)));
        EXPECT_LT(least, 0.01);
      }
    }
  EXPECT_GT(met, 500);
  EXPECT_GT(missed, 500);
}

TEST(Revolution, RefusesStrokesThatSweepNoSolidNamingThePoint) {
  const std::tuple<Stroke, const char*, const char*> table[] = {
      {{}, "a stroke of 0 points", "2 to"},
      {{{1, 0}}, "a stroke of 1 points", "2 to"},
      {Stroke((1 << 16) + 1, {1, 0}), "65537 points", "2 to 65536"},
      {{{1, 0}, {NAN, 1}}, "point 2", "finite"},
      {{{1, 0}, {1, INFINITY}}, "point 2", "finite"},
      {{{0, 0}, {1, 1}, {-0.25, 2}}, "point 3, (-0.250000, 2.000000)", "does not cross its axis"},
      {{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, "between points 1 and 2 and between points 3 and 4", "does not cross itself"},
      {{{1, 0}, {1, 1}, {0.5, -1}}, "between the axis and point 1 and between points 2 and 3", "does not cross itself"},
      {{{0, 0}, {0.5, 2}, {0.5, 1}, {1, 1}}, "between points 1 and 2 and between point 4 and the axis", "does not cross itself"},
      {{{0, 0}, {1, 1}, {0, 0}}, "no area", "encloses"},
      {{{0, 0}, {0, 1}}, "no area", "encloses"},
      {{{0, 1}, {2, 1}}, "no area", "encloses"},
      {{{2, 1}, {2, 1}}, "no area", "encloses"},
  };
  for (const auto& [stroke, found, expected] : table) {
    SCOPED_TRACE(found);
    try {
      validate(RevolutionSolid{stroke});
      FAIL() << "was taken";
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find("stroke"), std::string::npos) << error.what();
      EXPECT_NE(error.found().find(found), std::string::npos) << error.what();
      EXPECT_NE(error.expected().find(expected), std::string::npos) << error.what();
    }
  }
}

TEST(Revolution, TakesStrokesThatOnlyTouchTheirAxis) {
  validate_stroke(Stroke{{0, 0}, {1, 1}, {0, 2}, {1, 3}, {0, 4}});
  validate_stroke(Stroke{{1, 0}, {1, 0}, {1, 2}});
  validate_stroke(Stroke{{0, 0}, {0, 2}, {1, 1}, {0, 0}});
  validate_stroke(wavy(10000));
}

}  // namespace
}  // namespace cambium
