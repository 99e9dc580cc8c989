// What branching, pruning and loss leave on bark: the fold in a crotch, sawn wood, old scars. Private to raytrace/.
#pragma once

#include "raytrace/bark.h"

namespace cambium {

/// Turns a blended look into that of a wound as far as the traits say. main: the primitive that contributes most, and material
/// what it is covered with. relief_gradient: of the look's relief, in the world.
void show_wounds(const Contribution& main, const BarkMaterial& material, const SurfaceTraits& traits, double footprint,
                 std::uint64_t seed, BarkLook& look, Vec3& relief_gradient);

}  // namespace cambium
