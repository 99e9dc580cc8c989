#include "raytrace/foliage_tracer.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "tests/raytrace/foliage_scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace cambium {
namespace {

double number(int i, int k) { return unit_of(hash_of(5, i, k)); }
Vec3 point(int i, int k) { return {number(i, k), number(i, k + 1), number(i, k + 2)}; }

Mat3 frame(int i, double scale) {
  const Vec3 a = glm::normalize(point(i, 10) - 0.5), b = glm::normalize(glm::cross(a, point(i, 13) - 0.5));
  return scale * Mat3(a, b, glm::cross(a, b));
}

/// Squares all over a cube of 8 m.
FoliageScene crowd(int count) {
  FoliageScene scene = scenes::level_leaf(1, 0, {});
  scene.instances.clear();
  for (int i = 0; i < count; ++i) scene.instances.push_back({0, 8.0 * point(i, 0), frame(i, 0.2 + 0.4 * number(i, 20)), i});
  return scene;
}

/// By the triangles' own planes, one after the other.
std::optional<FoliageHit> searched(const FoliageScene& scene, const Ray& ray) {
  std::optional<FoliageHit> best;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const FoliageInstance& leaf = scene.instances[i];
    const Vec3 origin = glm::inverse(leaf.axes) * (ray.origin - leaf.position), direction = glm::inverse(leaf.axes) * ray.direction;
    const double t = -origin.z / direction.z;
    const Vec3 p = origin + t * direction;
    if (!(t > 0) || std::abs(p.x) > 0.5 || std::abs(p.y) > 0.5 || (best && best->t < t)) continue;
    best = FoliageHit{t, i, p.x > p.y ? 0u : 1u, 0, 0};
  }
  return best;
}

TEST(FoliageTracer, MeetsWhatASearchOfAllLeavesMeets) {
  const FoliageTracer tracer(crowd(400));
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{16.0 * point(i, 40) - 4.0, glm::normalize(8.0 * point(i, 50) - (16.0 * point(i, 40) - 4.0))};
    const auto found = tracer.intersect(ray), expected = searched(tracer.scene(), ray);
    ASSERT_EQ(found.has_value(), expected.has_value()) << i;
    EXPECT_EQ(tracer.occluded(ray), expected.has_value());
    if (!found) continue;
    ++hits;
    EXPECT_NEAR(found->t, expected->t, 1e-9);
    EXPECT_EQ(found->instance, expected->instance);
    EXPECT_EQ(found->triangle, expected->triangle);
    EXPECT_FALSE(tracer.intersect(ray, found->t * (1 - 1e-6)));
    EXPECT_TRUE(tracer.intersect(ray, found->t * (1 + 1e-6)));
    EXPECT_FALSE(tracer.occluded(ray, found->t * (1 - 1e-5)));
  }
  EXPECT_GT(hits, 1000);
}

TEST(FoliageTracer, ARayThatLeavesALeafOnEitherSideDoesNotMeetItAgain) {
  const FoliageTracer tracer(crowd(400));
  int left = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{16.0 * point(i, 40) - 4.0, glm::normalize(8.0 * point(i, 50) - (16.0 * point(i, 40) - 4.0))};
    const auto hit = tracer.intersect(ray);
    if (!hit) continue;
    const FoliageLook look = tracer.look(ray, *hit, 0);
    for (const double side : {1.0, -1.0}) {
      const Vec3 out = glm::normalize(side * look.normal + 0.99 * glm::normalize(point(i, 60) - 0.5));
      const Ray onward{look.position + side * tracer.lift() * look.normal, out};
      const auto next = tracer.intersect(onward);
      EXPECT_TRUE(!next || next->instance != hit->instance) << i;
      ++left;
    }
  }
  EXPECT_GT(left, 1000);
}

TEST(FoliageTracer, OfLeavesInOnePlaceTheFirstIsMetWhateverOrderTheyAreMetIn) {
  FoliageScene scene = crowd(300);
  const auto once = scene.instances;
  for (int copy = 0; copy < 3; ++copy) scene.instances.insert(scene.instances.end(), once.begin(), once.end());
  const FoliageTracer single(crowd(300)), fourfold(scene);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{16.0 * point(i, 40) - 4.0, glm::normalize(8.0 * point(i, 50) - (16.0 * point(i, 40) - 4.0))};
    const auto one = single.intersect(ray), many = fourfold.intersect(ray);
    ASSERT_EQ(one.has_value(), many.has_value());
    if (!one) continue;
    EXPECT_EQ(many->instance, one->instance);
    ++hits;
  }
  EXPECT_GT(hits, 500);
}

