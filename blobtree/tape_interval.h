// The bounds of a tape's value where those of its atoms are known. Private to blobtree/.
#pragma once

#include "blobtree/active_atoms.h"
#include "blobtree/interpreter.h"
#include "blobtree/tape.h"

namespace cambium {

/// `tape` was made of the atoms `active` and meets no warp; bounds over `ball`, conservative.
Interval tape_interval(const CompiledTree& tree, const Tape& tape, const ActiveAtoms& active, const Ball& ball,
                       TapeScratch<Interval>& scratch);

/// Bounds and values round differently: a hair wider, except at 0.
inline Interval a_hair_wider(const Interval& f) {
  constexpr double kRounding = 1e-13;
  return {f.lo - kRounding * std::abs(f.lo), f.hi + kRounding * std::abs(f.hi)};
}
/// Of a chain, from the bounds of its nearest segment's swept ratio.
inline Interval chain_interval(const Interval& ratio, double strength) {
  return falloff_interval(ratio.lo * kRadiusPerSupport * (1 - 1e-12), ratio.hi * kRadiusPerSupport * (1 + 1e-12), strength);
}

/// Of a flare, whose M has those bounds.
inline Interval flare_interval(const Interval& ratio, const Interval& factor, double strength) {
  return chain_interval({ratio.lo / factor.hi, ratio.hi / factor.lo}, strength);
}

}  // namespace cambium
