// Shapes of @O, @o and @c: a sphere and a disc of diameter 1.
#pragma once

#include "skeletons/foliage.h"

namespace cambium {

OrganShape unit_sphere();  ///< around the origin, 512 triangles, outward
OrganShape unit_disc();    ///< around the origin, in the plane of left and heading, 32 triangles

}  // namespace cambium
