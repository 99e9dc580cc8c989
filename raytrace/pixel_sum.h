// What a pixel keeps of its samples.
#pragma once

#include "raytrace/camera_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cambium {

/// Sums over a pixel's samples; in float, a frame is large.
struct PixelSum {
  glm::vec3 direct{0.0f};           ///< premultiplied where the background is transparent
  glm::vec3 albedo{0.0f};
  glm::vec3 lit{0.0f};              ///< albedo * ambient
  glm::vec3 normal{0.0f};
  float depth = 0;
  float alpha = 0;
  float ambient_squared = 0;        ///< of the ambient light's luminance, for its noise
  float ambient = 0;
  float shown = 0, shown_squared = 0;
  std::uint16_t hits = 0, samples = 0;

  /// displayed: luminance in [0, 1] of what a screen would show of this sample alone.
  void add(const CameraSample& sample, double displayed);

  float mean_shown() const { return samples ? shown / samples : 0; }
  float hit_share() const { return samples ? float(hits) / samples : 0; }
  /// Standard deviation of one sample's displayed luminance; 0 while there is one.
  float spread() const;
  /// Standard error of the displayed luminance's mean; 0 while there is one sample.
  float error() const { return samples ? spread() / std::sqrt(float(samples)) : 0; }
};

constexpr std::int32_t kLeaves = -2;

/// Samples of a pixel by the branch that they hit.
struct BranchShare {
  std::int32_t branch = 0;          ///< -1: the ground; kLeaves: any leaf
  std::uint16_t samples = 0;        ///< 0: unused
};

/// What the AOVs need beyond PixelSum, kept only if they are wanted.
struct FirstHitSum {
  static constexpr int kShares = 12;

  glm::vec3 position{0.0f};         ///< this and the next four: of the pixel's nearest hit
  glm::vec2 uv{0.0f};
  float depth = static_cast<float>(kInfinity);
  float branch = -1, order = -1;
  float ridge = 0, occlusion = 0;   ///< over the samples that hit
  std::array<BranchShare, kShares> shares{};  ///< in the order they were met; a thirteenth branch in one pixel is left out

  void add(const CameraSample& sample);
};

}  // namespace cambium
