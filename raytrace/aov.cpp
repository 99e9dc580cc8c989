#include "raytrace/aov.h"

#include "blobtree/input_error.h"
#include "raytrace/cryptomatte.h"

namespace cambium {

std::span<const AovInfo> all_aovs() {
  static const std::vector<AovInfo> all = {
      {Aov::kDepth, "depth", {"Z"}, true},
      {Aov::kPosition, "position", {"P.X", "P.Y", "P.Z"}, true},
      {Aov::kNormal, "normal", {"N.X", "N.Y", "N.Z"}, false},
      {Aov::kAlbedo, "albedo", {"albedo.R", "albedo.G", "albedo.B"}, false},
      {Aov::kUv, "uv", {"UV.U", "UV.V"}, true},
      {Aov::kBranch, "branch", {"branch.id"}, true},
      {Aov::kOrder, "order", {"order.Y"}, false},
      {Aov::kRidge, "ridge", {"ridge.Y"}, false},
      {Aov::kOcclusion, "occlusion", {"occlusion.Y"}, false},
      {Aov::kSamples, "samples", {"samples.Y"}, true},
      {Aov::kCryptomatte, "cryptomatte", matte_channels(), true},
  };
  return all;
}

const AovInfo& info_of(Aov aov) { return all_aovs()[static_cast<std::size_t>(aov)]; }

std::string aov_names() {
  std::string names;
  for (const AovInfo& info : all_aovs()) names += (names.empty() ? "" : ", ") + std::string(info.name);
  return names;
}

Aov aov_named(std::string_view name) {
  for (const AovInfo& info : all_aovs()) {
    if (info.name == name) return info.aov;
  }
  throw InputError({}, "'" + std::string(name) + "'", "one of " + aov_names());
}

}  // namespace cambium
