#include "skeletons/profiles.h"

#include <algorithm>

namespace cambium {
namespace {

class ChainProfile {
 public:
  ChainProfile(const AxisTree& tree, const std::vector<AxisFrame>& frames, const SurfaceOptions& options,
               const std::vector<PlacedScar>& scars, BlobTreeBuilder& builder, SurfaceReport& report)
      : axes_(tree.axes), frames_(frames), options_(options), scars_(scars), builder_(builder), report_(report),
        laterals_(tree), built_(tree.axes.size(), kNone) {}

  NodeId build() {
    // Parents stand first, so going backwards every lateral is built before the axis that bears it.
    for (std::size_t i = axes_.size(); i-- > 0;) built_[i] = build_axis(i);
    std::vector<NodeId> roots;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (axes_[i].parent < 0) roots.push_back(built_[i]);
    if (stubs_ > 0) report_.notes.push_back(std::to_string(stubs_) + " laterals end within the wood that bears them and became stubs.");
    if (buried_ > 0) report_.notes.push_back(std::to_string(buried_) + " laterals lie within the wood that bears them and were left out.");
    const NodeId all = roots.size() == 1 ? roots[0] : builder_.add(Sum{std::move(roots)});
    if (!options_.base || options_.base->below == BelowGround::kKeep) return all;
    return cut_at_ground(all, ground(), axes_[0].nodes[0].radius, builder_);
  }

 private:
  static constexpr NodeId kNone = static_cast<NodeId>(-1);

  /// The part of an axis that has a surface, and where it begins.
  struct Body {
    std::vector<ChainNode> nodes;
    double begin = 0;                      // metres along the axis
    std::size_t segment = 0;
  };

  NodeId build_axis(std::size_t i) {
    std::vector<std::uint32_t> borne;
    for (const std::uint32_t k : laterals_[i])
      if (built_[k] != kNone) borne.push_back(k);

    Body body = body_of(i);
    if (body.nodes.empty() && !borne.empty()) body = stub_of(i);
    if (body.nodes.empty() && !protrudes(i)) {
      ++buried_;
      return kNone;
    }
    if (body.nodes.empty()) body = stub_of(i);
    const NodeId axis = add_body(i, std::move(body));
    if (borne.empty()) return axis;
    if (!options_.ridges) {
      std::vector<NodeId> children{axis};
      for (const std::uint32_t k : borne) children.push_back(built_[k]);
      return builder_.add(Sum{std::move(children)});
    }
    Fork fork;
    fork.axis = axis;
    fork.width = options_.width;
    fork.lip = options_.lip;
    fork.laterals.reserve(borne.size());
    for (const std::uint32_t k : borne) fork.laterals.push_back(lateral_of(i, k));
    return builder_.add(std::move(fork));
  }

  Lateral lateral_of(std::size_t i, std::uint32_t k) const {
    const Axis &axis = axes_[i], &lateral = axes_[k];
    const double parent_radius = radius_at(axis, lateral.attach), radius = lateral.nodes[0].radius;
    const Vec3 along = tangent_at(axis, lateral.attach);
    Lateral made;
    made.child = built_[k];
    made.point = position_at(axis, lateral.attach);
    made.direction = across(segment_direction(lateral, 0), is_root(axis, lateral) ? -along : along);
    made.softness = 0.6 * radius;
    made.reach = 2 * (parent_radius + radius);
    return made;
  }

  /// What leaves a trunk at its foot, not upwards, is a root: the trunk melts into it from above, and its crotch is below.
  static bool is_root(const Axis& axis, const Axis& lateral) {
    constexpr double kFootRadii = 0.5, kUpwards = 0.35;
    if (axis.parent >= 0) return false;
    const Vec3 foot = axis.nodes[0].position, along = tangent_at(axis, lateral.attach);
    return glm::distance(position_at(axis, lateral.attach), foot) <= kFootRadii * axis.nodes[0].radius &&
           glm::dot(segment_direction(lateral, 0), along) < kUpwards;
  }

  GroundPlane ground() const { return ground_of(*options_.base, axes_[0].nodes[0].position); }

  static constexpr double kClearance = 1.75;   // of its radius: where a lateral starts, from the axis, less the parent's radius

