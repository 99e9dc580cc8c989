#include "blobtree/compile_shapes.h"

#include "blobtree/interval_arithmetic.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <utility>

namespace cambium {
namespace {

Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
  const double length = glm::length(v);
  return length > 0 ? v / length : fallback;
}

class ShapeCompiler {
 public:
  ShapeCompiler(CompiledTree& tree, CompiledNode& compiled) : tree_(tree), compiled_(compiled) {}

  void operator()(const Cone& c) {
    const bool swap = c.radius_tip > c.radius_base;
    const Vec3 base = swap ? c.tip : c.base, tip = swap ? c.base : c.tip;
    const double rb = swap ? c.radius_tip : c.radius_base, rt = swap ? c.radius_base : c.radius_tip;
    const double height = glm::length(tip - base);
    const Vec3 axis = unit_or(tip - base, {0, 0, 1});
    if (!(height > 0)) {
      primitive(PointSkeleton<double>{base}, rt, c.strength);
    } else if (rb == rt) {
      primitive(SegmentSkeleton<double>{base, axis, 0, height}, rt, c.strength);
    } else {
      primitive(ConeSkeleton<double>{base, axis, height, rb - rt}, rt, c.strength);
    }
  }
  void operator()(const RoundCone& c) { const ChainNode ends[] = {{c.base, c.radius_base}, {c.tip, c.radius_tip}};
    chain(ends, c.strength); }
  void operator()(const Chain& c) { chain(c.nodes, c.strength); }
  void operator()(const Flare& f) {
    chain(f.nodes, f.strength);
    compiled_.op = Op::kFlare;
    tree_.chains.back().flare = static_cast<std::uint32_t>(tree_.flares.size());
    tree_.flares.emplace_back(f);
  }
  void operator()(const Sphere& s) {
    primitive(PointSkeleton<double>{s.center}, s.radius, s.strength);
  }
  void operator()(const Capsule& c) {
    const double length = glm::length(c.b - c.a);
    const Vec3 axis = unit_or(c.b - c.a, {0, 0, 1});
    primitive(SegmentSkeleton<double>{c.a, axis, 0, length}, c.radius, c.strength);
  }
  void operator()(const Disc& d) {
    const Vec3 normal = glm::normalize(d.normal);
    primitive(DiscSkeleton<double>{d.center, normal, d.disc_radius}, d.radius, d.strength);
  }
  void operator()(const Torus& t) {
    const Vec3 normal = glm::normalize(t.normal);
    primitive(CircleSkeleton<double>{t.center, normal, t.ring_radius}, t.radius, t.strength);
  }
  void operator()(const RotatedBox& b) {
    const glm::dquat q = glm::normalize(glm::dquat(b.rotation[0], b.rotation[1], b.rotation[2], b.rotation[3]));
    const Mat3 axes = glm::mat3_cast(q);
    primitive(BoxSkeleton<double>{b.center, b.half_size, axes}, b.radius, b.strength);
  }
  void operator()(const HalfSpace& h) {
    set(Op::kHalfSpace, tree_.half_spaces.size());
    tree_.half_spaces.push_back({h.point, glm::normalize(h.normal), h.width});
  }
  void operator()(const Sum&) { set(Op::kSum, 0); }
  void operator()(const Union&) { set(Op::kUnion, 0); }
  void operator()(const Intersection&) { set(Op::kIntersection, 0); }
  void operator()(const Difference&) { set(Op::kDifference, 0); }
  void operator()(const Ricci& r) { number(Op::kRicci, r.exponent); }
  void operator()(const Contact& c) {
    set(Op::kContact, tree_.blends.size());
    tree_.blends.push_back({c.width, c.lip, 0});
  }
  void operator()(const Fork& f) {
    set(Op::kFork, tree_.blends.size());
    tree_.blends.push_back({f.width, f.lip, static_cast<std::uint32_t>(tree_.laterals.size())});
    for (Lateral lateral : f.laterals) {
      lateral.direction = glm::normalize(lateral.direction);
      tree_.laterals.push_back(lateral);
    }
  }
  void operator()(const ScaleField& s) { number(Op::kScale, s.factor); }
  void operator()(const Transform& t) { warp(rigid_warp(t)); }
  void operator()(const Bend& b) { warp(bend_warp(b)); }
  void operator()(const Twist& t) { warp(twist_warp(t)); }
  void operator()(const Taper& t) { warp(taper_warp(t)); }

 private:
  void set(Op op, std::size_t payload) {
    compiled_.op = op;
    compiled_.payload = static_cast<std::uint32_t>(payload);
  }
  void number(Op op, double value) {
    set(op, tree_.numbers.size());
    tree_.numbers.push_back(value);
  }
  void warp(Warp w) {
    set(Op::kWarp, tree_.warps.size());
    tree_.warps.push_back({std::move(w), {}});
  }
  void primitive(SkeletonShape<double> shape, double radius, double strength) {
    set(Op::kPrimitive, tree_.primitives.size());
    tree_.primitives.add({std::move(shape), radius, strength});
  }
  void chain(std::span<const ChainNode> nodes, double strength) {
    set(Op::kChain, tree_.chains.size());
    const auto first = static_cast<std::uint32_t>(tree_.chain_nodes.size());
    tree_.chain_nodes.insert(tree_.chain_nodes.end(), nodes.begin(), nodes.end());
    if (nodes.size() == 1) tree_.chain_nodes.push_back(nodes[0]);
    tree_.chains.push_back({strength, first, static_cast<std::uint32_t>(tree_.chain_nodes.size()) - first});
  }

  CompiledTree& tree_;
  CompiledNode& compiled_;
};

double across(const Vec3& axis, const Vec3& direction) {
  const double c = glm::dot(axis, direction);
  return std::sqrt(std::max(0.0, 1 - c * c));
}
Interval around(double center, double reach) { return {center - reach, center + reach}; }

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

void compile_shape(CompiledTree& tree, CompiledNode& compiled, const Node& node) {
  std::visit(ShapeCompiler(tree, compiled), node);
}

Interval support_along(const CompiledTree& tree, std::uint32_t atom, const Vec3& direction) {
  const CompiledNode& node = tree.node_of(atom);
  Interval bound;
  if (is_swept(node.op)) {
    const ChainNode* const ends = tree.segment_ends(node, atom);
    const ChainNode &a = ends[0], &b = ends[1];
    const double per_radius = kSupportPerRadius * tree.reach_of(node, atom);
    bound = hull(around(glm::dot(a.position, direction), per_radius * a.radius),
                 around(glm::dot(b.position, direction), per_radius * b.radius));
  } else if (node.op == Op::kHalfSpace) {
    return {-kInfinity, kInfinity};
  } else {
    const CompiledPrimitive p = tree.primitive_of(node);
    const Interval core = std::visit([&](const auto& shape) { return along(shape, direction); }, p.shape);
    bound = {core.lo - 1 / p.inverse_support, core.hi + 1 / p.inverse_support};
  }
  const double slack = 1e-12 * (std::abs(bound.lo) + std::abs(bound.hi)) + 1e-9 * (bound.hi - bound.lo);
  return {bound.lo - slack, bound.hi + slack};
}

Box own_box(const CompiledTree& tree, std::uint32_t atom) {
  const CompiledNode& node = tree.node_of(atom);
  if (is_swept(node.op)) return tree.segment_support(node, atom);
  Box box;
  for (int k = 0; k < 3; ++k) {
    Vec3 d(0.0);
    d[k] = 1;
    const Interval i = support_along(tree, atom, d);
    box.lo[k] = i.lo;
    box.hi[k] = i.hi;
  }
  return box;
}

}  // namespace cambium
