// A flare's sections, that it is the chain above its height, and what of it stands near its base and what does not.
#include "blobtree/flare.h"

#include "blobtree/field.h"
#include "blobtree/lone_chain.h"
#include "blobtree/surface_cover.h"
#include "random_blobtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr FlareSection kSections[] = {FlareSection::kEnvelope, FlareSection::kQuadrifolium, FlareSection::kCircle};

Field field_of(Node node, const Attributes& attributes = {}) {
  BlobTreeBuilder b;
  const NodeId id = b.add(std::move(node));
  b.set_attributes(id, attributes);
  return Field(b.build(id));
}

/// An upright trunk that reaches far below its base, so that there its section is the same at every height.
Flare post(std::vector<Prong> prongs, double sharpness, FlareSection section = FlareSection::kEnvelope, double spread = 0.6) {
  return {{{{0, 0, -20}, 0.3}, {{0, 0, 20}, 0.3}}, {0, 0, 0}, {0, 0, 1}, 1.5, spread, sharpness, std::move(prongs), section};
}
std::vector<Prong> even_prongs(int n) {
  std::vector<Prong> prongs;
  for (int i = 0; i < n; ++i) prongs.push_back({2 * kPi * i / n, 1});
  return prongs;
}

Vec3 around(double azimuth, double rho, double z) { return {rho * std::cos(azimuth), rho * std::sin(azimuth), z}; }

/// Of a post, by bisection.
double surface_radius(const Field& field, double azimuth, double z) {
  double lo = 0, hi = 3;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (lo + hi);
    (field.value(around(azimuth, middle, z)) >= kIso ? lo : hi) = middle;
  }
  return lo;
}

// The envelope's q is limited to 0.999999 (field.md section 6b), which leaves its prongs so much short.
TEST(Flare, SectionsAreOneInTheValleysAndOneAndTauOnTheProngs) {
  for (const FlareSection section : kSections)
    for (const int n : {1, 2, 3, 4, 7})
      for (const double tau : {0.0, 0.3, 0.7, 0.95}) {
        const Field field = field_of(post(even_prongs(n), tau, section));
        const double short_of = section == FlareSection::kEnvelope ? 1e-6 * tau / ((1 - tau) * (1 - tau)) : 0;
        EXPECT_NEAR(surface_radius(field, 0, -1) / (0.3 * 1.6), 1 + tau, (1 + tau) * short_of + 1e-9);
        EXPECT_NEAR(surface_radius(field, kPi / n, -1) / (0.3 * 1.6), 1, 1e-9);
        EXPECT_NEAR(surface_radius(field, 0, 1.5), 0.3, 1e-9);
      }
}

TEST(Flare, EnvelopeHoldsTheEllipsesOfOneSumOfAxes) {
  const double tau = 0.8;
  const Field field = field_of(post(even_prongs(4), tau, FlareSection::kEnvelope, 0));
  for (int i = 1; i < 40; ++i) {
    const double azimuth = i * kPi / 80;
    double widest = 0;
    for (int k = 0; k <= 20000; ++k) {
      const double x = tau * (k / 10000.0 - 1), a = 1 + x, b = 1 - x;
      widest = std::max(widest, a * b / std::hypot(b * std::cos(azimuth), a * std::sin(azimuth)));
    }
    EXPECT_NEAR(surface_radius(field, azimuth, -1) / 0.3, widest, 1e-7) << azimuth;
  }
}

TEST(Flare, QuadrifoliumAddsThatOfTheRoseToTheDisc) {
  const double tau = 0.9, petal = std::sqrt((1 + tau) * (1 + tau) - 1);
  const Field field = field_of(post(even_prongs(4), tau, FlareSection::kQuadrifolium, 0));
  for (int i = 0; i < 40; ++i) {
    const double azimuth = i * kPi / 20, rose = petal * std::cos(2 * azimuth);
    EXPECT_NEAR(surface_radius(field, azimuth, -1) / 0.3, std::hypot(1, rose), 1e-9);
  }
}

TEST(Flare, CircleOfOneProngIsACircleOffTheAxis) {
  const Field field = field_of(post({{0.4, 1}}, 0.8, FlareSection::kCircle, 0));
  const Vec3 middle = around(0.4, 0.5 * 0.8 * 0.3, -1);
  for (int i = 0; i < 40; ++i) {
    const double azimuth = i * kPi / 20;
    EXPECT_NEAR(glm::distance(around(azimuth, surface_radius(field, azimuth, -1), -1), middle), 1.4 * 0.3, 1e-9);
  }
}

