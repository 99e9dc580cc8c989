#include "skeletons/conditioning.h"

#include "skeletons/axis_shaping.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

// Merging before corners are rounded: nothing smaller is left after smoothing, and shorter steps only cost time.
constexpr double kChainSpacing = 0.5;
constexpr double kGalbraithSpacing = 2.5;  // field.md section 6, conditioning 4
// Metres: a BlobTree takes lengths from 1e-9 m, and the width of a cut is a twentieth of the radius.
constexpr double kThinnest = 1e-7;

class Conditioner {
 public:
  Conditioner(AxisTree& tree, const ConditioningOptions& options, Profile profile, const std::vector<double>& bend,
              SurfaceReport& report)
      : axes_(tree.axes), tree_(tree), options_(options), profile_(profile), bend_(bend), report_(report),
        laterals_(tree), riders_(tree.axes.size(), tree.riders, &AxisRider::axis), moved_(tree.axes.size(), false), removed_(tree.axes.size(), false) {
    double largest = 0;
    for (const Axis& axis : axes_)
      for (const AxisNode& node : axis.nodes) largest = std::max(largest, node.radius);
    min_radius_ = largest > 0 ? 1e-3 * largest : 1e-3;
    if (options.min_radius && *options.min_radius > 0 && std::isfinite(*options.min_radius))
      min_radius_ = *options.min_radius;
    min_radius_ = std::max(min_radius_, kThinnest);
    max_turn_ = options.max_turn > 0.005 ? std::min(options.max_turn, 3.0) : 0.005;
    smooth_ = options.enabled && options.smooth > 0 && std::isfinite(options.smooth) ? options.smooth : 0;
  }

