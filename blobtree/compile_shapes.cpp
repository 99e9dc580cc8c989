#include "blobtree/compile_shapes.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <type_traits>
#include <utility>

namespace cambium {
namespace {

Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
  const double length = glm::length(v);
  return length > 0 ? v / length : fallback;
}

SweptSegment<double> swept_segment(const ChainNode& from, const ChainNode& to, const Vec3& last_axis) {
  const Vec3 d = to.position - from.position;
  const double length = glm::length(d);
  if (!(length > 0)) return {from.position, last_axis, 0, 0, std::max(from.radius, to.radius), 0};  // the thicker ball
  return {from.position, d / length, 0, length, from.radius, (to.radius - from.radius) / length};
}

class ShapeCompiler {
 public:
  ShapeCompiler(CompiledTree& tree, CompiledNode& compiled) : tree_(tree), compiled_(compiled) {}

  ShapeOfNode operator()(const Cone& c) {
    const bool swap = c.radius_tip > c.radius_base;
    const Vec3 base = swap ? c.tip : c.base, tip = swap ? c.base : c.tip;
    const double rb = swap ? c.radius_tip : c.radius_base, rt = swap ? c.radius_base : c.radius_tip;
    const double height = glm::length(tip - base);
    const Vec3 axis = unit_or(tip - base, {0, 0, 1});
    if (!(height > 0)) return primitive(PointSkeleton<double>{base}, rt, c.strength, axis);
    if (rb == rt) return primitive(SegmentSkeleton<double>{base, axis, 0, height}, rt, c.strength, axis);
    return primitive(ConeSkeleton<double>{base, axis, height, rb - rt}, rt, c.strength, axis);
  }
  ShapeOfNode operator()(const RoundCone& c) { return chain({{c.base, c.radius_base}, {c.tip, c.radius_tip}}, c.strength); }
  ShapeOfNode operator()(const Chain& c) { return chain(c.nodes, c.strength); }
  ShapeOfNode operator()(const Sphere& s) {
    return primitive(PointSkeleton<double>{s.center}, s.radius, s.strength, {0, 0, 1});
  }
  ShapeOfNode operator()(const Capsule& c) {
    const double length = glm::length(c.b - c.a);
    const Vec3 axis = unit_or(c.b - c.a, {0, 0, 1});
    return primitive(SegmentSkeleton<double>{c.a, axis, 0, length}, c.radius, c.strength, axis);
  }
  ShapeOfNode operator()(const Disc& d) {
    const Vec3 normal = glm::normalize(d.normal);
    return primitive(DiscSkeleton<double>{d.center, normal, d.disc_radius}, d.radius, d.strength, normal);
  }
  ShapeOfNode operator()(const Torus& t) {
    const Vec3 normal = glm::normalize(t.normal);
    return primitive(CircleSkeleton<double>{t.center, normal, t.ring_radius}, t.radius, t.strength, normal);
  }
  ShapeOfNode operator()(const RotatedBox& b) {
    const glm::dquat q = glm::normalize(glm::dquat(b.rotation[0], b.rotation[1], b.rotation[2], b.rotation[3]));
    const Mat3 axes = glm::mat3_cast(q);
    return primitive(BoxSkeleton<double>{b.center, b.half_size, axes}, b.radius, b.strength, axes[2]);
  }
  ShapeOfNode operator()(const HalfSpace& h) {
    set(Op::kHalfSpace, tree_.half_spaces.size());
    tree_.half_spaces.push_back({h.point, glm::normalize(h.normal), h.width});
    return {};
  }
  ShapeOfNode operator()(const Sum&) { return set(Op::kSum, 0); }
  ShapeOfNode operator()(const Union&) { return set(Op::kUnion, 0); }
  ShapeOfNode operator()(const Intersection&) { return set(Op::kIntersection, 0); }
  ShapeOfNode operator()(const Difference&) { return set(Op::kDifference, 0); }
  ShapeOfNode operator()(const Ricci& r) { return number(Op::kRicci, r.exponent); }
  ShapeOfNode operator()(const Contact& c) {
    set(Op::kContact, tree_.blends.size());
    tree_.blends.push_back({c.width, c.lip, {}});
    return {};
  }
  ShapeOfNode operator()(const Fork& f) {
    set(Op::kFork, tree_.blends.size());
    tree_.blends.push_back({f.width, f.lip, f.laterals});
    for (Lateral& lateral : tree_.blends.back().laterals) lateral.direction = glm::normalize(lateral.direction);
    return {};
  }
  ShapeOfNode operator()(const ScaleField& s) { return number(Op::kScale, s.factor); }
  ShapeOfNode operator()(const Transform& t) { return warp(rigid_warp(t)); }
  ShapeOfNode operator()(const Bend& b) { return warp(bend_warp(b)); }
  ShapeOfNode operator()(const Twist& t) { return warp(twist_warp(t)); }
  ShapeOfNode operator()(const Taper& t) { return warp(taper_warp(t)); }

