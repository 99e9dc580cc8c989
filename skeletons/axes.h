// A skeleton taken apart into axes: unbroken paths, each borne by another (field.md section 6).
#pragma once

#include "skeletons/skeleton.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

struct AxisNode {
  Vec3 position{0.0};
  double radius = 0;
  double base_radius = 0;                  ///< where the segment to this node begins; 0: the radius of the node before
};

/// What becomes of an internode that begins thinner than its parent ends.
enum class RadiusSteps {
  kTaper,                                  ///< it tapers from the radius before: a short ledge at every node would show as a ring
  kKeep,                                   ///< AxisNode::base_radius is set
};

/// A place on an axis: on the segment from nodes[segment] to nodes[segment + 1], t in [0, 1].
struct AxisPlace {
  std::uint32_t segment = 0;
  double t = 0;
};

/// Where a branch was sawn off; the axis then ends a little beyond the plane, straight.
struct AxisCut {
  Vec3 point{0.0}, normal{0.0};            ///< the plane; the normal points to what falls off
  double along = 0;                        ///< metres along the axis
};

/// One path. nodes[0] lies on the parent axis (with the lateral's base radius), or is the root.
struct Axis {
  std::uint32_t branch = 0;                ///< its id: 0 is the trunk
  std::uint32_t order = 0;                 ///< 0 at a root, else the parent's + 1
  std::int32_t parent = -1;                ///< index of the axis that bears it; stands before it
  AxisPlace attach;                        ///< where on the parent
  std::vector<AxisNode> nodes;
  std::optional<AxisCut> cut;
};

/// What holds on to an axis and goes where the wood goes: its place is kept up as axes are reshaped, joined and cut.
struct AxisRider {
  std::int32_t axis = -1;                  ///< -1: none, or its wood is gone
  AxisPlace place;
  Vec3 offset{0.0};                        ///< from the place to what is held: not 0 where an axis went up in its parent's solid
  Vec3 tangent{0, 0, 1};                   ///< of the axis there when the rider took hold; unit
};

/// Axes in an order in which parents stand first. Breadth first as made by decompose_axes, so ids are low on thick wood.
struct AxisTree {
  std::vector<Axis> axes;
  std::uint32_t branch_count = 0;          ///< ids given out; some of them may have been removed since
  std::vector<AxisRider> riders;
};

/// Takes away the marked axes and all that they bear; ids stay.
void remove_axes(AxisTree& tree, std::vector<bool> marked);

/// For every axis the indices of the items that it bears, ascending: borne[i] is a span. Cost: linear, in two arrays.
class BorneBy {
 public:
  /// `axis`: the member that says which axis bears an item; negative: none.
  template <class Item>
  BorneBy(std::size_t axes, const std::vector<Item>& items, std::int32_t Item::* axis) : first_(axes + 1, 0) {
    for (const Item& item : items)
      if (item.*axis >= 0) ++first_[item.*axis + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    borne_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < items.size(); ++i)
      if (items[i].*axis >= 0) borne_[next[items[i].*axis]++] = static_cast<std::uint32_t>(i);
  }
  std::span<const std::uint32_t> operator[](std::size_t axis) const {
    return {borne_.data() + first_[axis], first_[axis + 1] - first_[axis]};
  }

 private:
  std::vector<std::uint32_t> first_, borne_;
};

/// The axes that each axis bears.
struct Laterals : BorneBy {
  explicit Laterals(const AxisTree& tree) : BorneBy(tree.axes.size(), tree.axes, &Axis::parent) {}
};

/// The child that continues an axis is the unbracketed one (`lateral` false), else the thickest, else the straightest, else
/// the first. Nodes that are not finite take their parent's place; coincident neighbours are merged (their number is
/// added to *merged). The i-th rider takes hold of node ridden[i] (-1: of none). Cost: linear; no recursion.
AxisTree decompose_axes(const Skeleton& skeleton, RadiusSteps steps = RadiusSteps::kTaper, std::size_t* merged = nullptr,
                        std::span<const std::int32_t> ridden = {});

Vec3 position_at(const Axis& axis, const AxisPlace& place);
double radius_at(const Axis& axis, const AxisPlace& place);
/// Unit; at an inner node the mean of both segments. (0, 0, 1) on an axis without length.
Vec3 tangent_at(const Axis& axis, const AxisPlace& place);
/// Metres from the first node to each node.
std::vector<double> lengths_along(const Axis& axis);
/// The last of them.
double length_of(const Axis& axis);
AxisPlace place_at_length(const std::vector<double>& lengths, double along);
/// The place nearest to p among all segments. Cost: linear in the axis.
AxisPlace nearest_place(const Axis& axis, const Vec3& p);
/// The same by walking from `from` for as long as the distance falls. Cost: the walk.
AxisPlace walk_to_nearest(const Axis& axis, AxisPlace from, const Vec3& p);

/// Direction across t, as near to `wanted` as can be. t is a unit vector.
Vec3 across(const Vec3& t, const Vec3& wanted);
/// u turned with the smallest rotation that takes unit vector `from` to unit vector `to`.
Vec3 transported(const Vec3& u, const Vec3& from, const Vec3& to);

}  // namespace cambium
