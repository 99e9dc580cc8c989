// The thin lens: what is sharp, how much is blurred, what a focal length shows.
#include "raytrace/view.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cambium {
namespace {

View photographed(const Camera& camera, int width, int height) {
  View view = lens_of(camera, width, height);
  view.eye = {1, 2, 3};
  view.look_along({1, 1, 0.2});
  focus(view, camera, {4, 5, 3.5});
  return view;
}

/// Where a ray meets the plane at `distance` from the eye along the view.
Vec3 at_depth(const View& view, const Ray& ray, double distance) {
  const double ahead = distance - glm::dot(ray.origin - view.eye, view.forward);
  return ray.at(ahead / glm::dot(ray.direction, view.forward));
}

TEST(View, WithoutALensDiameterEveryPointOfTheLensIsItsMiddle) {
  const View view = photographed({}, 300, 400);
  EXPECT_EQ(view.lens_radius, 0);
  const Ray through = view.ray(10, 20), other = view.ray(10, 20, {0.9, 0.1});
  EXPECT_EQ(through.origin, other.origin);
  EXPECT_EQ(through.direction, other.direction);
}

TEST(View, RaysOfOnePixelMeetInThePlaneOfFocus) {
  Camera camera;
  camera.focal_length = 0.085;
  camera.f_number = 1.8;
  camera.focus = Vec3(3, 4, 4);
  const View view = photographed(camera, 300, 400);
  EXPECT_NEAR(view.lens_radius, 0.5 * 0.085 / 1.8, 1e-12);
  EXPECT_NEAR(glm::dot(*camera.focus - view.eye, view.forward), view.focus_distance, 1e-12);
  for (const auto& pixel : {std::array{0.0, 0.0}, std::array{150.0, 200.0}, std::array{299.5, 17.25}}) {
    const Vec3 sharp = at_depth(view, view.ray(pixel[0], pixel[1]), view.focus_distance);
    for (const auto& sample : {std::array{0.0, 0.0}, std::array{0.5, 0.5}, std::array{0.99, 0.3}, std::array{0.2, 0.7}}) {
      const Ray ray = view.ray(pixel[0], pixel[1], sample);
      EXPECT_NEAR(glm::length(ray.direction), 1, 1e-12);
      EXPECT_LE(glm::distance(ray.origin, view.eye), view.lens_radius * (1 + 1e-12));
      EXPECT_LT(glm::distance(at_depth(view, ray, view.focus_distance), sharp), 1e-9);
    }
  }
}

TEST(View, TwiceAsFarAsTheFocusTheBlurIsAsWideAsTheLens) {
  Camera camera;
  camera.focal_length = 0.05;
  camera.f_number = 2;
  camera.focus_distance = 1.5;
  const View view = photographed(camera, 100, 100);
  EXPECT_EQ(view.focus_distance, 1.5);
  const Vec3 middle = at_depth(view, view.ray(50, 50), 3);
  double widest = 0;
  for (int i = 0; i < 64; ++i) widest = std::max(widest, glm::distance(at_depth(view, view.ray(50, 50, {i / 64.0, 0.999}), 3), middle));
  EXPECT_NEAR(widest, view.lens_radius, 0.02 * view.lens_radius);
}

TEST(View, TheLongerSideOfThePictureIs36MillimetresOfFilm) {
  Camera camera;
  camera.focal_length = 0.05;
  const View upright = lens_of(camera, 600, 900), wide = lens_of(camera, 900, 600);
  EXPECT_NEAR(upright.tan_y, 0.018 / 0.05, 1e-12);
  EXPECT_NEAR(upright.tan_x, 0.012 / 0.05, 1e-12);
  EXPECT_NEAR(wide.tan_x, upright.tan_y, 1e-12);
  EXPECT_NEAR(wide.tan_y, upright.tan_x, 1e-12);
  // A field of view stands for the focal length that shows as much.
  Camera by_angle;
  by_angle.field_of_view = 2 * std::atan(0.018 / 0.05);
  by_angle.f_number = camera.f_number = 4;
  EXPECT_NEAR(lens_of(by_angle, 600, 900).lens_radius, lens_of(camera, 600, 900).lens_radius, 1e-12);
}

TEST(View, FocusBehindTheLensIsRightInFrontOfIt) {
  Camera camera;
  camera.focus = Vec3(-10, -10, 0);
  EXPECT_GT(photographed(camera, 10, 10).focus_distance, 0);
}

TEST(View, TurnsAboutAVertical) {
  const View view = photographed({}, 10, 10);
  const Vec3 center(4, 5, 0);
  const View quarter = view.turned(center, std::acos(0.0));
  EXPECT_LT(glm::distance(quarter.eye, Vec3(4 + 3, 5 - 3, 3)), 1e-12);
  EXPECT_NEAR(quarter.forward.z, view.forward.z, 1e-15);
  EXPECT_NEAR(glm::dot(quarter.forward, quarter.right), 0, 1e-15);
  EXPECT_LT(glm::distance(view.turned(center, 4 * std::acos(0.0)).eye, view.eye), 1e-12);
}

}  // namespace
}  // namespace cambium