 private:
  ShapeOfNode set(Op op, std::size_t payload) {
    compiled_.op = op;
    compiled_.payload = static_cast<std::uint32_t>(payload);
    return {};
  }
  ShapeOfNode number(Op op, double value) {
    set(op, tree_.numbers.size());
    tree_.numbers.push_back(value);
    return {};
  }
  ShapeOfNode warp(Warp w) {
    set(Op::kWarp, tree_.warps.size());
    tree_.warps.push_back(std::move(w));
    return {};
  }
  ShapeOfNode primitive(SkeletonShape<double> shape, double radius, double strength, const Vec3& axis) {
    set(Op::kPrimitive, tree_.primitives.size());
    tree_.primitives.push_back({std::move(shape), 1 / (kSupportPerRadius * radius), strength});
    return {0, 0, radius, axis};
  }
  ShapeOfNode chain(const std::vector<ChainNode>& nodes, double strength) {
    set(Op::kChain, tree_.chain_strengths.size());
    tree_.chain_strengths.push_back(strength);
    const auto first = static_cast<std::uint32_t>(tree_.segments.size());
    Vec3 axis(0, 0, 1);
    if (nodes.size() == 1) tree_.segments.push_back({nodes[0].position, axis, 0, 0, nodes[0].radius, 0});
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      tree_.segments.push_back(swept_segment(nodes[i - 1], nodes[i], axis));
      axis = tree_.segments.back().axis;
    }
    return {first, static_cast<std::uint32_t>(tree_.segments.size()) - first, kInfinity, axis};
  }

  CompiledTree& tree_;
  CompiledNode& compiled_;
};

double across(const Vec3& axis, const Vec3& direction) {
  const double c = glm::dot(axis, direction);
  return std::sqrt(std::max(0.0, 1 - c * c));
}
Interval around(double center, double reach) { return {center - reach, center + reach}; }
Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

Interval along(const PointSkeleton<double>& k, const Vec3& d) { return around(glm::dot(k.center, d), 0); }
Interval along(const SegmentSkeleton<double>& k, const Vec3& d) {
  return hull(around(glm::dot(k.a + k.begin * k.axis, d), 0), around(glm::dot(k.a + k.end * k.axis, d), 0));
}
Interval along(const ConeSkeleton<double>& k, const Vec3& d) {
  return hull(around(glm::dot(k.base, d), k.disc_radius * across(k.axis, d)), around(glm::dot(k.base + k.height * k.axis, d), 0));
}
Interval along(const DiscSkeleton<double>& k, const Vec3& d) {
  return around(glm::dot(k.center, d), k.disc_radius * across(k.normal, d));
}
Interval along(const CircleSkeleton<double>& k, const Vec3& d) {
  return around(glm::dot(k.center, d), k.ring_radius * across(k.normal, d));
}
Interval along(const BoxSkeleton<double>& k, const Vec3& d) {
  return around(glm::dot(k.center, d), glm::dot(k.half_size, glm::abs(d * k.world_from_box)));
}

}  // namespace

ShapeOfNode compile_shape(CompiledTree& tree, CompiledNode& compiled, const Node& node) {
  return std::visit(ShapeCompiler(tree, compiled), node);
}

Interval support_along(const CompiledTree& tree, const Atom& atom, const Vec3& direction) {
  const CompiledNode& node = tree.nodes[atom.node];
  Interval bound;
  if (node.op == Op::kChain) {
    const SweptSegment<double>& s = tree.segments[atom.segment];
    bound = hull(around(glm::dot(s.a + s.begin * s.axis, direction), kSupportPerRadius * s.radius_at(s.begin)),
                 around(glm::dot(s.a + s.end * s.axis, direction), kSupportPerRadius * s.radius_at(s.end)));
  } else if (node.op == Op::kHalfSpace) {
    return {-kInfinity, kInfinity};
  } else {
    const CompiledPrimitive& p = tree.primitives[node.payload];
    const Interval core = std::visit([&](const auto& shape) { return along(shape, direction); }, p.shape);
    bound = {core.lo - 1 / p.inverse_support, core.hi + 1 / p.inverse_support};
  }
  const double slack = 1e-12 * (std::abs(bound.lo) + std::abs(bound.hi)) + 1e-9 * (bound.hi - bound.lo);
  return {bound.lo - slack, bound.hi + slack};
}

}  // namespace cambium
