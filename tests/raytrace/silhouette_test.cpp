#include "raytrace/silhouette.h"

#include "raytrace/framing.h"
#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

View view_of(const Vec3& eye, const Vec3& target) {
  Camera camera;
  camera.eye = eye;
  camera.target = target;
  return frame(camera, {}, 60, 40);
}

/// Whether the ray meets the box (slabs).
bool meets(const Ray& ray, const Box& box) {
  double begin = 0, end = kInfinity;
  for (int c = 0; c < 3; ++c) {
    const double a = (box.lo[c] - ray.origin[c]) / ray.direction[c], b = (box.hi[c] - ray.origin[c]) / ray.direction[c];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

TEST(Silhouette, HoldsEveryPixelFromWhichABoxCanBeMet) {
  const View view = view_of({0.1, -5, 1}, {0, 0, 0.5});
  const PixelRect whole{0, 0, 60, 40};
  const std::vector<Box> boxes{{{-0.6, -0.2, 0.3}, {-0.3, 0.1, 0.5}}, {{0.4, 0.1, 0.9}, {0.41, 0.11, 1.4}}};
  const PixelMask mask = silhouette(boxes, view, whole, 1.5);
  int inside = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      inside += mask.test(x, y);
      for (double dy : {-1.5, 0.0, 1.5}) {
        for (double dx : {-1.5, -0.7, 0.0, 0.7, 1.5}) {
          const Ray ray = view.ray(x + 0.5 + dx, y + 0.5 + dy);
          for (const Box& box : boxes) {
            ASSERT_TRUE(!meets(ray, box) || mask.test(x, y)) << x << ' ' << y;
          }
        }
      }
    }
  }
  EXPECT_GT(inside, 20);
  EXPECT_LT(inside, 60 * 40 / 4);  // and not the sky
}

TEST(Silhouette, HoldsWhatTheWholeLensSees) {
  View view = view_of({0.1, -5, 1}, {0, 0, 0.5});
  view.lens_radius = 0.2;
  view.focus_distance = 2;
  const PixelRect whole{0, 0, 60, 40};
  const std::vector<Box> boxes{{{0.4, 0.1, 0.9}, {0.5, 0.2, 1.0}}};
  const PixelMask mask = silhouette(boxes, view, whole, 0);
  int blurred = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) {
      for (int i = 0; i < 400; ++i) {
        const Ray ray = view.ray(x + 0.5, y + 0.5, {(i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20});
        if (!meets(ray, boxes[0])) continue;
        ++blurred;
        ASSERT_TRUE(mask.test(x, y)) << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(blurred, 300);
}

TEST(Silhouette, OfABoxAroundTheEyeIsEverything) {
  const PixelRect whole{0, 0, 60, 40};
  const std::vector<Box> boxes{{{-1, -6, 0}, {1, -4, 2}}};
  const PixelMask mask = silhouette(boxes, view_of({0.1, -5, 1}, {0, 0, 0.5}), whole, 0);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) ASSERT_TRUE(mask.test(x, y));
  }
}

TEST(Silhouette, OfAPartIsThatPartOfTheWhole) {
  const View view = view_of({0.1, -5, 1}, {0, 0, 0.5});
  const std::vector<Box> boxes{{{-0.6, -0.2, 0.3}, {-0.3, 0.1, 0.5}}};
  const PixelMask whole = silhouette(boxes, view, {0, 0, 60, 40}, 1.5);
  const PixelRect part{20, 12, 44, 31};
  const PixelMask mask = silhouette(boxes, view, part, 1.5);
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) EXPECT_EQ(mask.test(x, y), whole.test(x, y));
  }
}

}  // namespace
}  // namespace cambium
