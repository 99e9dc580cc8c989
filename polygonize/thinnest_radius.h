// The thinnest twig of a field: what every choice of a cell size begins with.
#pragma once

#include "blobtree/field.h"

#include <algorithm>

namespace cambium {

/// Metres; infinite if no primitive has a radius. Cost: linear in the primitives.
inline double thinnest_radius(const Field& field) {
  double radius = kInfinity;
  for (std::size_t i = 0; i < field.atom_count(); ++i) radius = std::min(radius, field.atom_radius(static_cast<std::uint32_t>(i)));
  return radius;
}

}  // namespace cambium
