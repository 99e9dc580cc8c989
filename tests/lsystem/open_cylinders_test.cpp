#include "lsystem/open_cylinders.h"

#include <gtest/gtest.h>

#include "grammar.h"

namespace cambium {
namespace {

TEST(OpenCylinders, BracketsAreInTheOneAroundThemUntilTheyHaveTheirOwn) {
  OpenCylinders cylinders;
  const auto trunk = cylinders.open({GeneralizedCylinder(), {}, 1, false}, OpenCylinders::kNone);
  EXPECT_FALSE(cylinders.hold(OpenCylinders::kNone, 1));
  EXPECT_TRUE(cylinders.hold(trunk, 1));
  EXPECT_FALSE(cylinders.hold(trunk, 2));
  EXPECT_EQ(cylinders.branch(trunk, 1), trunk);
  const auto limb = cylinders.branch(trunk, 2);
  EXPECT_NE(limb, trunk);
  EXPECT_TRUE(cylinders.hold(limb, 2));
  EXPECT_TRUE(cylinders[limb].pen.lateral);
  EXPECT_FALSE(cylinders[trunk].pen.lateral);
  cylinders.shrink(1);
  EXPECT_TRUE(cylinders.hold(trunk, 1));
}

TEST(OpenCylinders, StepsAreControlPointsInBracketsToo) {
  OpenCylinders cylinders;
  const auto spline = cylinders.open({GeneralizedCylinder(), {}, 0, true}, OpenCylinders::kNone);
  EXPECT_TRUE(cylinders.hold(spline, 7));
}

TEST(OpenCylinders, OneThatIsNotClosedIsReplaced) {
  OpenCylinders cylinders;
  auto number = OpenCylinders::kNone;
  for (int i = 0; i < 1000; ++i) number = cylinders.open({GeneralizedCylinder(), {}, 3, false}, number);
  EXPECT_EQ(cylinders.size(), 1u);
  cylinders.close(number);
  EXPECT_EQ(cylinders.size(), 0u);
  EXPECT_EQ(test::turtled("@Gsf@Gsf@Gef@GsF@Ge").skeleton.nodes.size(), 4u);
}

}  // namespace
}  // namespace cambium