  /// Where a lateral starts along its own path. field.md has 2.2 r - R, which keeps its support off the far side of the axis only
  /// above 35 degrees or so: at 20 degrees and r = R the far side would bulge by 5.9 %. Less than 1.75 r - R away from the axis
  /// it is too near at any angle (the numbers are in junction_field_test.cpp).
  double delta_of(const Axis& axis) const {
    constexpr double kFarthestRadii = 4;
    if (axis.parent < 0) return 0;
    const Axis& parent = axes_[axis.parent];
    const double r = axis.nodes[0].radius, parent_radius = radius_at(parent, axis.attach);
    const double sine = glm::length(glm::cross(segment_direction(axis, 0), tangent_at(parent, axis.attach)));
    const double away = kClearance * r - parent_radius, farthest = kFarthestRadii * parent_radius;
    const double steep = away <= 0 ? 0.0 : away < farthest * sine ? away / sine : farthest;
    return std::max({0.0, kSupportPerRadius * r - parent_radius, steep});
  }

  /// delta goes by the parent's tangent, which is too much where the parent bends away: a lateral that would not even touch it starts
  /// where it is clear of the parent's axis itself. Changes delta to that.
  AxisPlace start_of(const Axis& axis, const std::vector<double>& lengths, double& delta) const {
    const Axis& parent = axes_[axis.parent];
    const double clear = kClearance * axis.nodes[0].radius - radius_at(parent, axis.attach);
    AxisPlace place, near;
    const auto distance_at = [&](double length) {
      place = place_at_length(lengths, length);
      near = walk_to_nearest(parent, axis.attach, position_at(axis, place));
      return glm::distance(position_at(parent, near), position_at(axis, place));
    };
    if (distance_at(delta) <= radius_at(parent, near) + radius_at(axis, place)) return place;
    double lo = 0, hi = delta;
    for (int step = 0; step < 40; ++step) {
      delta = 0.5 * (lo + hi);
      (distance_at(delta) < clear ? lo : hi) = delta;
    }
    return place;
  }

  /// The axis from delta on; no nodes if it is shorter.
  Body body_of(std::size_t i) const {
    const Axis& axis = axes_[i];
    double delta = delta_of(axis);
    Body body;
    body.begin = delta;
    body.nodes.reserve(axis.nodes.size());
    if (delta > 0) {
      const std::vector<double> lengths = lengths_along(axis);
      if (delta >= lengths.back()) return body;
      const AxisPlace place = start_of(axis, lengths, delta);
      body.begin = delta;
      body.segment = place.segment;
      body.nodes.push_back({position_at(axis, place), radius_at(axis, place)});
      if (lengths[place.segment + 1] - delta <= 1e-9 * axis.nodes[0].radius) body.nodes.clear();
    } else {
      body.nodes.push_back({axis.nodes[0].position, axis.nodes[0].radius});
    }
    for (std::size_t k = body.segment + 1; k < axis.nodes.size(); ++k)
      body.nodes.push_back({axis.nodes[k].position, axis.nodes[k].radius});
    return body;
  }

  /// What is left of an axis shorter than delta: its tip, so thin that its support stays off the parent's far side.
  Body stub_of(std::size_t i) {
    const Axis& axis = axes_[i];
    const double length = length_of(axis), parent_radius = radius_at(axes_[axis.parent], axis.attach);
    Body body;
    body.begin = length;
    body.segment = axis.nodes.size() < 2 ? 0 : axis.nodes.size() - 2;
    const double radius = std::min(axis.nodes.back().radius, kRadiusPerSupport * (parent_radius + length));
    body.nodes.push_back({axis.nodes.back().position, radius});
    ++stubs_;
    return body;
  }

  bool protrudes(std::size_t i) const {
    const Axis &axis = axes_[i], &parent = axes_[axis.parent];
    const AxisNode& tip = axis.nodes.back();
    const AxisPlace near = walk_to_nearest(parent, axis.attach, tip.position);
    return glm::distance(position_at(parent, near), tip.position) + tip.radius > radius_at(parent, near);
  }

  NodeId add_chain(std::size_t i, std::vector<ChainNode> nodes, double along, const Vec3& u) {
    const bool is_base = i == 0 && options_.base;
    const NodeId id = is_base ? builder_.add(flared(std::move(nodes), *options_.base, ground(), options_.seed)) : builder_.add(Chain{std::move(nodes)});
    builder_.set_attributes(id, {axes_[i].branch, axes_[i].order, frames_[i].v + along, u});
    return id;
  }

