// Scars: a short stub on the surface with a negative field summed onto it (Galbraith et al. 2004, section 3.4).
#pragma once

#include "skeletons/axes.h"
#include "skeletons/axis_frames.h"
#include "skeletons/surface.h"

#include <vector>

namespace cambium {

struct PlacedScar {
  std::size_t axis = 0;                    ///< index
  AxisPlace place;
  double angle = 0;                        ///< radians about the axis from its u direction
  std::optional<double> radius;            ///< metres
  double depth = 1;
};

/// The scars named and the ones drawn at random from the seed, by axis and place. Random ones are spread by length over wood
/// at least as thick as asked for, and keep clear of branch bases, tips and cuts.
/// Errors: InputError for a scar that names no branch or whose numbers are not legal.
std::vector<PlacedScar> place_scars(const AxisTree& tree, const std::vector<AxisFrame>& frames,
                                    const SurfaceOptions& options, SurfaceReport& report);

/// The stub and the dent of one scar, for a straight piece of axis through `center` (unit tangent, u direction across it).
struct ScarPrimitives {
  Capsule stub, dent;
};
ScarPrimitives scar_primitives(const PlacedScar& scar, const Vec3& center, const Vec3& tangent, const Vec3& u,
                               double axis_radius);

}  // namespace cambium
