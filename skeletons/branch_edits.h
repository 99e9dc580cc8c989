// Sawing off branches: only the branch named is cut (field.md section 6, pruning).
#pragma once

#include "skeletons/axes.h"
#include "skeletons/surface.h"

#include <optional>
#include <vector>

namespace cambium {

/// Index of the axis meant; nullopt if its branch is there no longer (dropped or cut off before).
/// Errors: InputError if the selector names no branch of this tree; `what` ("a prune") stands in the message.
std::optional<std::size_t> select_axis(const AxisTree& tree, const BranchSelector& where, const std::string& what);

/// Metres along the axis to where it leaves its parent's surface; 0 at a root.
double length_inside_parent(const AxisTree& tree, std::size_t axis);

/// Shortens each named axis to a little beyond its plane, removes the laterals that it bears beyond, and marks it as cut.
/// Errors: as select_axis, and for a distance or normal that is no number.
void apply_prunes(AxisTree& tree, const std::vector<Prune>& prunes, Profile profile, SurfaceReport& report);

}  // namespace cambium
