#include "skeletons/profiles.h"

#include "skeletons/axis_shaping.h"
#include "skeletons/conditioning.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace cambium {
namespace {

constexpr double kOneChild = 1.75;       // paper, equation 3
constexpr double kSeveral = 2.75;        // paper, equation 7
constexpr double kShortest = 1e-3;       // of the tip radius: what is left of an internode shorter than its deltas

class GalbraithProfile {
 public:
  GalbraithProfile(const AxisTree& tree, const std::vector<AxisFrame>& frames, const SurfaceOptions& options,
                   const std::vector<PlacedScar>& scars, BlobTreeBuilder& builder, SurfaceReport& report)
      : axes_(tree.axes), frames_(frames), options_(options), scars_(scars), builder_(builder), report_(report) {}

  NodeId build() {
    find_bearers();
    built_.resize(axes_.size());
    std::vector<NodeId> roots;
    for (std::size_t i = axes_.size(); i-- > 0;) build_axis(i, roots);
    std::reverse(roots.begin(), roots.end());
    if (shortened_ > 0)
      report_.notes.push_back(std::to_string(shortened_) + " internodes are shorter than their deltas and became stubs.");
    if (straightened_ > 0)
      report_.notes.push_back(std::to_string(straightened_) + " internodes are too thick for their bend and were bent less.");
    return roots.size() == 1 ? roots[0] : builder_.add(Sum{std::move(roots)});
  }

 private:
  /// The axis and node that really bear an axis; a lateral at the first node of a lateral stands where that one stands.
  struct Bearer { std::int32_t axis = -1; std::size_t node = 0; };
  struct Child { std::size_t axis, node; };  // the internode that ends at that node

