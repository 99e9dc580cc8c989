// Makes axes fit to be surfaced (field.md section 6, "Conditioning"); never fails.
#pragma once

#include "skeletons/axes.h"
#include "skeletons/surface.h"

namespace cambium {

/// Legal radii always; with options.enabled also radii that do not rise towards the tip, laterals re-rooted where they leave
/// their parent's solid, axes smoothed, and then for the chain profile corners rounded, for galbraith short internodes
/// merged. On the chain profile the arcs of `bend` (radians per order, the last goes on) are put in as well.
/// Adds what it did to `report`. Cost: linear but for walks along the parent.
void condition(AxisTree& tree, const ConditioningOptions& options, Profile profile, const std::vector<double>& bend,
               SurfaceReport& report);

/// The bend angle of an order; 0 where there is none.
double bend_of_order(const std::vector<double>& bend, std::uint32_t order);

}  // namespace cambium
