// Places spread evenly over a box, as many as one likes.
#pragma once

#include "blobtree/geometry.h"

#include <cmath>
#include <cstddef>

namespace cambium {

/// The i-th place of the additive sequence in three dimensions (Roberts 2018), in the unit cube.
inline Vec3 spread_place(std::size_t i) {
  constexpr double kStep[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019702};
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = 0.5 + kStep[k] * static_cast<double>(i), p[k] -= std::floor(p[k]);
  return p;
}

}  // namespace cambium
