#include "blobtree/float_box.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

const Box kBox{Vec3(0.1, -0.3, 1e-9), Vec3(0.7, 0.3, 1.1)};   // none of it a float

TEST(FloatBox, HoldsTheBoxItWasMadeOfAndHardlyMore) {
  const Box box = FloatBox(kBox).box();
  for (int a = 0; a < 3; ++a) {
    EXPECT_LT(box.lo[a], kBox.lo[a]);
    EXPECT_GT(box.hi[a], kBox.hi[a]);
    EXPECT_NEAR(box.lo[a], kBox.lo[a], 1e-7);
    EXPECT_NEAR(box.hi[a], kBox.hi[a], 1.2e-7);
  }
}

TEST(FloatBox, OneOfFloatsIsThatBox) {
  const Box box = FloatBox(Box{Vec3(0.5, -2, 0), Vec3(0.75, -1, 0)}).box();
  EXPECT_EQ(box.lo, Vec3(0.5, -2, 0));
  EXPECT_EQ(box.hi, Vec3(0.75, -1, 0));
}

TEST(FloatBox, IntersectsWhatItTouchesAndContainsWhatIsInIt) {
  const FloatBox box(Box{Vec3(0), Vec3(1)});
  for (int a = 0; a < 3; ++a) {
    Vec3 along(0.0);
    along[a] = 1;
    EXPECT_TRUE(box.intersects(FloatBox(Box{along, Vec3(1) + along})));
    EXPECT_FALSE(box.intersects(FloatBox(Box{1.001 * along, Vec3(1) + along})));
    EXPECT_FALSE(FloatBox(Box{1.001 * along, Vec3(1) + along}).intersects(box));
    EXPECT_FALSE(box.contains(FloatBox(Box{Vec3(0), Vec3(1) + 0.001 * along})));
    EXPECT_FALSE(box.contains(FloatBox(Box{-0.001 * along, Vec3(1)})));
  }
  EXPECT_TRUE(box.contains(box));
  EXPECT_TRUE(box.contains(FloatBox()));   // nothing
  EXPECT_FALSE(box.intersects(FloatBox()));
  EXPECT_TRUE(FloatBox().empty());
}

TEST(FloatBox, GrowsToHoldAnother) {
  FloatBox box;
  box.extend(FloatBox(Box{Vec3(0), Vec3(1)}));
  box.extend(FloatBox(Box{Vec3(2, -1, 0.5), Vec3(3, 0, 0.5)}));
  EXPECT_EQ(box.box().lo, Vec3(0, -1, 0));
  EXPECT_EQ(box.box().hi, Vec3(3, 1, 1));
}

TEST(FloatBox, DistanceIsToItsNearestPoint) {
  const FloatBox box(Box{Vec3(0), Vec3(1)});
  EXPECT_EQ(box.distance2(Vec3(0.2, 1, 0.5)), 0);
  EXPECT_EQ(box.distance2(Vec3(-2, 0.5, 0.5)), 4);
  EXPECT_EQ(box.distance2(Vec3(0.5, 4, 0.5)), 9);
  EXPECT_EQ(box.distance2(Vec3(3, -2, 2)), 9);
  EXPECT_EQ(FloatBox().distance2(Vec3(3, -2, 2)), kInfinity);
}

}  // namespace
}  // namespace cambium