TEST(Flare, ProngsHaveTheirOwnAnglesAndLengths) {
  const std::vector<Prong> prongs{{0.2, 1}, {1.7, 0.5}, {4, 0.8}};
  const Field field = field_of(post(prongs, 0.6, FlareSection::kQuadrifolium, 0));
  for (const Prong& prong : prongs) EXPECT_NEAR(surface_radius(field, prong.angle, -1) / 0.3, 1 + 0.6 * prong.length, 1e-9);
  for (const double valley : {0.95, 2.85, 2.1 + kPi}) EXPECT_NEAR(surface_radius(field, valley, -1) / 0.3, 1, 1e-9);
}

TEST(Flare, ProngsMayComeInAnyOrderAndTurn) {
  const std::vector<Prong> prongs{{0.2, 1}, {1.7, 0.5}, {4, 0.8}}, shuffled{{4 - 4 * kPi, 0.8}, {0.2 + 2 * kPi, 1}, {1.7, 0.5}};
  const Field a = field_of(post(prongs, 0.6)), b = field_of(post(shuffled, 0.6));
  Draws draws(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = draws.point({Vec3(-1, -1, -1), Vec3(1, 1, 2)});
    ASSERT_NEAR(a.value(p), b.value(p), 1e-12);
  }
}

TEST(Flare, SharpnessIsNeverAboveItsLimit) {
  const Field field = field_of(post({{0, 3}, {2, 1}}, 0.9, FlareSection::kQuadrifolium, 0));
  EXPECT_NEAR(surface_radius(field, 0, -1) / 0.3, 1.95, 1e-9);
}

TEST(Flare, CountsAzimuthsFromTheXAxisOrTheYAxis) {
  Flare trunk = post({{0, 1}}, 0.9);
  trunk.nodes = {{{0, 0, 0}, 0.3}, {{4, 0, 0}, 0.3}};
  trunk.axis = {2, 0, 0};
  EXPECT_GT(field_of(trunk).value({0.2, 0.5, 0}), field_of(trunk).value({0.2, 0, 0.5}));
  EXPECT_GT(field_of(trunk).value({0.2, 0.5, 0}), field_of(trunk).value({0.2, -0.5, 0}));
  trunk.nodes = {{{0, 0, 0}, 0.3}, {{0, 4, 0}, 0.3}};
  trunk.axis = {0, 3, 0};
  trunk.prongs[0].angle = kPi / 2;   // from x about y: against z
  EXPECT_GT(field_of(trunk).value({0, 0.2, -0.5}), field_of(trunk).value({0, 0.2, 0.5}));
}

// ---- the chain that it is -----------------------------------------------------------------------------------------------
struct Pair {
  Field flare, chain;
};
Pair with_its_chain(const Flare& trunk) {
  const Attributes attributes{.branch = 3, .order = 1, .v_begin = 2, .u_direction = {0, 1, 0}};
  return {field_of(trunk, attributes), field_of(Chain{trunk.nodes, trunk.strength}, attributes)};
}

void expect_the_same_batches(const PrunedField& flare, const PrunedField& chain, Draws& draws, double lowest) {
  constexpr std::size_t n = 100;
  std::vector<float> x, y, z, f[2], gx[2], gy[2], gz[2];
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 p = draws.point(chain.box());
    p.z = std::max(p.z, lowest);
    p -= chain.origin();
    x.push_back(static_cast<float>(p.x)), y.push_back(static_cast<float>(p.y)), z.push_back(static_cast<float>(p.z));
  }
  Evaluator evaluator;
  for (const int k : {0, 1}) {
    for (auto* const out : {&f[k], &gx[k], &gy[k], &gz[k]}) out->resize(n);
    evaluator.samples(k == 0 ? flare : chain, x, y, z, f[k], gx[k], gy[k], gz[k]);
  }
  EXPECT_EQ(f[0], f[1]);
  EXPECT_EQ(gx[0], gx[1]);
  EXPECT_EQ(gy[0], gy[1]);
  EXPECT_EQ(gz[0], gz[1]);
}

