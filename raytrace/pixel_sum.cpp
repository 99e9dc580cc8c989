#include "raytrace/pixel_sum.h"

#include "raytrace/tone.h"

namespace cambium {

void PixelSum::add(const CameraSample& sample, double displayed) {
  ++samples;
  direct += glm::vec3(sample.direct);
  alpha += static_cast<float>(sample.alpha);
  shown += static_cast<float>(displayed);
  shown_squared += static_cast<float>(displayed * displayed);
  if (!(sample.depth < kInfinity)) return;
  ++hits;
  albedo += glm::vec3(sample.albedo);
  lit += glm::vec3(sample.albedo * sample.ambient);
  normal += glm::vec3(sample.normal);
  depth += static_cast<float>(sample.depth);
  const auto light = static_cast<float>(luminance(sample.ambient));
  ambient += light;
  ambient_squared += light * light;
}

float PixelSum::spread() const {
  if (samples < 2) return 0;
  const float n = samples;
  return std::sqrt(std::max(0.0f, (shown_squared - shown * shown / n) / (n - 1)));
}

void FirstHitSum::add(const CameraSample& sample) {
  if (!(sample.depth < kInfinity)) return;
  ridge += static_cast<float>(sample.ridge);
  occlusion += static_cast<float>(sample.occlusion);
  const auto id = sample.leaf ? kLeaves : static_cast<std::int32_t>(sample.branch);
  for (BranchShare& share : shares) {
    if (share.samples > 0 && share.branch != id) continue;
    share.branch = id;
    ++share.samples;
    break;
  }
  if (!(sample.depth < depth)) return;
  depth = static_cast<float>(sample.depth);
  position = glm::vec3(sample.position);
  uv = glm::vec2(sample.uv);
  branch = static_cast<float>(sample.branch);
  order = static_cast<float>(sample.order);
}

}  // namespace cambium
