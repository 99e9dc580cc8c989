#include "lsystem/counter_random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace cambium {
namespace {

struct Moments {
  double mean = 0, variance = 0;
};

Moments moments(const std::function<double(CounterRandom&)>& draw) {
  CounterRandom random(12345);
  const int count = 40000;
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    random.move_to(2, static_cast<std::uint64_t>(i));
    const double value = draw(random);
    sum += value;
    squares += value * value;
  }
  return {sum / count, squares / count - sum * sum / count / count};
}

TEST(CounterRandom, DrawsHaveTheirMoments) {
  const Moments uniform = moments([](CounterRandom& r) { return r.uniform(); });
  EXPECT_NEAR(uniform.mean, 0.5, 0.01);
  EXPECT_NEAR(uniform.variance, 1.0 / 12, 0.003);
  const Moments normal = moments([](CounterRandom& r) { return r.normal(); });
  EXPECT_NEAR(normal.mean, 0, 0.02);
  EXPECT_NEAR(normal.variance, 1, 0.03);
  const Moments beta = moments([](CounterRandom& r) { return r.beta(2, 3); });
  EXPECT_NEAR(beta.mean, 0.4, 0.01);
  EXPECT_NEAR(beta.variance, 0.04, 0.003);
  const Moments trials = moments([](CounterRandom& r) { return r.binomial(10, 0.3); });
  EXPECT_NEAR(trials.mean, 3, 0.03);
  EXPECT_NEAR(trials.variance, 2.1, 0.06);
  const Moments small = moments([](CounterRandom& r) { return r.beta(0.5, 0.5); });
  EXPECT_NEAR(small.mean, 0.5, 0.01);
  EXPECT_NEAR(small.variance, 0.125, 0.004);
}

TEST(CounterRandom, APlaceAlwaysGivesTheSameDraws) {
  CounterRandom random(1), other(1), third(2);
  random.move_to(1, 23);
  const double first = random.uniform(), second = random.uniform();
  other.move_to(9, 99);
  other.uniform();
  other.move_to(1, 23);
  EXPECT_EQ(other.choice(), random.choice());
  EXPECT_EQ(other.uniform(), first);
  EXPECT_EQ(other.uniform(), second);
  third.move_to(1, 23);
  EXPECT_NE(third.uniform(), first);
  EXPECT_NE(first, second);
}

TEST(CounterRandom, DrawsOfOneRuleDoNotDependOnAnotherRulesNumberOfThem) {
  CounterRandom random(1), other(1);
  random.move_to(1, 5);
  other.move_to(1, 5);
  random.move_to_rule(1);
  for (int i = 0; i < 3; ++i) random.uniform();
  random.move_to_rule(2);
  other.move_to_rule(1);
  other.move_to_rule(2);
  EXPECT_EQ(random.uniform(), other.uniform());
  random.uniform();
  random.move_to_successor(2);
  other.move_to_successor(2);
  const double drawn = random.uniform();
  EXPECT_EQ(other.uniform(), drawn);
  other.move_to_rule(2);
  EXPECT_NE(other.uniform(), drawn);
}

}  // namespace
}  // namespace cambium