TEST(Flare, FromItsHeightUpItIsTheChainBitForBit) {
  Draws draws(7);
  std::size_t telling = 0;
  for (const FlareSection section : kSections)
    for (const std::size_t prongs : {1u, 4u, 7u}) {
      const Flare trunk = flared_trunk(prongs, 0.9, section);
      const auto [flare, chain] = with_its_chain(trunk);
      for (int i = 0; i < 200; ++i) {
        const Vec3 p = draws.point({Vec3(-0.7, -0.7, trunk.height), Vec3(0.7, 0.7, 4)});
        const Sample exact = chain.sample(p);
        ASSERT_EQ(flare.value(p), exact.value);
        ASSERT_EQ(flare.sample(p).value, exact.value);
        ASSERT_EQ(flare.sample(p).gradient, exact.gradient);
        telling += exact.value > 0;
      }
      for (int i = 0; i < 20; ++i) {
        const Vec3 lo = draws.point({Vec3(-0.6, -0.6, trunk.height), Vec3(0.4, 0.4, 3)});
        const Box above{lo, lo + draws.in(0.02, 0.4)}, across{lo - Vec3(0, 0, 0.1), lo + 0.1};
        expect_the_same_batches(flare.prune(above), chain.prune(above), draws, trunk.height);
        expect_the_same_batches(flare.prune(across), chain.prune(across), draws, trunk.height + 1e-6);
      }
    }
  EXPECT_GT(telling, 300u);
}

TEST(Flare, WithoutSpreadAndSharpnessItIsTheChainEverywhere) {
  Flare trunk = flared_trunk(3, 0);
  trunk.spread = 0;
  const auto [flare, chain] = with_its_chain(trunk);
  Draws draws(9);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = draws.point({Vec3(-0.7, -0.7, -0.7), Vec3(0.7, 0.7, 2)});
    ASSERT_EQ(flare.value(p), chain.value(p));
    ASSERT_EQ(flare.sample(p).gradient, chain.sample(p).gradient);
  }
  EXPECT_EQ(flare.bounds().lo, chain.bounds().lo);
  EXPECT_EQ(flare.bounds().hi, chain.bounds().hi);
}

TEST(Flare, BoundsGrowNearTheBaseOnly) {
  const auto [flare, chain] = with_its_chain(flared_trunk(4, 0.9));
  const auto last = static_cast<std::uint32_t>(flare.atom_count() - 1);
  EXPECT_EQ(flare.atom_bounds(last).lo, chain.atom_bounds(last).lo);
  EXPECT_EQ(flare.atom_bounds(last).hi, chain.atom_bounds(last).hi);
  const double reach = 2.2016634851 * 0.3 * 1.9 * 1.6;   // radius, sharpness, spread
  EXPECT_NEAR(flare.atom_bounds(0).lo.x, -reach, 1e-6);
  EXPECT_NEAR(flare.bounds().lo.z, -reach, 1e-6);
}

TEST(Flare, IsALoneChainWhereNothingWidensItAndNowhereElse) {
  const auto [flare, chain] = with_its_chain(flared_trunk(4, 0.9));
  std::vector<ActiveChain> chains;
  Draws draws(5);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = draws.point({Vec3(-0.6, -0.6, -0.6), Vec3(0.6, 0.6, 1.15)});
    const PrunedField near_base = flare.prune(Box{p, p}.padded(0.02));
    if (near_base.empty()) continue;
    ASSERT_FALSE(LoneChain::of(near_base));
    ASSERT_TRUE(ActiveChain::blended(near_base).empty());
    ASSERT_FALSE(ActiveChain::only_blend(near_base));
    ASSERT_FALSE(ActiveChain::all_blend(near_base, near_base.box()));
  }
  const Box high{{-0.1, -0.1, 2.9}, {0.2, 0.2, 3.1}};
  const PrunedField of_flare = flare.prune(high), of_chain = chain.prune(high);
  const auto lone = LoneChain::of(of_flare), expected = LoneChain::of(of_chain);
  ASSERT_TRUE(lone && expected);
  EXPECT_EQ(lone->branch(), 3u);
  ASSERT_EQ(lone->segment_count(), expected->segment_count());
  EXPECT_EQ(lone->segment_number(0), expected->segment_number(0));
  EXPECT_EQ(lone->nodes().size(), 7u);
  // What shares a cell with others has to tell of itself all the same.
  const PrunedField at_base = flare.prune({Vec3(-0.1), Vec3(0.1)});
  ActiveChain::append(at_base, chains);
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_GE(chains[0].segment_count(), 1u);
}

