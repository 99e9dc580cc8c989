// Sun, sky and ground: where light comes from.
#pragma once

#include "raytrace/light.h"

#include <array>

namespace cambium {

class Lighting {
 public:
  explicit Lighting(const Light& light);

  /// Radiance of the sky (or of the ground's light, below the horizon) from that direction, without the sun's disc.
  Vec3 sky(const Vec3& direction) const;
  /// What the camera sees where nothing is hit.
  Vec3 background(const Vec3& direction) const;
  /// A direction towards a point of the sun's disc.
  Vec3 towards_sun(const std::array<double, 2>& sample) const;
  const Vec3& sun_direction() const { return sun_; }
  const Vec3& sun_color() const { return light_.sun_color; }
  /// Light that comes from a surface nearby when the sky is hidden: an estimate of further bounces.
  const Vec3& hidden() const { return hidden_; }

 private:
  Light light_;
  Vec3 sun_, sun_s_, sun_t_;
  Vec3 bounce_{0.0}, hidden_{0.0};
};

/// Right-handed orthonormal pair around a unit vector.
std::array<Vec3, 2> tangents(const Vec3& n);
/// Cosine-distributed direction about a unit normal.
Vec3 cosine_direction(const Vec3& normal, const std::array<double, 2>& sample);

}  // namespace cambium
