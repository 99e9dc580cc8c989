// Families of random BlobTrees that each strain one promise of the kernel.
#pragma once

#include "blobtree/blobtree.h"

#include <cstdint>
#include <string>
#include <vector>

namespace cambium {

struct StrainedBlobTree {
  BlobTree tree;
  std::vector<Vec3> marks;     ///< points at which something happens: on the very edge of a support, at a joint
};

/// Names of the families: nests of everything, the same over three decades of radii, one-sided nests hundreds of levels deep,
/// operators with fifty children, chains that fold back over themselves and stand still, forks that bear forks, solids cut by
/// half-spaces, and supports that touch in exactly one point.
const std::vector<std::string>& strains();
/// One more family, nests with flares. Not among strains(), from which corpora keyed by seed are drawn: these stay as they are.
inline constexpr std::size_t kFlaredStrain = 8;
StrainedBlobTree strained_blobtree(std::size_t strain, std::uint64_t seed);

}  // namespace cambium
