// What junctions look like: numbers measured on the field of the chain profile.
#include "blobtree/field.h"
#include "skeletons/surface.h"

#include "small_trees.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(JunctionField, AnUnbranchedChainHasItsExactRadius) {
  Skeleton s;
  for (int i = 0; i < 60; ++i) s.nodes.push_back(node_at({0.2 * i, 0.1 * i, 1.0 * i}, 0.3, i - 1));
  const Field field(surface(s, {}).tree);
  const Vec3 along = glm::normalize(Vec3(0.2, 0.1, 1)), side = glm::normalize(glm::cross(along, Vec3(1, 0, 0)));
  for (double t = 1; t < 59; t += 0.37) {
    const Vec3 p = Vec3(0.2, 0.1, 1.0) * t;
    EXPECT_GE(field.value(p + (0.3 - 1e-9) * side), kIso);
    EXPECT_LT(field.value(p + (0.3 + 1e-9) * side), kIso);
  }
}

}  // namespace
}  // namespace cambium