TEST(FoliageTracer, RaysPassThroughWhatIsCutOut) {
  FoliageMaterial material;
  material.texture = scenes::holed();
  const FoliageTracer tracer(scenes::level_leaf(4, 1, material));
  const auto down = [](double x, double y) { return Ray{{x, y, 9}, {0, 0, -1}}; };
  EXPECT_FALSE(tracer.intersect(down(0.1, 0.2)));
  EXPECT_FALSE(tracer.occluded(down(0.1, 0.2)));
  ASSERT_TRUE(tracer.intersect(down(1.6, 0.2)));
  EXPECT_TRUE(tracer.occluded(down(1.6, 0.2)));
  EXPECT_DOUBLE_EQ(tracer.intersect(down(1.6, 0.2))->t, 8);
}

TEST(FoliageTracer, BehindAHoleTheNextLeafIsMet) {
  FoliageMaterial material;
  material.texture = scenes::holed();
  FoliageScene scene = scenes::level_leaf(4, 1, material);
  scene.materials.push_back({});
  scene.shapes.push_back({scenes::square(), 1});
  scene.instances.push_back({1, {0, 0, 0.5}, Mat3(1.0), 8});
  const FoliageTracer tracer(std::move(scene));
  const auto hit = tracer.intersect({{0.1, 0.2, 9}, {0, 0, -1}});
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->t, 8.5);
  EXPECT_EQ(hit->instance, 1u);
}

TEST(FoliageTracer, LooksAreThoseOfTheSideThatIsSeen) {
  FoliageMaterial material;
  material.color = {0.2, 0.5, 0.1};
  const FoliageTracer tracer(scenes::level_leaf(2, 1, material));
  const Ray down{{0.5, 0.25, 3}, {0, 0, -1}}, up{{0.5, 0.25, -3}, {0, 0, 1}};
  const FoliageLook above = tracer.look(down, *tracer.intersect(down), 0), below = tracer.look(up, *tracer.intersect(up), 0);
  EXPECT_EQ(above.normal, Vec3(0, 0, 1));
  EXPECT_EQ(below.normal, Vec3(0, 0, -1));
  EXPECT_EQ(below.shading_normal, Vec3(0, 0, -1));
  for (const FoliageLook* look : {&above, &below}) {
    EXPECT_LT(glm::distance(look->position, Vec3(0.5, 0.25, 1)), 1e-12);
    EXPECT_NEAR(look->uv.x, 0.75, 1e-6);
    EXPECT_NEAR(look->uv.y, 0.625, 1e-6);
    EXPECT_EQ(look->branch, 3);
    EXPECT_EQ(look->color, material.color);
  }
}

TEST(FoliageTracer, BoxesHoldTheirLeavesTightly) {
  const FoliageTracer tracer(crowd(50));
  const auto boxes = tracer.boxes();
  ASSERT_EQ(boxes.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    const FoliageInstance& leaf = tracer.scene().instances[i];
    Box corners;
    for (const glm::vec3& p : scenes::square().positions) corners.extend(leaf.position + leaf.axes * Vec3(p));
    EXPECT_LT(glm::distance(boxes[i].lo, corners.lo), 1e-12);
    EXPECT_LT(glm::distance(boxes[i].hi, corners.hi), 1e-12);
  }
}

TEST(FoliageTracer, RefusesWhatIsNotThereOrOutOfRange) {
  const auto refused = [](void (*spoil)(FoliageScene&)) {
    FoliageScene scene = scenes::level_leaf(1, 1, {});
    spoil(scene);
    EXPECT_THROW(FoliageTracer{std::move(scene)}, InputError);
  };
  refused([](FoliageScene& s) { s.instances[0].shape = 1; });
  refused([](FoliageScene& s) { s.shapes[0].material = 1; });
  refused([](FoliageScene& s) { s.shapes[0].sheet.triangles[0][1] = 4; });
  refused([](FoliageScene& s) { s.shapes[0].sheet.normals.pop_back(); });
  refused([](FoliageScene& s) { s.shapes[0].sheet.uvs.clear(); });
  refused([](FoliageScene& s) { s.materials[0].translucency = 1.1; });
  refused([](FoliageScene& s) { s.materials[0].roughness = std::nan(""); });
  refused([](FoliageScene& s) { s.materials[0].color.y = -0.1; });
}

TEST(FoliageTracer, CancelledItMeetsNothing) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(FoliageTracer(crowd(50), run).occluded({{4, 4, -9}, {0, 0, 1}}));
}

TEST(FoliageTracer, NothingIsMetWhereThereIsNothing) {
  const FoliageTracer none{FoliageScene{}};
  EXPECT_FALSE(none.intersect({{0, 0, 0}, {0, 0, 1}}));
  EXPECT_FALSE(none.occluded({{0, 0, 0}, {0, 0, 1}}));
  FoliageScene hollow;
  hollow.materials.resize(1);
  hollow.shapes = {{Sheet{}, 0}};
  hollow.instances = {{0, {0, 0, 1}, Mat3(1.0), 0}};
  EXPECT_FALSE(FoliageTracer(hollow).occluded({{0, 0, 0}, {0, 0, 1}}));
}

}  // namespace
}  // namespace cambium
