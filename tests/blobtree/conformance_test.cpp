// One suite over every primitive, operator and warp, by itself and nested at random: what the kernel promises of any field.
#include "blobtree/field.h"
#include "conformance_cases.h"
#include "reference_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace cambium {
namespace {

Box sampled_box(const Field& field) {
  const Box b = field.bounds();
  return b.empty() ? Box{Vec3(-1), Vec3(1)} : b.padded(0.05 * glm::length(b.size()));
}

// Rather where the field is not 0, which in a large box is most often not.
Vec3 telling_point(const Field& field, const Box& box, Draws& draws) {
  Vec3 p = draws.point(box);
  for (int tries = 0; tries < 8 && field.value(p) == 0; ++tries) p = draws.point(box);
  return p;
}

// Runs check(case, field, draws) over all cases, naming the case in every failure.
template <class Check>
void for_each_case(Check&& check) {
  std::uint64_t seed = 1;
  for (const ConformanceCase& c : conformance_cases()) {
    SCOPED_TRACE(c.name);
    Draws draws(seed++);
    check(c, Field(c.tree), draws);
    if (testing::Test::HasFailure()) break;  // the first case says enough
  }
}

TEST(Conformance, EveryNodeIsAmongTheCases) {
  std::set<std::size_t> seen;
  for (const ConformanceCase& c : conformance_cases())
    for (NodeId id = 0; id < c.tree.size(); ++id) seen.insert(c.tree.node(id).index());
  EXPECT_EQ(seen.size(), std::variant_size_v<Node>);
}

TEST(Conformance, ValueIsTheSpecifications) {
  std::size_t nonzero = 0, total = 0;
  for_each_case([&](const ConformanceCase& c, const Field& field, Draws& draws) {
    const Box box = sampled_box(field);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = i % 2 == 0 ? draws.point(box) : telling_point(field, box, draws);
      const double expected = reference::value(c.tree, p);
      ASSERT_NEAR(field.value(p), expected, 1e-9) << "at " << p.x << " " << p.y << " " << p.z;
      nonzero += expected != 0;
      ++total;
    }
  });
  EXPECT_GT(nonzero, total / 5);  // or the agreement says little
}

// Central differences at two steps tell creases (they disagree there) from smooth places (where they must agree with the gradient).
TEST(Conformance, GradientIsThatOfTheValue) {
  std::size_t checked = 0, total = 0;
  for_each_case([&](const ConformanceCase&, const Field& field, Draws& draws) {
    const Box box = sampled_box(field);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = telling_point(field, box, draws);
      const Sample sample = field.sample(p);
      ASSERT_EQ(sample.value, field.value(p));
      const double value = sample.value;
      constexpr double h = 1e-5;
      Vec3 near(0.0), difference(0.0);
      bool smooth = true;
      for (int k = 0; k < 3 && smooth; ++k) {
        Vec3 step(0.0);
        step[k] = h;
        const double up = field.value(p + step), down = field.value(p - step);
        const double up2 = field.value(p + 2.0 * step), down2 = field.value(p - 2.0 * step);
        near[k] = (up - down) / (2 * h);
        const double far = (up2 - down2) / (4 * h);
        difference[k] = (4 * near[k] - far) / 3;  // without the h^2 term
        const double bend = std::abs(up - 2 * value + down) / h;
        smooth = std::abs(near[k] - far) < 1e-5 * (1 + std::abs(near[k])) && bend < 0.02 * (1 + std::abs(near[k]));
      }
      ++total;
      if (!smooth) continue;
      ++checked;
      const double scale = 1 + glm::length(difference);
      ASSERT_LT(glm::length(sample.gradient - difference), 1e-6 * scale) << "at " << p.x << " " << p.y << " " << p.z;
    }
  });
  EXPECT_GT(checked, total * 9 / 10);
}

TEST(Conformance, IntervalsContainEverySample) {
  Evaluator evaluator;
  for_each_case([&](const ConformanceCase&, const Field& field, Draws& draws) {
    const Box whole = sampled_box(field);
    for (int i = 0; i < 25; ++i) {
      const Box box = draws.box(whole);
      const Interval coarse = field.interval(box);
      const PrunedField pruned = field.prune(box);
      const Interval fine = evaluator.interval(pruned, box);
      const Ball ball{draws.point(box), 0.3 * glm::length(box.size())};
      const Interval in_ball = evaluator.interval(pruned, ball);
      ASSERT_TRUE(std::isfinite(coarse.lo) && std::isfinite(coarse.hi));
      for (int k = 0; k < 20; ++k) {
        const Vec3 p = telling_point(field, box, draws);
        const double f = field.value(p);
        ASSERT_TRUE(coarse.contains(f)) << f << " not in " << coarse.lo << " " << coarse.hi;
        ASSERT_TRUE(fine.contains(f)) << f << " not in " << fine.lo << " " << fine.hi;
        const Vec3 q = ball.center + ball.radius * std::cbrt(draws.in(0, 1)) * draws.direction();
        ASSERT_TRUE(!box.contains(q) || in_ball.contains(field.value(q)));
      }
    }
  });
}