  NodeId add_body(std::size_t i, Body body) {
    const Axis& axis = axes_[i];
    const ScarRange scars = scars_of(scars_, i);
    const bool split_or_scarred = axis.cut || !scars.empty() || body.segment > 0;
    const std::vector<Vec3> u = split_or_scarred ? directions_along(axis, frames_[i].u) : std::vector<Vec3>{frames_[i].u};
    const NodeId wood = axis.cut ? add_cut_chain(i, std::move(body), u)
                                 : add_chain(i, std::move(body.nodes), body.begin, u[std::min(body.segment, u.size() - 1)]);
    if (scars.empty()) return wood;
    std::vector<NodeId> children{wood};
    const std::vector<double> lengths = lengths_along(axis);
    for (auto scar = scars.first; scar != scars.last; ++scar) {
      const std::size_t segment = std::min<std::size_t>(scar->place.segment, u.size() - 1);
      const ScarPrimitives made = scar_primitives(*scar, position_at(axis, scar->place), segment_direction(axis, segment),
                                                  u[segment], radius_at(axis, scar->place));
      const double length = segment + 1 < lengths.size() ? lengths[segment + 1] - lengths[segment] : 0;
      const double v = frames_[i].v + lengths[segment] + scar->place.t * length;
      for (const Capsule& capsule : {made.stub, made.dent}) {
        children.push_back(builder_.add(capsule));
        builder_.set_attributes(children.back(), {axis.branch, axis.order, v, Vec3(0.0)});
      }
    }
    return builder_.add(Sum{std::move(children)});
  }

  /// Only the end of an axis is cut where an earlier part of it, bent round, reaches through the same plane.
  NodeId add_cut_chain(std::size_t i, Body body, const std::vector<Vec3>& u) {
    const Axis& axis = axes_[i];
    const AxisCut& cut = *axis.cut;
    const HalfSpace half_space = half_space_of(cut, axis.nodes.back().radius);
    std::vector<double> along{body.begin};
    for (std::size_t k = 1; k < body.nodes.size(); ++k)
      along.push_back(along.back() + glm::distance(body.nodes[k - 1].position, body.nodes[k].position));
    const double guard = 2 * glm::distance(axis.nodes.back().position, cut.point) + 3 * axis.nodes.back().radius;
    std::size_t split = 0, crossing = 0;
    for (std::size_t k = 0; k + 1 < body.nodes.size() && along[k] < cut.along - guard; ++k) {
      split = k;
      const ChainNode& node = body.nodes[k];
      if (glm::dot(node.position - cut.point, cut.normal) + kSupportPerRadius * node.radius > 0) ++crossing;
    }
    if (crossing == 0 || split == 0) {
      const NodeId chain = add_chain(i, std::move(body.nodes), body.begin, u[std::min(body.segment, u.size() - 1)]);
      const NodeId plane = builder_.add(half_space);
      return builder_.add(Intersection{{chain, plane}});
    }
    // A chain is the union of its parts, so taking it apart changes nothing but what the plane meets.
    std::vector<ChainNode> end(body.nodes.begin() + static_cast<std::ptrdiff_t>(split), body.nodes.end());
    body.nodes.resize(split + 1);
    const NodeId lower = add_chain(i, std::move(body.nodes), body.begin, u[std::min(body.segment, u.size() - 1)]);
    const NodeId upper = add_chain(i, std::move(end), along[split], u[std::min(body.segment + split, u.size() - 1)]);
    const NodeId plane = builder_.add(half_space);
    const NodeId cut_end = builder_.add(Intersection{{upper, plane}});
    return builder_.add(Union{{lower, cut_end}});
  }

  const std::vector<Axis>& axes_;
  const std::vector<AxisFrame>& frames_;
  const SurfaceOptions& options_;
  const std::vector<PlacedScar>& scars_;
  BlobTreeBuilder& builder_;
  SurfaceReport& report_;
  Laterals laterals_;
  std::vector<NodeId> built_;
  std::size_t stubs_ = 0, buried_ = 0;
};

}  // namespace

NodeId build_chain_profile(const AxisTree& tree, const std::vector<AxisFrame>& frames, const SurfaceOptions& options,
                           const std::vector<PlacedScar>& scars, BlobTreeBuilder& builder, SurfaceReport& report) {
  return ChainProfile(tree, frames, options, scars, builder, report).build();
}

HalfSpace half_space_of(const AxisCut& cut, double radius) { return {cut.point, cut.normal, kCutWidth * radius}; }

ScarRange scars_of(const std::vector<PlacedScar>& scars, std::size_t axis) {
  const auto before = [](const PlacedScar& scar, std::size_t index) { return scar.axis < index; };
  const auto first = std::lower_bound(scars.begin(), scars.end(), axis, before);
  return {first, std::lower_bound(first, scars.end(), axis + 1, before)};
}

}  // namespace cambium
