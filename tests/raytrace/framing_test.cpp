#include "raytrace/framing.h"

#include "tests/raytrace/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// Largest |x| and |y| of the boxes' corners on the film, 1 at its border.
std::pair<double, double> extent(const View& view, const std::vector<Box>& boxes) {
  double x = 0, y = 0;
  for (const Box& box : boxes) {
    for (int k = 0; k < 8; ++k) {
      const Vec3 p{k & 1 ? box.hi.x : box.lo.x, k & 2 ? box.hi.y : box.lo.y, k & 4 ? box.hi.z : box.lo.z};
      const Vec3 q = p - view.eye;
      const double z = glm::dot(q, view.forward);
      EXPECT_GT(z, 0);
      x = std::max(x, std::abs(glm::dot(q, view.right)) / z / view.tan_x);
      y = std::max(y, std::abs(glm::dot(q, view.up)) / z / view.tan_y);
    }
  }
  return {x, y};
}

TEST(Frame, TheTreeFillsThePictureUpToTheMargin) {
  const std::vector<Box> boxes{{{-1, -1, 0}, {1, 1, 0.5}}, {{0.2, 0.1, 0}, {0.5, 0.4, 12}}, {{-3, 0, 8}, {-2.5, 1, 9}}};
  for (double azimuth : {0.0, 0.6, 2.0, -2.5}) {
    for (double elevation : {-0.4, 0.05, 0.9, 1.57079632679}) {
      Camera camera;
      camera.azimuth = azimuth;
      camera.elevation = elevation;
      const auto [x, y] = extent(frame(camera, boxes, 600, 800), boxes);
      EXPECT_NEAR(std::max(x, y), 1 / camera.margin, 1e-6);
    }
  }
}

TEST(Frame, ATurntableKeepsItsDistanceAndLosesNothing) {
  const std::vector<Box> boxes{{{-1, -1, 0}, {1, 1, 0.5}}, {{0.2, 0.1, 0}, {0.5, 0.4, 12}}, {{-3, 0, 8}, {-2.5, 1, 9}}};
  Box whole;
  for (const Box& box : boxes) whole.extend(box);
  const Vec3 center = whole.center();
  double distance = 0, fullest = 0;
  for (int k = 0; k < 24; ++k) {
    Camera camera;
    camera.turntable = {k, 24};
    const View view = frame(camera, boxes, 600, 800);
    const auto [x, y] = extent(view, boxes);
    fullest = std::max({fullest, x, y});
    const double here = std::hypot(view.eye.x - center.x, view.eye.y - center.y);
    if (k == 0) distance = here;
    EXPECT_NEAR(here, distance, 1e-9);
    EXPECT_NEAR(std::remainder(std::atan2(view.eye.y - center.y, view.eye.x - center.x) - camera.azimuth - 2 * std::acos(-1.0) * k / 24,
                               2 * std::acos(-1.0)), 0, 5e-3);   // circles are many-sided
  }
  EXPECT_LE(fullest, 1 / Camera{}.margin + 1e-9);
  EXPECT_GT(fullest, 0.8);   // and stands no farther back than that takes
}

TEST(Frame, ATurntableTurnsAGivenEyeAboutItsTarget) {
  Camera camera;
  camera.eye = Vec3(5, 0, 1);
  camera.target = Vec3(1, 0, 1);
  camera.turntable = {1, 4};
  const View view = frame(camera, {}, 100, 100);
  EXPECT_LT(glm::distance(view.eye, Vec3(1, 4, 1)), 1e-12);
  EXPECT_LT(glm::distance(view.forward, Vec3(0, -1, 0)), 1e-12);
}

TEST(Frame, FocusesOnTheMiddleOfWhatItFramesUnlessTold) {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 5}}};
  Camera camera;
  const View view = frame(camera, boxes, 300, 400);
  EXPECT_NEAR(view.focus_distance, glm::dot(Vec3(0.5, 0.5, 2.5) - view.eye, view.forward), 1e-12);
  camera.focus_distance = 0.25;
  EXPECT_EQ(frame(camera, boxes, 300, 400).focus_distance, 0.25);
}

TEST(Frame, AGivenEyeAndTargetAreTaken) {
  Camera camera;
  camera.eye = Vec3(1, 2, 3);
  camera.target = Vec3(1, 5, 3);
  const View view = frame(camera, {}, 100, 100);
  EXPECT_EQ(view.eye, Vec3(1, 2, 3));
  EXPECT_NEAR(view.ray(50, 50).direction.y, 1, 1e-12);
  EXPECT_GT(view.ray(50, 0).direction.z, 0);   // up is up
  EXPECT_GT(view.ray(100, 50).direction.x, 0); // right is right
}

TEST(Frame, AGivenTargetStaysInTheMiddle) {
  const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 5}}};
  Camera camera;
  camera.target = Vec3(0.5, 0.5, 1);
  const View view = frame(camera, boxes, 300, 400);
  EXPECT_NEAR(glm::length(glm::cross(glm::normalize(*camera.target - view.eye), view.forward)), 0, 1e-12);
  const auto [x, y] = extent(view, boxes);
  EXPECT_NEAR(std::max(x, y), 1 / camera.margin, 1e-6);
}

TEST(Frame, ABoxToFrameReplacesTheTree) {
  Camera camera;
  camera.frame = Box{{4, 4, 4}, {5, 5, 5}};
  const auto [x, y] = extent(frame(camera, std::vector<Box>{{{0, 0, 0}, {1, 1, 50}}}, 300, 400), {*camera.frame});
  EXPECT_NEAR(std::max(x, y), 1 / camera.margin, 1e-6);
}

TEST(Frame, OfNothingIsStillAView) {
  EXPECT_TRUE(std::isfinite(glm::length(frame({}, {}, 10, 10).eye)));
}

TEST(SurfaceBoxes, HoldTheSurfaceMoreTightlyThanTheCells) {
  const Field field = scenes::forked();
  const SurfaceCover cover = cover_surface(field, {}, {}).value();
  const std::vector<Box> boxes = surface_boxes(cover);
  ASSERT_FALSE(boxes.empty());
  EXPECT_LE(boxes.size(), cover.size());
  double cells = 0, tight = 0;
  const auto volume = [](const Box& box) { return box.size().x * box.size().y * box.size().z; };
  for (std::size_t i = 0; i < cover.size(); ++i) cells += volume(cover.box(i));
  for (const Box& box : boxes) tight += volume(box);
  EXPECT_LT(tight, 0.9 * cells);
  for (int i = 0; i < 300; ++i) {   // from the axis outwards
    Vec3 inside(0, 0, 0.05 + 0.9 * i / 300), outside = inside + Vec3(std::cos(i), std::sin(i), 0.1);
    for (int k = 0; k < 60; ++k) {
      const Vec3 middle = 0.5 * (inside + outside);
      (field.value(middle) >= kIso ? inside : outside) = middle;
    }
    EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.padded(1e-12).contains(inside); }));
  }
}

}  // namespace
}  // namespace cambium