TEST(Flare, CarriesTheCoordinatesOfItsChain) {
  const Flare trunk = flared_trunk(4, 0.6);
  const auto [flare, chain] = with_its_chain(trunk);
  Evaluator evaluator;
  std::vector<Contribution> of_flare, of_chain;
  Draws draws(2);
  int below = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = draws.point({Vec3(-0.3, -0.3, 0), Vec3(0.3, 0.3, 3)});
    const Box box = Box{p, p}.padded(0.01);
    evaluator.contributions(flare.prune(box), p, of_flare);
    evaluator.contributions(chain.prune(box), p, of_chain);
    if (of_chain.empty()) continue;
    ASSERT_EQ(of_flare.size(), 1u);
    EXPECT_EQ(of_flare[0].u, of_chain[0].u);
    EXPECT_EQ(of_flare[0].v, of_chain[0].v);
    EXPECT_EQ(of_flare[0].branch, 3u);
    EXPECT_EQ(of_flare[0].order, 1u);
    const double k = std::pow(std::clamp(1 - p.z / trunk.height, 0.0, 1.0), 3);
    EXPECT_NEAR(of_flare[0].radius, of_chain[0].radius * (1 + trunk.spread * k), 1e-12);
    EXPECT_EQ(of_flare[0].weight, flare.value(p));
    EXPECT_EQ(of_flare[0].weight_gradient, flare.sample(p).gradient);
    below += p.z < trunk.height;
  }
  EXPECT_GT(below, 50);
}

// ---- smooth, and bounded ------------------------------------------------------------------------------------------------
// Round the trunk, and up it from just above the ground: nowhere does a small step turn the gradient by much.
TEST(Flare, GradientIsContinuous) {
  for (const FlareSection section : kSections)
    for (const int n : {1, 3, 4}) {
      const Field field = field_of(post(even_prongs(n), 0.6, section));
      const double step = 1e-5;
      const auto jump = [&](const Vec3& a, const Vec3& b) { return glm::length(field.sample(a).gradient - field.sample(b).gradient); };
      for (int i = 0; i < 2000; ++i) {
        const double azimuth = 2 * kPi * i / 2000 - 0.5 * step, z = 1e-3 + 1.6 * i / 2000;
        ASSERT_LT(jump(around(azimuth, 0.5, 0.2), around(azimuth + step, 0.5, 0.2)), 0.01) << azimuth;
        ASSERT_LT(jump(around(0.3, 0.4, z), around(0.3, 0.4, z + step)), 0.01) << z;
      }
      for (const double z : {1.5, 0.2})
        for (const double azimuth : {0.0, kPi / n})
          ASSERT_LT(jump(around(azimuth - step, 0.35, z - step), around(azimuth + step, 0.35, z + step)), 0.01);
    }
}

TEST(Flare, BoundsOfItsFactorHoldEverySampleAndCloseIn) {
  Draws draws(13);
  for (int turn = 0; turn < 2000; ++turn) {
    const CompiledFlare flare(flared_trunk(static_cast<std::size_t>(1 + draws.below(7)), draws.in(0, 0.95), kSections[turn % 3]));
    const Ball ball{draws.point({Vec3(-0.8, -0.8, -0.5), Vec3(0.8, 0.8, 1.5)}), std::pow(10.0, -draws.in(0, 4))};
    const Vec3 half = Vec3(ball.radius) / std::sqrt(3.0), direction = draws.direction();
    const Interval range = flare_factor_interval(flare, ball), in_box = flare_factor_interval(flare, ball, half);
    const FlareCourse course = flare_course(flare, {ball, direction}), line = flare_course(flare, {ball, direction, 0, ball.radius});
    ASSERT_GE(in_box.lo, range.lo);
    ASSERT_LE(in_box.hi, range.hi);
    ASSERT_GE(line.log_slope.lo, course.log_slope.lo - 1e-9);
    ASSERT_LE(line.factor.hi, course.factor.hi + 1e-9);
    for (int k = 0; k < 30; ++k) {
      const Vec3 p = ball.center + ball.radius * std::cbrt(draws.in(0, 1)) * draws.direction();
      const FlareFactor m = flare_factor_gradient(flare, p);
      ASSERT_EQ(m.value, flare_factor(flare, p));
      ASSERT_TRUE(range.contains(m.value) && course.factor.contains(m.value));
      const double slope = glm::dot(m.log_gradient, direction), slack = 1e-9 * (1 + std::abs(slope));
      ASSERT_TRUE(course.log_slope.lo <= slope + slack && slope - slack <= course.log_slope.hi);
      const Vec3 q = draws.point({ball.center - half, ball.center + half});
      ASSERT_TRUE(in_box.contains(flare_factor(flare, q)));
      const FlareFactor there = flare_factor_gradient(flare, ball.center + draws.in(-1, 1) * ball.radius * direction);
      const double along = glm::dot(there.log_gradient, direction), hair = 1e-9 * (1 + std::abs(along));
      ASSERT_TRUE(line.factor.contains(there.value));
      ASSERT_TRUE(line.log_slope.lo <= along + hair && along - hair <= line.log_slope.hi);
    }
    const Ball tiny{around(0.5, 0.4, 0.3), 1e-6};
    const FlareCourse there = flare_course(flare, {tiny, direction});
    ASSERT_LT(there.factor.hi - there.factor.lo, 1e-4);
    ASSERT_LT(there.log_slope.hi - there.log_slope.lo, 0.1);
  }
}

