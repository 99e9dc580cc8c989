// Points of the implicit surface, even over its area, found without any mesh.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

struct SurfaceSamples {
  std::vector<Vec3> points;
  double spacing = 0;        ///< metres: one point for every spacing^2 of area, in expectation
};

/// About `count` points. Every lattice square of edge `spacing` in each of the three axis planes sends one line through the
/// whole field, at a random place of the square; each crossing of it and {f = kIso} is kept with a chance of 1 / (|nx| + |ny| +
/// |nz|), n the normal, which undoes what the three directions favour (Cauchy, Crofton): every piece of surface gets points
/// in proportion to its area, crevices, voids and the faces between touching sheets included.
/// The one bias: where a line runs through a wall or a gap of less than half the smallest surface radius nearby, both crossings
/// are found by where the field turns, from values and slopes half a radius apart; a field that turns more than once there can
/// hide a pair. Points: f = kIso to rounding. Fixed random numbers: the same points at any thread count.
/// Fewer points where so little surface is in so much space that the field's bounds do not rule out that cells would be too many; none only
/// there, and where there is no surface. nullopt if cancelled. Cost: some two microseconds a point on one core.
std::optional<SurfaceSamples> sample_surface(const Field& field, std::size_t count, const RunOptions& run);

}  // namespace cambium
