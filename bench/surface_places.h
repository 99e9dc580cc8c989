// Places on the surface of a tree, spread over its internodes, where a benchmark puts its cells.
#pragma once

#include <cstddef>
#include <vector>

#include "bench/random_numbers.h"
#include "blobtree/field.h"
#include "skeletons/skeleton.h"

namespace cambium::bench {

struct SurfacePlace {
  Vec3 point;         ///< on the surface, to a millionth of the radius
  double radius = 0;  ///< of the skeleton there

  /// About one branch diameter across.
  Box cell() const { return {point - radius, point + radius}; }
};

/// `count` places on internodes drawn at random, each found by walking outwards from the internode's tip. Internodes whose
/// tip lies outside the surface (pruned away, or moved by conditioning) are passed over. Errors: std::runtime_error if
/// hardly any internode has a surface.
std::vector<SurfacePlace> surface_places(const Skeleton& skeleton, const Field& field, std::size_t count,
                                         RandomNumbers random);

}  // namespace cambium::bench
