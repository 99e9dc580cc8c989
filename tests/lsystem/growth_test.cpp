// Growth between derivation steps: continuous, exact for ages, and at whole steps what derive() gives.
#include "lsystem/growth.h"

#include <gtest/gtest.h>

#include <atomic>

#include "grammar.h"

namespace cambium {
namespace {

/// A growing model and the plants that it is at some times.
class Grown {
 public:
  Grown(const std::string& text, int steps, std::uint64_t seed = 0, TurtleOptions turtle = {})
      : system_(test::parsed(text)), options_{seed, steps, 1'000'000, turtle, {}}, growth_(system_, options_, run_) {}

  GrownString string(double time) { return growth_.at(time).value(); }
  Turtled plant(double time) { return interpret(string(time), system_, options_.turtle, run_).value(); }
  Turtled derived(int steps) {
    DeriveOptions options = options_;
    options.steps = steps;
    return interpret(derive(system_, options, {}).value(), system_, options.turtle, {}).value();
  }

 private:
  LSystem system_;
  DeriveOptions options_;
  RunOptions run_;
  Growth growth_;
};

/// How far the farthest node of either is from the nearest of the other.
double distance(const Skeleton& a, const Skeleton& b) {
  const auto one_way = [](const Skeleton& from, const Skeleton& to) {
    double farthest = 0;
    for (const SkeletonNode& node : from.nodes) {
      double nearest = kInfinity;
      for (const SkeletonNode& other : to.nodes) nearest = std::min(nearest, glm::distance(node.position, other.position));
      farthest = std::max(farthest, nearest);
    }
    return farthest;
  };
  return std::max(one_way(a, b), one_way(b, a));
}

const std::string kMonopodial = test::grammar(
    "A(1,10)",
    "A(l,w) --> !(w)F(l)[&(45)B(l*.6,w*.707)]/(137.5)A(l*.9,w*.707)\n"
    "B(l,w) --> !(w)F(l)[-(45)$C(l*.6,w*.707)]C(l*.9,w*.707)\nC(l,w) --> !(w)F(l)[+(45)$B(l*.6,w*.707)]B(l*.9,w*.707)");
const std::string kStochasticBush = test::grammar("F(1)", "F(l) --> F(l)[+(30)F(l)]F(l) : 1\nF(l) --> F(l)[-(30)F(l)] : 1\nF(l)-->F(l*1.5):1");
const std::string kTimed = test::grammar("A(0)",
                                         "A(t) : t<2 --> A(t+1)\nA(t) : t>=2 --> I(0)[+(50)A(0)]/(137.5)A(0)\nI(t) --> I(t+1)\n"
                                         "homomorphism\nI(t) --> !(.1+.05*t)F(1+.5*t)");
const std::string kInnerGrowth = test::grammar("F(1)", "F(l) --> F(l)+(20)F(l)-(20)F(l)");

TEST(Growth, AtWholeStepsIsWhatIsDerived) {
  for (const std::string& model : {kMonopodial, kStochasticBush, kTimed, kInnerGrowth}) {
    Grown grown(model, 6, 3);
    for (int step = 0; step <= 6; ++step) {
      const Turtled a = grown.plant(step), b = grown.derived(step);
      ASSERT_EQ(a.skeleton.nodes.size(), b.skeleton.nodes.size());
      EXPECT_EQ(a.total_length, b.total_length);
      for (std::size_t i = 0; i < a.skeleton.nodes.size(); ++i)
        EXPECT_EQ(a.skeleton.nodes[i].position, b.skeleton.nodes[i].position);
    }
  }
}

TEST(Growth, IsContinuousAtWholeSteps) {
  for (const std::string& model : {kMonopodial, kStochasticBush, kTimed, kInnerGrowth}) {
    Grown grown(model, 6, 3);
    for (int step = 3; step < 6; ++step) {
      const Skeleton before = grown.plant(step).skeleton, after = grown.plant(step + 1).skeleton;
      const double least_step = 1.01 * GrowthParts::kLeast;
      EXPECT_LT(distance(before, grown.plant(step + 1e-7).skeleton), 1e-4) << model << step;
      EXPECT_LT(distance(before, grown.plant(step + least_step).skeleton), 3 * least_step * grown.plant(step + 1).total_length)
          << model << step;
      EXPECT_LT(distance(grown.plant(step + 1 - 1e-7).skeleton, after), 1e-4) << model << step;
      EXPECT_GT(distance(before, after), 0.01) << model << step;
    }
  }
}

TEST(Growth, BothLengthAndWidthOfNewBranchesGrow) {
  for (const std::string& model : {kMonopodial, kTimed, kInnerGrowth}) {
    Grown grown(model, 5);
    double length = 0;
    for (double time = 1; time <= 5; time += 0.125) {
      const Turtled plant = grown.plant(time);
      EXPECT_GE(plant.total_length, length) << model << time;
      length = plant.total_length;
      for (const SkeletonNode& node : plant.skeleton.nodes) EXPECT_GT(node.radius, 0);
    }
  }
  Grown grown(kMonopodial, 1);
  const Turtled half = grown.plant(0.5);
  EXPECT_DOUBLE_EQ(half.total_length, 0.5);
  EXPECT_DOUBLE_EQ(half.skeleton.nodes.back().radius, 2.5);
}

TEST(Growth, AgesAreExactInBetween) {
  Grown grown(test::grammar("I(0)", "I(t) --> I(t+1)\nhomomorphism\nI(t) : t<=3 --> F(t^2)\nI(t) --> F(9)"), 4);
  EXPECT_DOUBLE_EQ(grown.plant(1.5).total_length, 2.25);
  EXPECT_DOUBLE_EQ(grown.plant(2.75).total_length, 2.75 * 2.75);
  EXPECT_DOUBLE_EQ(grown.plant(3.5).total_length, 9);
}

TEST(Growth, VariablesThatCountTimeAreInBetween) {
  Grown grown("lsystem: 1\nStart: { t = 0; }\nEndEach: { t = t + 1; }\naxiom: I\nhomomorphism\nI --> F(1+t)\nendlsystem\n", 3);
  EXPECT_DOUBLE_EQ(grown.plant(0).total_length, 1);
  EXPECT_DOUBLE_EQ(grown.plant(1.25).total_length, 2.25);
  EXPECT_DOUBLE_EQ(grown.plant(3).total_length, 4);
}

TEST(Growth, TheHeirOfAModuleIsTheOneOutsideOfBrackets) {
  Grown grown(test::grammar("A(8)", "A(x) --> [A(0)]A(4)"), 1);
  EXPECT_EQ(to_text(grown.string(0.5).string), "[A(0)]A(6)");
  Grown sideways(test::grammar("A(8)", "A(x) --> [A(0)][A(4)]B"), 1);
  EXPECT_EQ(to_text(sideways.string(0.25).string), "[A(6)][A(4)]B");
}

TEST(Growth, EveryModuleOfALongPredecessorHasItsHeir) {
  Grown grown(test::grammar("A(0)B(0)B(8)", "A(x)B(y) --> A(x+1)CB(y+2)"), 1);
  EXPECT_EQ(to_text(grown.string(0.5).string), "A(0.5)CB(1)B(8)");
}

TEST(Growth, ATurnUnderOldWoodComesWithTheStep) {
  Grown grown(test::grammar("AF(1)", "A --> +(40)A"), 1);
  const auto& nodes = grown.plant(0.5).skeleton.nodes;
  EXPECT_NEAR(nodes.back().position.x, -std::sin(20 * 3.14159265358979 / 180), 1e-12);
}

TEST(Growth, OldWoodIsNotThinnedByNewWoodBelow) {
  Grown grown(test::grammar("!(2)AF(1)", "A --> F(1)A"), 1);
  const auto nodes = grown.plant(0.25).skeleton.nodes;
  ASSERT_EQ(nodes.size(), 3u);
  EXPECT_DOUBLE_EQ(nodes[1].position.z, 0.25);
  EXPECT_DOUBLE_EQ(nodes[2].radius, 1);
}

TEST(Growth, OrgansGrowToo) {
  Grown grown(test::grammar("A", "A --> F(1)[@O(2)]A"), 1);
  const Turtled half = grown.plant(0.5), whole = grown.plant(1);
  ASSERT_EQ(half.foliage.organs.size(), 1u);
  EXPECT_DOUBLE_EQ(half.foliage.organs[0].scale * 2, whole.foliage.organs[0].scale);
}

TEST(Growth, QueriesAreAnsweredAtEveryStep) {
  const std::string model = test::grammar("A?P(0,0,0)", "A?P(x,y,z) --> F(1+z)A?P(0,0,0)");
  Grown grown(model, 3);
  EXPECT_EQ(to_text(grown.string(3).string), test::derived_text(model, 3));
  EXPECT_EQ(to_text(grown.string(2).string), "F(1)F(2)A?P(0,0,3)");
  EXPECT_DOUBLE_EQ(grown.plant(2.5).total_length, 1 + 2 + 0.5 * 4);
}

TEST(Growth, DrawsAreThoseOfTheDerivation) {
  Grown grown(kStochasticBush, 5, 7);
  EXPECT_EQ(to_text(grown.string(5).string), to_text(test::derived(test::parsed(kStochasticBush), 5, 7)));
  const std::string middle = to_text(grown.string(4.5).string);
  Grown again(kStochasticBush, 5, 7);
  EXPECT_EQ(to_text(again.string(4.5).string), middle);   // also where the steps before were skipped
}

TEST(Growth, TimeMayGoBack) {
  Grown grown(kMonopodial, 5);
  const std::string early = to_text(grown.string(1.5).string);
  grown.string(4.5);
  EXPECT_EQ(to_text(grown.string(1.5).string), early);
  EXPECT_EQ(to_text(grown.string(1).string), test::derived_text(kMonopodial, 1));
}

TEST(Growth, OfOtherDialectsIsInTheSymbolsOfCpfg) {
  const LSystem system = LSystem::parse("Axiom: A(0)\nderivation length: 2\nproduction:\nA(t) --> RollL(90)A(t+1)\ninterpretation:\nA(t) --> _(1)F(t)\n",
                                        "test.lpy", std::nullopt, Dialect::kLpy);
  const DeriveOptions options;
  const RunOptions run;
  Growth growth(system, options, run);
  EXPECT_EQ(to_text(growth.at(1.5)->string), "\\(90)\\(90)#(2)F(1.5)");
}

TEST(Growth, StopsWhenCancelled) {
  const LSystem system = test::parsed(kMonopodial);
  DeriveOptions options;
  options.steps = 6;
  const std::atomic<bool> cancel = true;
  RunOptions run;
  run.cancel = &cancel;
  Growth growth(system, options, run);
  EXPECT_FALSE(growth.at(2.5));
}

}  // namespace
}  // namespace cambium
