// The two ways of building a BlobTree from conditioned axes (field.md section 6). Neither recurses.
#pragma once

#include "blobtree/blobtree.h"
#include "skeletons/scars.h"

#include <vector>

namespace cambium {

/// Every axis one unbroken chain that bears its laterals in one fork (a sum without ridges). `scars` in the order in which
/// place_scars gives them. Returns the root's node.
NodeId build_chain_profile(const AxisTree& tree, const std::vector<AxisFrame>& frames, const SurfaceOptions& options,
                           const std::vector<PlacedScar>& scars, BlobTreeBuilder& builder, SurfaceReport& report);

/// One cone per internode, shortened as in the paper, bends as warps. Laterals must stand at nodes: the nearest is taken.
NodeId build_galbraith_profile(const AxisTree& tree, const std::vector<AxisFrame>& frames, const SurfaceOptions& options,
                               const std::vector<PlacedScar>& scars, BlobTreeBuilder& builder, SurfaceReport& report);

/// Of the local radius: the face of a cut is sharp, and still has a gradient that root finding can use.
inline constexpr double kCutWidth = 0.05;

/// The half-space that cuts an axis.
HalfSpace half_space_of(const AxisCut& cut, double radius);

/// The scars of one axis: a range of a list sorted by axis.
struct ScarRange {
  std::vector<PlacedScar>::const_iterator first, last;
  bool empty() const { return first == last; }
};
ScarRange scars_of(const std::vector<PlacedScar>& scars, std::size_t axis);

}  // namespace cambium