// Cells of one size that bounds cannot tell to be empty, over those that hold surface: of a flare hardly more than of its chain.
TEST(Flare, CoverIsNearlyAsTightAsAChains) {
  const auto waste = [](const Field& field) {
    const SurfaceCover cover = *cover_surface(field, {.cell = 0.04}, {});
    std::size_t crossed = 0;
    for (std::size_t i = 0; i < cover.size(); ++i) {
      const Box cube = cover.cube(i);
      bool inside = false, outside = false;
      for (int k = 0; k < 125; ++k) {
        const Vec3 part(k % 5 / 4.0, k / 5 % 5 / 4.0, k / 25 / 4.0);
        (field.value(cube.lo + part * cube.size()) >= kIso ? inside : outside) = true;
      }
      crossed += inside && outside;
    }
    return static_cast<double>(cover.size()) / static_cast<double>(crossed);
  };
  Flare trunk = flared_trunk(4, 0.8);
  trunk.nodes.resize(4);
  const auto [flare, chain] = with_its_chain(trunk);
  EXPECT_LT(waste(flare), 1.3 * waste(chain));
}

// Floats, in cells as large as a mesher's.
TEST(Flare, BatchesInCellsAreNearPoints) {
  Draws draws(21);
  Evaluator evaluator;
  double worst = 0, worst_slope = 0;
  std::size_t telling = 0;
  for (int turn = 0; turn < 300; ++turn) {
    const Field field = field_of(flared_trunk(static_cast<std::size_t>(1 + turn % 7), draws.in(0, 0.95), kSections[turn / 7 % 3]));
    const Vec3 center = draws.point({Vec3(-0.6, -0.6, -0.3), Vec3(0.6, 0.6, 1.3)});
    const PrunedField cell = field.prune(Box{center, center}.padded(0.1));
    constexpr std::size_t n = 64;
    std::vector<float> x, y, z, f(n), gx(n), gy(n), gz(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 p = draws.point({Vec3(-0.1), Vec3(0.1)});
      x.push_back(static_cast<float>(p.x)), y.push_back(static_cast<float>(p.y)), z.push_back(static_cast<float>(p.z));
    }
    evaluator.samples(cell, x, y, z, f, gx, gy, gz);
    for (std::size_t i = 0; i < n; ++i) {
      const Sample exact = evaluator.sample(cell, cell.origin() + Vec3(x[i], y[i], z[i]));
      worst = std::max(worst, std::abs(f[i] - exact.value));
      const double error = glm::length(Vec3(gx[i], gy[i], gz[i]) - exact.gradient) / (1 + glm::length(exact.gradient));
      worst_slope = std::max(worst_slope, error);
      telling += exact.value > 0.1 && exact.value < 0.9;
    }
  }
  EXPECT_LT(worst, 2e-6) << worst;
  EXPECT_LT(worst_slope, 1e-3) << worst_slope;
  EXPECT_GT(telling, 5000u);
}

}  // namespace
}  // namespace cambium
