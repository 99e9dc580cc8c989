// Degrees in files, radians in memory (private to blobtree/). The doubles in degrees are too few to reach every double in
// radians, so both directions work in long double and the text carries as many digits as it takes.
#pragma once

#include <numbers>

namespace cambium {

inline double radians_from_degrees(long double degrees) {
  return static_cast<double>(degrees * (std::numbers::pi_v<long double> / 180));
}

inline long double degrees_from_radians(double radians) {
  return static_cast<long double>(radians) * (180 / std::numbers::pi_v<long double>);
}

}  // namespace cambium
