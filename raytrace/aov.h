// The auxiliary images (AOVs) that a picture can carry.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

enum class Aov { kDepth, kPosition, kNormal, kAlbedo, kUv, kBranch, kOrder, kRidge, kOcclusion, kSamples, kCryptomatte };

struct AovInfo {
  Aov aov;
  const char* name;                        ///< in --aov and in the name of the PNG beside
  std::vector<std::string> channels;       ///< in the EXR, with their layer
  bool full_float;                         ///< 32 bit in the EXR, else 16
};

/// One of each Aov, in its order.
std::span<const AovInfo> all_aovs();
const AovInfo& info_of(Aov aov);
/// Errors: InputError listing the names.
Aov aov_named(std::string_view name);
/// "depth, position, ..."
std::string aov_names();

}  // namespace cambium