TEST(Conformance, CoursesHoldTheirWays) {
  Evaluator evaluator;
  for_each_case([&](const ConformanceCase&, const Field& field, Draws& draws) {
    const Box whole = sampled_box(field);
    for (int i = 0; i < 60; ++i) {
      const PrunedField pruned = field.prune(draws.box(whole));
      const Vec3 from = draws.point(pruned.box()), to = draws.point(pruned.box());
      const double half = 0.5 * glm::distance(from, to);
      const Course course = evaluator.course(pruned, 0.5 * (from + to), glm::normalize(to - from), half);
      for (int k = 0; k < 24; ++k) {
        const double a = draws.in(0, 1), b = draws.in(a, 1);
        const double f_a = field.value(glm::mix(from, to, a)), f_b = field.value(glm::mix(from, to, b)), way = 2 * half * (b - a);
        ASSERT_TRUE(course.value.contains(f_a)) << f_a << " not in " << course.value.lo << " " << course.value.hi;
        ASSERT_GE(f_b - f_a, course.slope.lo * way - 1e-12);
        ASSERT_LE(f_b - f_a, course.slope.hi * way + 1e-12);
      }
    }
  });
}

// A wide interval is legal, but one that never narrows would make every search a dense one.
TEST(Conformance, IntervalsOfSmallBoxesAreNarrow) {
  Evaluator evaluator;
  std::size_t narrow = 0, total = 0;
  for_each_case([&](const ConformanceCase&, const Field& field, Draws& draws) {
    const Box whole = sampled_box(field);
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = telling_point(field, whole, draws);
      const Box box{p - 5e-4, p + 5e-4};
      const Interval range = evaluator.interval(field.prune(box), box);
      narrow += range.hi - range.lo < 0.25;
      ++total;
    }
  });
  EXPECT_GT(narrow, total * 9 / 10);
}

TEST(Conformance, FieldIsZeroOutsideItsBounds) {
  for_each_case([&](const ConformanceCase& c, const Field& field, Draws& draws) {
    const Box bounds = field.bounds();
    ASSERT_TRUE(bounds.empty() || bounds.bounded());
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = draws.point({Vec3(-4), Vec3(4)});
      if (bounds.contains(p)) continue;
      ASSERT_EQ(reference::value(c.tree, p), 0.0);
      ASSERT_EQ(field.value(p), 0.0);
    }
  });
}

TEST(Conformance, PrunedIsExactlyTheWhole) {
  Evaluator evaluator;
  for_each_case([&](const ConformanceCase&, const Field& field, Draws& draws) {
    const PrunedField whole = field.whole();
    const Box around = sampled_box(field);
    for (int i = 0; i < 20; ++i) {
      const Box box = draws.box(around);
      const PrunedField pruned = field.prune(box);
      const Box inner{box.center() - 0.2 * box.size(), box.center() + 0.3 * box.size()};
      const PrunedField narrowed = field.prune(field.narrow(field.active(box), inner), inner);
      ASSERT_LE(narrowed.atom_count(), pruned.atom_count());
      for (int k = 0; k < 20; ++k) {
        const Vec3 p = telling_point(field, box, draws);
        const Sample exact = evaluator.sample(whole, p);
        ASSERT_EQ(evaluator.value(whole, p), exact.value);
        ASSERT_EQ(evaluator.value(pruned, p), exact.value);
        ASSERT_EQ(field.value(p), exact.value);
        ASSERT_TRUE(!pruned.empty() || exact.value == 0.0);
        const Sample sample = evaluator.sample(pruned, p);
        ASSERT_EQ(sample.value, exact.value);
        ASSERT_LT(glm::length(sample.gradient - exact.gradient), 1e-12 * (1 + glm::length(exact.gradient)));
        ASSERT_TRUE(!inner.contains(p) || evaluator.value(narrowed, p) == exact.value);
      }
    }
  });
}

// Float batches against double points. Near a crease a batch may take the other side's gradient.
TEST(Conformance, BatchesAgreeWithPoints) {
  Evaluator evaluator;
  std::size_t close = 0, total = 0;
  for_each_case([&](const ConformanceCase&, const Field& field, Draws& draws) {
    const Box around = sampled_box(field);
    for (int i = 0; i < 20; ++i) {
      const PrunedField pruned = field.prune(i == 0 ? around : draws.box(around));
      const std::size_t n = static_cast<std::size_t>(1 + draws.below(70));  // not a multiple of any vector width
      std::vector<float> x(n), y(n), z(n), f(n), f2(n), gx(n), gy(n), gz(n);
      for (std::size_t k = 0; k < n; ++k) {
        const Vec3 p = telling_point(field, pruned.box(), draws) - pruned.origin();
        x[k] = static_cast<float>(p.x), y[k] = static_cast<float>(p.y), z[k] = static_cast<float>(p.z);
      }
      evaluator.values(pruned, x, y, z, f);
      evaluator.samples(pruned, x, y, z, f2, gx, gy, gz);
      for (std::size_t k = 0; k < n; ++k) {
        const Vec3 p = pruned.origin() + Vec3(x[k], y[k], z[k]);
        if (!pruned.box().contains(p)) continue;
        const Sample exact = field.sample(p);
        ASSERT_NEAR(f[k], exact.value, 1e-4);
        ASSERT_NEAR(f2[k], exact.value, 1e-4);
        const double error = glm::length(Vec3(gx[k], gy[k], gz[k]) - exact.gradient);
        close += error < 1e-4 * (10 + glm::length(exact.gradient));
        ++total;
      }
    }
  });
  EXPECT_GT(static_cast<double>(close), 0.995 * static_cast<double>(total));
}

}  // namespace
}  // namespace cambium