  void run() {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      Axis& axis = axes_[i];
      if (axis.parent >= 0) {
        axis.order = axes_[axis.parent].order + 1;
        follow_parent(i);
        if (options_.enabled && !reroot(i)) continue;
      }
      clamp_radii(axis);
      shape(i);
    }
    remove_axes(tree_, std::move(removed_));
  }

 private:
  /// The parent has moved: the first node goes along, the others the less the farther they are.
  void follow_parent(std::size_t i) {
    Axis& axis = axes_[i];
    const Vec3 point = position_at(axes_[axis.parent], axis.attach);
    const Vec3 shift = point - axis.nodes[0].position;
    const double distance = glm::length(shift);
    if (distance > 0 && !moved_[i] && axis.nodes.size() > 2) {
      const std::vector<double> lengths = lengths_along(axis);
      for (std::size_t k = 1; k + 1 < lengths.size(); ++k)
        axis.nodes[k].position += shift * (std::exp(-0.5 * lengths[k] / distance) * (1 - lengths[k] / lengths.back()));
    }
    axis.nodes[0].position = point;
  }

  bool inside(const Axis& parent, const AxisPlace& place, const Vec3& p) const {
    return glm::distance(position_at(parent, place), p) < radius_at(parent, place);
  }

  /// Conditioning 3. False if nothing of the lateral is left; what it bore has then moved to the parent.
  bool reroot(std::size_t i) {
    Axis& axis = axes_[i];
    const Axis& parent = axes_[axis.parent];
    std::size_t outside = 1;
    AxisPlace place = axis.attach;
    for (; outside < axis.nodes.size(); ++outside) {
      const AxisPlace next = walk_to_nearest(parent, place, axis.nodes[outside].position);
      if (!inside(parent, next, axis.nodes[outside].position)) break;
      place = next;
    }
    if (outside == 1 && axis.nodes.size() > 1) return true;
    const bool gone = outside == axis.nodes.size();

    for (const std::uint32_t k : laterals_[i]) {
      Axis& lateral = axes_[k];
      const double at = lateral.attach.segment + lateral.attach.t;
      if (!gone && at >= static_cast<double>(outside)) {
        lateral.attach.segment -= static_cast<std::uint32_t>(outside - 1);
        continue;
      }
      lateral.attach = walk_to_nearest(parent, place, lateral.nodes[0].position);
      lateral.parent = axis.parent;
      moved_[k] = true;
      ++report_.laterals_rerooted;
    }
    hand_over_riders(i, outside, place);
    report_.nodes_dropped += outside - 1;
    if (gone) {
      removed_[i] = true;
      return false;
    }
    // Where the segment comes out, by halving.
    const AxisNode a = axis.nodes[outside - 1], b = axis.nodes[outside];
    double in = 0, out = 1;
    for (int step = 0; step < 40; ++step) {
      const double t = 0.5 * (in + out);
      const Vec3 p = glm::mix(a.position, b.position, t);
      place = walk_to_nearest(parent, place, p);
      (inside(parent, place, p) ? in : out) = t;
    }
    axis.attach = walk_to_nearest(parent, place, glm::mix(a.position, b.position, out));
    axis.nodes.erase(axis.nodes.begin(), axis.nodes.begin() + static_cast<std::ptrdiff_t>(outside - 1));
    axis.nodes[0] = {position_at(parent, axis.attach), glm::mix(a.radius, b.radius, out)};
    ++report_.laterals_rerooted;
    return true;
  }

  /// Riders on what goes up in the parent's solid, all before node `outside`, hold on to the parent from now on, and stay where they are.
  void hand_over_riders(std::size_t i, std::size_t outside, const AxisPlace& near) {
    const Axis& axis = axes_[i];
    const Axis& parent = axes_[axis.parent];
    for (const std::uint32_t k : riders_[i]) {
      AxisRider& rider = tree_.riders[k];
      if (outside < axis.nodes.size() && rider.place.segment + rider.place.t >= static_cast<double>(outside)) {
        rider.place.segment -= static_cast<std::uint32_t>(outside - 1);
        continue;
      }
      const Vec3 held = position_at(axis, rider.place);
      rider.axis = axis.parent;
      rider.place = walk_to_nearest(parent, near, held);
      rider.offset = held - position_at(parent, rider.place);
      rider.tangent = tangent_at(parent, rider.place);
    }
  }

  void clamp_radii(Axis& axis) {
    double limit = kInfinity;
    if (options_.enabled && axis.parent >= 0) limit = radius_at(axes_[axis.parent], axis.attach);
    for (AxisNode& node : axis.nodes) {
      const double lowest = options_.enabled ? min_radius_ : kThinnest;
      const double radius = node.radius > 0 ? std::min(std::max(node.radius, lowest), limit) : std::min(min_radius_, limit);
      if (radius != node.radius) ++report_.radii_clamped;
      node.radius = radius;
      if (options_.enabled) {
        if (node.base_radius > 0) node.base_radius = std::clamp(node.base_radius, radius, std::max(radius, limit));
        limit = radius;
      }
    }
  }

  void shape(std::size_t i) {
    Axis& axis = axes_[i];
    const double angle = profile_ == Profile::kChain ? bend_of_order(bend_, axis.order) : 0;
    if (smooth_ == 0 && angle == 0 && !(options_.enabled && profile_ == Profile::kGalbraith)) return;
    Path path = path_of(axis);
    report_.largest_move = std::max(report_.largest_move, diffuse(path, smooth_));
    if (profile_ == Profile::kGalbraith) {
      report_.nodes_dropped += merge_short(path, kGalbraithSpacing);
    } else {
      if (smooth_ > 0) report_.nodes_dropped += merge_short(path, kChainSpacing);
      if (angle != 0)
        bend_internodes(path, axis.parent < 0 ? Vec3(0.0) : tangent_at(axes_[axis.parent], axis.attach), angle, max_turn_);
      if (smooth_ > 0) round_corners(path, 0.5 * smooth_, max_turn_);
    }
    if (path.size() > axis.nodes.capacity()) std::vector<AxisNode>().swap(axis.nodes);  // freed before the new are made
    axis.nodes.clear();
    axis.nodes.reserve(path.size());
    for (const PathNode& node : path) axis.nodes.push_back({node.position, node.radius, node.base_radius});
    for (const std::uint32_t k : laterals_[i]) {
      if (axes_[k].parent != static_cast<std::int32_t>(i)) continue;  // moved to the parent
      AxisPlace& attach = axes_[k].attach;
      attach = place_of(path, attach.segment + attach.t);
    }
    for (const std::uint32_t k : riders_[i]) {
      AxisRider& rider = tree_.riders[k];
      if (rider.axis == static_cast<std::int32_t>(i)) rider.place = place_of(path, rider.place.segment + rider.place.t);
    }
  }

  std::vector<Axis>& axes_;
  AxisTree& tree_;
  const ConditioningOptions& options_;
  Profile profile_;
  const std::vector<double>& bend_;
  SurfaceReport& report_;
  const Laterals laterals_;                ///< as they were at first
  const BorneBy riders_;                   ///< likewise
  std::vector<bool> moved_, removed_;
  double min_radius_ = 0, max_turn_ = 0, smooth_ = 0;
};

}  // namespace

double bend_of_order(const std::vector<double>& bend, std::uint32_t order) {
  return bend.empty() ? 0 : bend[std::min<std::size_t>(order, bend.size() - 1)];
}

void condition(AxisTree& tree, const ConditioningOptions& options, Profile profile, const std::vector<double>& bend,
               SurfaceReport& report) {
  Conditioner(tree, options, profile, bend, report).run();
}

}  // namespace cambium
