#include "skeletons/graph/lifespan.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(Lifespan, FallsByOneWhereNothingElseIsSaid) {
  StreamDraws draws(1);
  EXPECT_EQ(draw_decrement(Lifespan{}.outcomes, draws).left(3), 2);
  EXPECT_EQ(draw_decrement(Lifespan{}.outcomes, draws).left(0.5), 0);
}

TEST(Lifespan, ThirtyInAHundredEndAndTheOthersLoseAnEvenPart) {
  const auto outcomes = Lifespan::thirty_seventy();
  StreamDraws draws(2);
  constexpr int kDraws = 100'000;
  int ended = 0, below_half = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double left = draw_decrement(outcomes, draws).left(4);
    ASSERT_TRUE(0 <= left && left <= 4);
    ended += left == 0;
    below_half += 0 < left && left < 2;
  }
  EXPECT_NEAR(ended / double(kDraws), 0.3, 0.007);
  EXPECT_NEAR(below_half / double(kDraws), 0.35, 0.007);
}

TEST(Lifespan, TablesAreDrawnByTheirProbabilities) {
  const LifespanOutcome table[] = {{1, 1, 1, false}, {0, 5, 5, false}, {3, 2, 2, false}};
  StreamDraws draws(3);
  int ones = 0;
  for (int i = 0; i < 10'000; ++i) {
    const LifespanDecrement decrement = draw_decrement(table, draws);
    ASSERT_NE(decrement.amount, 5);
    ones += decrement.amount == 1;
  }
  EXPECT_NEAR(ones / 10'000.0, 0.25, 0.02);
}

TEST(Lifespan, RefusesWhatIsNoLife) {
  const auto refused = [](Lifespan lifespan) {
    EXPECT_THROW(validate_lifespan(lifespan), InputError);
  };
  validate_lifespan({});
  refused({.initial = -1});
  refused({.initial = std::nan("")});
  refused({.outcomes = {}});
  refused({.outcomes = {{0, 1, 1, false}}});
  refused({.outcomes = {{-1, 1, 1, false}, {2, 1, 1, false}}});
  refused({.outcomes = {{1, -1, 1, false}}});
  refused({.outcomes = {{1, 2, 1, false}}});
  refused({.outcomes = {{1, 1, kInfinity, false}}});
}

TEST(Lifespan, RanksTheDirectionThatLooksIntoTheLightFirst) {
  const Vec3 directions[] = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.8, 0.6, 0}};
  const std::vector<std::uint32_t> expected = {1, 4, 2, 3, 0};
  EXPECT_EQ(ranked_by_light(directions, {2, 0, 0}), expected);
}

}  // namespace
}  // namespace cambium
