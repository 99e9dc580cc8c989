#include "skeletons/branch_edits.h"

#include "blobtree/input_error.h"
#include "skeletons/axis_frames.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// Below this cosine between plane normal and branch the axis is not made longer any more: 80 degrees.
constexpr double kFlattestCut = 0.17;

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void cut_axis(AxisTree& tree, std::size_t index, const Prune& prune, Profile profile, SurfaceReport& report) {
  Axis& axis = tree.axes[index];
  const std::string name = "branch " + std::to_string(axis.branch);
  const std::vector<double> lengths = lengths_along(axis);
  const double along = length_inside_parent(tree, index) + prune.distance;
  if (along >= (axis.cut ? axis.cut->along : lengths.back())) {
    report.notes.push_back("The cut of " + name + " lies beyond its tip; nothing was cut.");
    return;
  }
  const AxisPlace place = place_at_length(lengths, along);
  const Vec3 point = position_at(axis, place), tangent = segment_direction(axis, place.segment);
  const double radius = radius_at(axis, place);
  Vec3 normal = prune.normal ? glm::normalize(*prune.normal) : tangent;
  if (glm::dot(normal, tangent) < 0) normal = -normal;
  const double cosine = std::max(glm::dot(normal, tangent), kFlattestCut);
  const double slope = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;

  std::vector<bool> beyond(tree.axes.size(), false);
  bool any = false;
  for (std::size_t k = index + 1; k < tree.axes.size(); ++k) {
    const Axis& lateral = tree.axes[k];
    if (lateral.parent != static_cast<std::int32_t>(index)) continue;
    if (lateral.attach.segment + lateral.attach.t >= place.segment + place.t) beyond[k] = any = true;
  }
  for (AxisRider& rider : tree.riders)
    if (rider.axis == static_cast<std::int32_t>(index) && rider.place.segment + rider.place.t >= place.segment + place.t)
      rider.axis = -1;
  // One node at the plane keeps the taper; internodes that are cones of their own go through in one.
  const std::size_t crossed = std::min<std::size_t>(place.segment + (place.t > 0 ? 1 : 0), axis.nodes.size() - 1);
  const double base_radius = profile == Profile::kGalbraith ? axis.nodes[crossed].base_radius : 0;
  axis.nodes.resize(place.segment + 1);
  if (profile == Profile::kChain && place.t > 0) axis.nodes.push_back({point, radius});
  if (profile == Profile::kGalbraith && place.t <= 0 && place.segment > 0) axis.nodes.pop_back();
  // Straight on, far enough for the plane to meet the full section everywhere.
  axis.nodes.push_back({point + tangent * (radius * (slope + 0.5)), radius, base_radius});
  axis.cut = AxisCut{point, normal, along};
  report.notes.push_back("Cut " + name + " " + std::to_string(along) + " m along its axis.");
  if (any) remove_axes(tree, std::move(beyond));
}

}  // namespace

std::optional<std::size_t> select_axis(const AxisTree& tree, const BranchSelector& where, const std::string& what) {
  if (where.branch) {
    for (std::size_t i = 0; i < tree.axes.size(); ++i)
      if (tree.axes[i].branch == *where.branch) return i;
    if (*where.branch >= tree.branch_count)
      throw InputError({}, what + " of branch " + std::to_string(*where.branch),
                       "a branch from 0 to " + std::to_string(tree.branch_count - 1));
    return std::nullopt;
  }
  if (!where.position) throw InputError({}, what + " without a branch", "a branch id or a position");
  if (!finite(*where.position)) throw InputError({}, what + " at a position that is no number", "three finite coordinates");
  std::optional<std::size_t> best;
  double best_distance = kInfinity;
  for (std::size_t i = 0; i < tree.axes.size(); ++i) {
    const Vec3 p = position_at(tree.axes[i], nearest_place(tree.axes[i], *where.position));
    const double distance = glm::distance(p, *where.position);
    if (distance < best_distance) best = i, best_distance = distance;
  }
  return best;
}

double length_inside_parent(const AxisTree& tree, std::size_t index) {
  const Axis& axis = tree.axes[index];
  if (axis.parent < 0) return 0;
  const Axis& parent = tree.axes[axis.parent];
  AxisPlace near = axis.attach;
  const auto inside = [&](const Vec3& p) {
    near = walk_to_nearest(parent, near, p);
    return glm::distance(position_at(parent, near), p) < radius_at(parent, near);
  };
  double along = 0;
  for (std::size_t i = 1; i < axis.nodes.size(); ++i) {
    const Vec3 a = axis.nodes[i - 1].position, b = axis.nodes[i].position;
    if (inside(b)) {
      along += glm::distance(a, b);
      continue;
    }
    double in = 0, out = 1;
    for (int step = 0; step < 50; ++step) {
      const double t = 0.5 * (in + out);
      (inside(glm::mix(a, b, t)) ? in : out) = t;
    }
    return along + out * glm::distance(a, b);
  }
  return along;
}

void apply_prunes(AxisTree& tree, const std::vector<Prune>& prunes, Profile profile, SurfaceReport& report) {
  for (const Prune& prune : prunes) {
    if (!std::isfinite(prune.distance) || prune.distance < 0)
      throw InputError({}, "a prune at distance " + std::to_string(prune.distance), "a distance of 0 or more");
    if (prune.normal && !(finite(*prune.normal) && glm::length(*prune.normal) > 0))
      throw InputError({}, "a prune with a normal without direction", "a vector of finite, non-zero length");
    const std::optional<std::size_t> axis = select_axis(tree, prune.where, "a prune");
    if (axis) {
      cut_axis(tree, *axis, prune, profile, report);
    } else {
      report.notes.push_back("A cut of branch " + std::to_string(*prune.where.branch) + " was left out: the branch is gone.");
    }
  }
}

}  // namespace cambium
