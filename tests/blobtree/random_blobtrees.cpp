#include "random_blobtrees.h"

#include <cmath>
#include <numbers>

namespace cambium {
namespace {

const Box kPlace{Vec3(-1), Vec3(1)};

}  // namespace

NodeId BlobTreeGrower::any(int depth) {
  if (depth <= 0 || draws_.chance(0.15)) return primitive(draws_.below(kPrimitives));
  return op(draws_.below(kOperators), depth);
}

NodeId BlobTreeGrower::primitive(int kind) {
  if (flared_ && draws_.chance(0.5)) return flare();
  const double thinness = decades_ > 0 ? std::pow(10.0, -draws_.in(0, decades_)) : 1;
  const double r = thinness * draws_.in(0.1, 0.4);
  const double strength = draws_.chance(0.7) ? 1.0 : draws_.in(-1, 1.5);
  const Vec3 p = draws_.point(kPlace);
  switch (kind) {
    case 0: return add(Cone{p, draws_.point(kPlace), r, thinness * draws_.in(0.1, 0.4), strength});
    case 1: return add(RoundCone{p, draws_.point(kPlace), r, thinness * draws_.in(0.05, 0.4), strength});
    case 2: return add(chain(p, strength, thinness));
    case 3: return add(Sphere{p, r, strength});
    case 4: return add(Capsule{p, draws_.point(kPlace), r, strength});
    case 5: return add(Disc{p, 3.0 * draws_.direction(), draws_.in(0.1, 0.6), r, strength});
    case 6: return add(Torus{p, 0.2 * draws_.direction(), draws_.in(0.2, 0.8), r, strength});
    default: {
      const glm::dvec4 q{draws_.in(-1, 1), draws_.in(-1, 1), draws_.in(-1, 1), draws_.in(0.2, 1)};
      return add(RotatedBox{p, draws_.point({Vec3(0), Vec3(0.5)}), q, r, strength});
    }
  }
}

NodeId BlobTreeGrower::op(int kind, int depth) {
  switch (kind) {
    case 0: return add(Sum{several(depth)});
    case 1: return add(Union{several(depth)});
    case 2: return add(Intersection{{any(depth - 1), draws_.chance(0.5) ? half_space() : any(depth - 1)}});
    case 3: {
      std::vector<NodeId> children{any(depth - 1), draws_.chance(0.5) ? half_space() : any(depth - 1)};
      if (draws_.chance(0.3)) children.push_back(any(depth - 1));
      return add(Difference{std::move(children)});
    }
    case 4: return add(Ricci{several(depth), draws_.in(1, 6)});
    case 5: return add(Contact{several(depth), draws_.in(0.1, 0.5), draws_.in(0, 4)});
    case 6: return fork(depth);
    case 7: return add(ScaleField{draws_.in(-1.2, 1.5), any(depth - 1)});
    case 8: return transform(depth);
    case 9: return bend();
    case 10: return add(Twist{draws_.point(kPlace), 2.0 * draws_.direction(), draws_.in(-1.5, 1.5), any(depth - 1)});
    default: {
      const double h = draws_.in(-1, 0);
      return add(Taper{draws_.point(kPlace), draws_.direction(), h, draws_.in(0.5, 1.5), h + draws_.in(0.5, 2),
                       draws_.in(0.5, 1.5), any(depth - 1)});
    }
  }
}

Chain BlobTreeGrower::chain(Vec3 p, double strength, double thinness) {
  Chain c;
  c.strength = strength;
  for (int i = 0, n = 1 + draws_.below(6); i < n; ++i) {
    c.nodes.push_back({p, thinness * draws_.in(0.08, 0.3)});
    p += draws_.in(0.0, 0.6) * draws_.direction();
  }
  return c;
}

// Where it may be asked a flare's axis is its chain's first segment, as a trunk's is; else anywhere.
NodeId BlobTreeGrower::flare() {
  const double thinness = decades_ > 0 ? std::pow(10.0, -draws_.in(0, decades_)) : 1;
  const double strength = draws_.chance(0.7) ? 1.0 : draws_.in(-1, 1.5);
  Chain trunk = chain(draws_.point(kPlace), strength, thinness);
  Flare f;
  f.nodes = std::move(trunk.nodes);
  f.strength = strength;
  f.base = f.nodes.front().position;
  f.axis = 2.0 * draws_.direction();
  if (draws_.chance(0.7)) {
    if (f.nodes.size() > 1 && f.nodes[1].position != f.base) f.axis = f.nodes[1].position - f.base;
  } else {
    f.base += draws_.in(0, 0.4) * draws_.direction();
  }
  f.height = draws_.in(0.2, 1.2);
  f.spread = draws_.in(0, 0.8);
  f.sharpness = draws_.chance(0.2) ? 0.95 : draws_.in(0, 0.9);
  double angle = draws_.in(-4, 4);
  for (int i = 0, n = 1 + draws_.below(7); i < n; ++i) {
    f.prongs.push_back({angle, draws_.in(0, 1.3)});
    angle += draws_.in(0.3, 0.87);   // of seven, all in one turn
  }
  f.section = static_cast<FlareSection>(draws_.below(3));
  return add(std::move(f));
}

std::vector<NodeId> BlobTreeGrower::several(int depth) {
  std::vector<NodeId> children;
  for (int i = 0, n = 1 + draws_.below(4); i < n; ++i) children.push_back(any(depth - 1));
  return children;
}

NodeId BlobTreeGrower::half_space() {
  const NodeId half = add(HalfSpace{draws_.point({Vec3(-0.4), Vec3(0.4)}), 2.0 * draws_.direction(), draws_.in(0.02, 0.3)});
  return draws_.chance(0.8) ? half : add(Twist{draws_.point(kPlace), draws_.direction(), draws_.in(-1.5, 1.5), half});
}

NodeId BlobTreeGrower::fork(int depth) {
  const double r = draws_.in(0.15, 0.3);
  Fork fork;
  fork.axis = draws_.chance(0.3) ? any(depth - 1) : add(Chain{{{{0, 0, -1}, r}, {{0.1, 0, 0}, 0.9 * r}, {{0, 0, 1}, 0.8 * r}}, 1});
  for (int i = 0, n = 1 + draws_.below(3); i < n; ++i) {
    const Vec3 point = draws_.point({Vec3(-0.1, -0.1, -0.5), Vec3(0.1, 0.1, 0.5)});
    const Vec3 along = draws_.direction();
    const double lateral_radius = draws_.in(0.3, 1.0) * r;
    const NodeId child = draws_.chance(0.3)
                             ? any(depth - 1)
                             : add(Chain{{{point, lateral_radius}, {point + along, 0.8 * lateral_radius}}, 1});
    fork.laterals.push_back({child, point, 1.7 * draws_.direction(), 0.6 * lateral_radius, 2 * (r + lateral_radius)});
  }
  fork.width = draws_.in(0.1, 0.5);
  fork.lip = draws_.in(0, 4);
  return add(fork);
}

NodeId BlobTreeGrower::transform(int depth) {
  const Vec3 x = draws_.direction();
  const Vec3 y = glm::normalize(glm::cross(x, std::abs(x.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0)));
  const double s = draws_.in(0.5, 1.6);
  const Mat4 m(glm::dvec4(s * x, 0), glm::dvec4(s * y, 0), glm::dvec4(s * glm::cross(x, y), 0),
               glm::dvec4(draws_.point(kPlace), 1));
  return add(Transform{m, any(depth - 1)});
}

// The child of a bend is straight and thin enough for its radius of curvature.
NodeId BlobTreeGrower::bend() {
  const Vec3 a = draws_.point(kPlace), u = draws_.direction();
  const double length = draws_.in(0.6, 1.4), theta = draws_.in(-1.6, 1.6);
  const double rho = length / (2 * std::sin(std::abs(theta) / 2)), arc = rho * std::abs(theta);
  const double r = draws_.in(0.05, 0.1) * length;
  std::vector<NodeId> parts{add(Cone{a, a + arc * u, r, draws_.in(0.6, 1) * r, 1})};
  if (draws_.chance(0.6)) parts.push_back(add(Sphere{a + draws_.in(0, arc) * u, 1.2 * r, draws_.in(-0.8, 1)}));
  if (draws_.chance(0.6)) {
    const NodeId disc = add(Disc{a + 0.5 * arc * u, u + 0.2 * draws_.direction(), 0.7 * r, 0.6 * r, 1});
    parts.push_back(add(Twist{a, u, draws_.in(-2, 2), disc}));
  }
  const NodeId straight = add(Sum{std::move(parts)});
  const Vec3 across = glm::cross(u, draws_.direction());
  return add(Bend{a, a + length * u, draws_.direction() + 0.3 * across, theta, straight});
}

BlobTree random_blobtree(std::uint64_t seed, int depth) {
  BlobTreeGrower grower(seed);
  const NodeId root = grower.op(static_cast<int>(seed % BlobTreeGrower::kOperators), depth);
  return grower.finish(root);
}

BlobTree random_flared_blobtree(std::uint64_t seed, int depth) {
  BlobTreeGrower grower(seed, 0, true);
  const NodeId root = grower.op(static_cast<int>(seed % BlobTreeGrower::kOperators), depth);
  return grower.finish(root);
}

Flare flared_trunk(std::size_t prongs, double sharpness, FlareSection section, const Vec3& base, const Vec3& axis) {
  const Vec3 up = glm::normalize(axis), aside = glm::normalize(glm::cross(up, std::abs(up.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0)));
  Flare trunk{{}, base, axis, 1.2, 0.6, sharpness, {}, section};
  for (int i = 0; i < 7; ++i) trunk.nodes.push_back({base + 0.5 * i * up + 0.01 * i * i * aside, 0.3 - 0.02 * i});
  for (std::size_t i = 0; i < prongs; ++i) {
    const double part = static_cast<double>(i) + 0.2 * static_cast<double>(i % 2);
    trunk.prongs.push_back({0.3 + 2 * std::numbers::pi * part / static_cast<double>(prongs), 1 - 0.3 * static_cast<double>(i % 3)});
  }
  return trunk;
}

}  // namespace cambium