  void find_bearers() {
    bearers_.resize(axes_.size());
    first_borne_.assign(axes_.size() + 1, 0);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const Axis& axis = axes_[i];
      if (axis.parent < 0) continue;
      Bearer bearer{axis.parent, axis.attach.segment + (axis.attach.t >= 0.5 ? 1u : 0u)};
      bearer.node = std::min(bearer.node, axes_[bearer.axis].nodes.size() - 1);
      if (bearer.node == 0 && axes_[bearer.axis].parent >= 0) bearer = bearers_[bearer.axis];
      bearers_[i] = bearer;
      if (axis.nodes.size() > 1) ++first_borne_[bearer.axis + 1];
    }
    for (std::size_t i = 1; i < first_borne_.size(); ++i) first_borne_[i] += first_borne_[i - 1];
    borne_.resize(first_borne_.back());
    std::vector<std::uint32_t> next(first_borne_.begin(), first_borne_.end() - 1);
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (axes_[i].parent >= 0 && axes_[i].nodes.size() > 1)
        borne_[next[bearers_[i].axis]++] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i < axes_.size(); ++i)
      std::sort(borne_.begin() + first_borne_[i], borne_.begin() + first_borne_[i + 1],
                [&](std::uint32_t a, std::uint32_t b) {
                  return bearers_[a].node != bearers_[b].node ? bearers_[a].node < bearers_[b].node : a < b;
                });
  }

  void build_axis(std::size_t i, std::vector<NodeId>& roots) {
    const Axis& axis = axes_[i];
    const std::size_t count = axis.nodes.size();
    if (count < 2 && axis.parent >= 0) return;
    std::span<const std::uint32_t> borne = borne_by(i);  // those that stand on nodes not yet passed
    const std::vector<double> lengths = lengths_along(axis);
    const std::vector<Vec3> u = directions_along(axis, frames_[i].u);
    const ScarRange scars = scars_of(scars_, i);
    auto scar_end = scars.last;
    const std::size_t basal = siblings_at_base(i);

    std::vector<Child> children;
    std::vector<NodeId> fields;
    NodeId subtree = 0;
    bool continues = false;
    for (std::size_t node = count; node-- > 0;) {
      children.clear();
      fields.clear();
      if (continues) children.push_back({i, node + 1}), fields.push_back(subtree);
      const std::size_t first = fields.size();
      for (; !borne.empty() && bearers_[borne.back()].node == node; borne = borne.first(borne.size() - 1))
        children.push_back({borne.back(), 1}), fields.push_back(built_[borne.back()]);
      std::reverse(children.begin() + static_cast<std::ptrdiff_t>(first), children.end());
      std::reverse(fields.begin() + static_cast<std::ptrdiff_t>(first), fields.end());
      if (node == 0) break;
      auto scar_begin = scar_end;
      while (scar_begin != scars.first && std::prev(scar_begin)->place.segment + 1 >= node) --scar_begin;
      const std::size_t siblings = node == 1 ? basal : siblings_at(i, node - 1);
      subtree = join(add_internode(i, node, siblings, children, lengths[node - 1], u[node - 1], {scar_begin, scar_end}),
                     fields);
      scar_end = scar_begin;
      continues = true;
    }
    built_[i] = subtree;
    if (axis.parent >= 0) return;
    if (count < 2) {  // a single node
      fields.insert(fields.begin(), builder_.add(Sphere{axis.nodes[0].position, axis.nodes[0].radius}));
      builder_.set_attributes(fields[0], {axis.branch, axis.order, 0, frames_[i].u});
    }
    roots.push_back(together(fields));
  }

  std::span<const std::uint32_t> borne_by(std::size_t i) const {
    return {borne_.data() + first_borne_[i], first_borne_[i + 1] - first_borne_[i]};
  }

  /// Internodes that leave the node where this axis begins.
  std::size_t siblings_at_base(std::size_t i) const {
    if (axes_[i].parent < 0) return borne_at(i, 0) + 1;
    const Bearer& bearer = bearers_[i];
    const std::size_t bearer_count = axes_[bearer.axis].nodes.size();
    return borne_at(static_cast<std::size_t>(bearer.axis), bearer.node) + (bearer.node + 1 < bearer_count ? 1 : 0);
  }
  std::size_t siblings_at(std::size_t i, std::size_t node) const { return borne_at(i, node) + 1; }

  std::size_t borne_at(std::size_t i, std::size_t node) const {
    const std::span<const std::uint32_t> borne = borne_by(i);
    const auto first = std::partition_point(borne.begin(), borne.end(), [&](auto k) { return bearers_[k].node < node; });
    const auto last = std::partition_point(first, borne.end(), [&](auto k) { return bearers_[k].node <= node; });
    return static_cast<std::size_t>(last - first);
  }

  NodeId together(const std::vector<NodeId>& fields) {
    if (fields.size() == 1) return fields[0];
    return options_.ridges ? builder_.add(Contact{fields, options_.width, options_.lip}) : builder_.add(Sum{fields});
  }

  /// T(A) from the field of A and those of what it bears.
  NodeId join(NodeId internode, const std::vector<NodeId>& fields) {
    if (fields.empty()) return internode;
    std::vector<NodeId> children{internode};
    if (options_.ridges) {
      children.push_back(together(fields));
    } else {
      children.insert(children.end(), fields.begin(), fields.end());
    }
    return builder_.add(Sum{std::move(children)});
  }

  Vec3 base_of(std::size_t i, std::size_t node) const {
    if (node > 1 || axes_[i].parent < 0) return axes_[i].nodes[node - 1].position;
    return axes_[bearers_[i].axis].nodes[bearers_[i].node].position;
  }

  double base_radius(std::size_t i, std::size_t node) const {
    const double base = axes_[i].nodes[node].base_radius;
    return base > 0 ? base : axes_[i].nodes[node - 1].radius;
  }

  double delta_base(std::size_t i, std::size_t node, std::size_t siblings) const {
    if (siblings < 2) return 0;
    const bool lateral = node == 1 && axes_[i].parent >= 0;
    const double basal_radius = lateral ? axes_[bearers_[i].axis].nodes[bearers_[i].node].radius : axes_[i].nodes[node - 1].radius;
    return std::max(0.0, basal_radius - base_radius(i, node));
  }

  double delta_tip(double radius, const std::vector<Child>& children) const {
    if (children.empty()) return 0;
    if (children.size() == 1) return kOneChild * axes_[children[0].axis].nodes[children[0].node].radius;
    double thickest = 0;
    for (const Child& child : children) thickest = std::max(thickest, base_radius(child.axis, child.node));
    return kSeveral * thickest - radius;
  }

  /// Direction of the internode that bears this one; zero at a root.
  Vec3 basal_direction(std::size_t i, std::size_t node) const {
    if (node > 1) return direction_of(i, node - 1);
    if (axes_[i].parent < 0) return Vec3(0.0);
    const Bearer& bearer = bearers_[i];
    return bearer.node > 0 ? direction_of(static_cast<std::size_t>(bearer.axis), bearer.node) : Vec3(0.0);
  }
  Vec3 direction_of(std::size_t i, std::size_t node) const {
    const Vec3 d = axes_[i].nodes[node].position - base_of(i, node);
    const double length = glm::length(d);
    return length > 0 ? d / length : segment_direction(axes_[i], node - 1);
  }

  NodeId add_internode(std::size_t i, std::size_t node, std::size_t siblings, const std::vector<Child>& children,
                       double along, const Vec3& u_direction, const ScarRange& scars) {
    const Axis& axis = axes_[i];
    const double radius_base = base_radius(i, node), radius_tip = axis.nodes[node].radius;
    const Vec3 base = base_of(i, node), tip = axis.nodes[node].position, direction = direction_of(i, node);
    double length = glm::distance(base, tip);
    const bool is_cut = axis.cut && node + 1 == axis.nodes.size();
    const Bend bend = is_cut ? Bend{} : bend_of(i, node, base, tip, direction, length, scars);
    if (bend.angle > 0) length = length / (2 * std::sin(0.5 * bend.angle)) * bend.angle;

    const double begin = std::min(delta_base(i, node, siblings), length);
    double end = length - delta_tip(radius_tip, children);
    if (!(end > begin)) ++shortened_;
    end = std::max(end, begin + kShortest * std::max(radius_tip, radius_base));
    const NodeId cone = builder_.add(Cone{base + begin * direction, base + end * direction, radius_base, radius_tip});
    const double v = frames_[i].v + along;
    builder_.set_attributes(cone, {axis.branch, axis.order, v + begin, u_direction});

    NodeId made = cone;
    if (!scars.empty()) made = add_scars(i, cone, scars, base, direction, length, v, u_direction);
    if (is_cut) {
      const NodeId plane = builder_.add(half_space_of(*axis.cut, radius_tip));
      made = builder_.add(Intersection{{made, plane}});
    }
    if (bend.angle > 0) {
      Bend wrapped = bend;
      wrapped.child = made;
      made = builder_.add(wrapped);
    }
    return made;
  }

  NodeId add_scars(std::size_t i, NodeId cone, const ScarRange& scars, const Vec3& base, const Vec3& direction,
                   double length, double v, const Vec3& u) {
    std::vector<NodeId> children{cone};
    for (auto scar = scars.first; scar != scars.last; ++scar) {
      const double along = scar->place.t * length;
      const ScarPrimitives made = scar_primitives(*scar, base + along * direction, direction, across(direction, u),
                                                  radius_at(axes_[i], scar->place));
      for (const Capsule& capsule : {made.stub, made.dent}) {
        children.push_back(builder_.add(capsule));
        builder_.set_attributes(children.back(), {axes_[i].branch, axes_[i].order, v + along, Vec3(0.0)});
      }
    }
    return builder_.add(Sum{std::move(children)});
  }

  /// The bend of an internode, with a smaller angle where the support would reach the arc's centre.
  Bend bend_of(std::size_t i, std::size_t node, const Vec3& base, const Vec3& tip, const Vec3& direction, double length,
               const ScarRange& scars) {
    const double angle = bend_of_order(options_.bend, axes_[i].order);
    const Vec3 before = basal_direction(i, node);
    if (angle == 0 || before == Vec3(0.0) || !(length > 0)) return {};
    BendPlan plan = plan_bend(before, direction, angle);
    if (!(plan.angle > 0)) return {};
    const double rb = base_radius(i, node), rt = axes_[i].nodes[node].radius;
    double support = kSupportPerRadius * std::min(rb, rt) + std::abs(rb - rt);
    if (!scars.empty()) support = std::max(support, 2.3 * std::max(rb, rt));
    const double largest_sine = length / (2 * 1.2 * support);  // keeps 20 % between the support and the centre
    if (largest_sine < 1 && 2 * std::asin(largest_sine) < plan.angle) {
      plan.angle = 2 * std::asin(largest_sine);
      ++straightened_;
    }
    return {base, tip, plan.direction, plan.angle, 0};
  }

  const std::vector<Axis>& axes_;
  const std::vector<AxisFrame>& frames_;
  const SurfaceOptions& options_;
  const std::vector<PlacedScar>& scars_;
  BlobTreeBuilder& builder_;
  SurfaceReport& report_;
  std::vector<Bearer> bearers_;
  std::vector<std::uint32_t> first_borne_, borne_;  // by axis, ascending nodes
  std::vector<NodeId> built_;
  std::size_t shortened_ = 0, straightened_ = 0;
};

}  // namespace

NodeId build_galbraith_profile(const AxisTree& tree, const std::vector<AxisFrame>& frames, const SurfaceOptions& options,
                               const std::vector<PlacedScar>& scars, BlobTreeBuilder& builder, SurfaceReport& report) {
  return GalbraithProfile(tree, frames, options, scars, builder, report).build();
}

}  // namespace cambium
