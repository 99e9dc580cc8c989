#include "strained_blobtrees.h"

#include "random_blobtrees.h"

#include <algorithm>

namespace cambium {
namespace {

const Box kPlace{Vec3(-1), Vec3(1)};

/// A grower of one strained tree, and the marks it leaves.
struct Strain {
  BlobTreeGrower grower;
  Draws& draws = grower.draws();
  std::vector<Vec3> marks{};
};

double strength_of(Draws& draws) { return draws.chance(0.8) ? 1.0 : draws.in(-1, 1.2); }

NodeId nest(Strain& s) { return s.grower.op(s.draws.below(BlobTreeGrower::kOperators), 2 + s.draws.below(3)); }

// Every level bears the whole nest below it on one side, as an axis of internodes does.
NodeId one_sided(Strain& s) {
  Draws& draws = s.draws;
  BlobTreeGrower& g = s.grower;
  Vec3 p = draws.point(kPlace), heading = draws.direction();
  NodeId top = g.add(Sphere{p, 0.1, 1});
  for (int level = 0, n = 50 + draws.below(250); level < n; ++level) {
    heading = glm::normalize(heading + 0.5 * draws.direction());
    const Vec3 next = p + draws.in(0.05, 0.2) * heading;
    const double r = draws.in(0.03, 0.12), strength = strength_of(draws);
    const NodeId piece = level % 3 == 0   ? g.add(Chain{{{p, r}, {next, 0.8 * r}}, strength})
                         : level % 3 == 1 ? g.add(Cone{p, next, r, 0.7 * r, strength})
                                          : g.add(Sphere{next, r, strength});
    const bool before = draws.chance(0.5);
    std::vector<NodeId> pair{before ? piece : top, before ? top : piece};
    switch (draws.below(14)) {
      case 0: case 1: case 2: case 3: top = g.add(Sum{pair}); break;
      case 4: case 5: case 6: top = g.add(Contact{pair, draws.in(0.1, 0.5), draws.in(0, 4)}); break;
      case 7: top = g.add(Union{pair}); break;
      case 8: top = g.add(Ricci{pair, draws.in(1, 4)}); break;
      case 9: case 10: top = g.add(Difference{{top, piece}}); break;
      case 11: top = g.add(Difference{{piece, g.add(ScaleField{draws.in(-1, 0.5), top})}}); break;
      case 12: top = g.add(Fork{pair[0], {{pair[1], p, heading, 0.6 * r, 4 * r}}, draws.in(0.1, 0.5), draws.in(0, 4)}); break;
      default: top = g.add(Sum{{g.add(ScaleField{draws.in(0.8, 1.2), top}), piece}});
    }
    if (level % 8 == 0) s.marks.push_back(p);
    p = next;
  }
  return top;
}

NodeId wide(Strain& s) {
  Draws& draws = s.draws;
  BlobTreeGrower& g = s.grower;
  std::vector<NodeId> children;
  for (int i = 0; i < 50; ++i) children.push_back(g.any(draws.chance(0.2) ? 1 : 0));
  switch (draws.below(7)) {
    case 0: return g.add(Sum{std::move(children)});
    case 1: return g.add(Union{std::move(children)});
    case 2: return g.add(Ricci{std::move(children), draws.in(1, 6)});
    case 3: return g.add(Contact{std::move(children), draws.in(0.1, 0.5), draws.in(0, 4)});
    case 4: return g.add(Difference{std::move(children)});
    case 5: {  // a crystal
      std::vector<NodeId> sides{g.add(Sum{std::move(children)})};
      for (int i = 0; i < 50; ++i) {
        const Vec3 out = draws.direction();
        sides.push_back(g.add(HalfSpace{out * draws.in(0.5, 1.5), out, draws.in(0.02, 0.3)}));
      }
      return g.add(Intersection{std::move(sides)});
    }
    default: {
      Fork fork{children.back(), {}, draws.in(0.1, 0.5), draws.in(0, 4)};
      children.pop_back();
      for (const NodeId child : children)
        fork.laterals.push_back({child, draws.point(kPlace), draws.direction(), draws.in(0.02, 0.2), draws.in(0.1, 1)});
      return g.add(std::move(fork));
    }
  }
}

// Steps stand still, turn straight back, or are far shorter than the radius, and the radius leaps.
NodeId folded_chain(Strain& s) {
  Draws& draws = s.draws;
  Chain chain{{}, strength_of(draws)};
  Vec3 p = draws.point({Vec3(-0.5), Vec3(0.5)}), step = draws.direction();
  double r = 0.3 * std::pow(10.0, -draws.in(0, 3));
  for (int i = 0, n = 1 + draws.below(40); i < n; ++i) {
    chain.nodes.push_back({p, r});
    if (i % 4 == 0) {
      Vec3 edge = p;
      edge[draws.below(3)] += kSupportPerRadius * r;
      s.marks.push_back(edge);
    }
    switch (draws.below(5)) {
      case 0: step = Vec3(0.0); break;
      case 1: step = -step; break;
      case 2: step = draws.in(0, 2) * r * draws.direction(); break;
      case 3: step = draws.in(0, 0.3) * draws.direction(); break;
      default: step = 1.1 * step + 0.5 * r * draws.direction();
    }
    if (glm::length(step) > 0.5) step = 0.5 * glm::normalize(step);
    p += step;
    r = std::clamp(r * std::pow(10.0, draws.in(-0.4, 0.4)), 3e-4, 0.3);
  }
  return s.grower.add(std::move(chain));
}

NodeId folded(Strain& s) {
  Draws& draws = s.draws;
  std::vector<NodeId> chains;
  for (int i = 0, n = 1 + draws.below(4); i < n; ++i) chains.push_back(folded_chain(s));
  switch (draws.below(4)) {
    case 0: return s.grower.add(Sum{std::move(chains)});
    case 1: return s.grower.add(Contact{std::move(chains), draws.in(0.1, 0.5), draws.in(0, 4)});
    case 2: return s.grower.add(Difference{std::move(chains)});
    default: return s.grower.add(Union{std::move(chains)});
  }
}

// Axes as the chain profile makes them, each bearing its laterals in one fork, those theirs.
NodeId forked_axis(Strain& s, const Vec3& base, const Vec3& along, double length, double r, int order) {
  Draws& draws = s.draws;
  constexpr int kSteps = 5;
  Chain chain{{}, draws.chance(0.9) ? 1.0 : draws.in(-1, 1)};
  for (int i = 0; i <= kSteps; ++i) {
    const Vec3 sway = i == 0 ? Vec3(0.0) : 0.05 * length * draws.direction();
    chain.nodes.push_back({base + (length * i / kSteps) * along + sway, r * (1 - 0.12 * i)});
  }
  Fork fork{0, {}, draws.in(0.1, 0.5), draws.in(0, 4)};
  const int laterals = order == 0 ? 0 : 1 + draws.below(3);
  for (int i = 0; i < laterals; ++i) {
    const Vec3 point = chain.nodes[static_cast<std::size_t>(1 + draws.below(kSteps - 1))].position;
    const Vec3 out = glm::normalize(along + 1.5 * draws.direction());
    const double thin = draws.in(0.2, 0.9) * r;
    const Vec3 start = point + std::max(0.0, kSupportPerRadius * thin - r) * out;
    const NodeId child = draws.chance(0.9) ? forked_axis(s, start, out, draws.in(0.3, 0.8) * length, thin, order - 1)
                                           : s.grower.add(Sphere{start, thin, draws.in(-1, 1)});
    fork.laterals.push_back({child, point, draws.direction(), 0.6 * thin, 2 * (r + thin)});
    s.marks.push_back(point);
  }
  const NodeId axis = s.grower.add(std::move(chain));
  if (laterals == 0) return axis;
  fork.axis = axis;
  return s.grower.add(std::move(fork));
}

NodeId forked(Strain& s) {
  return forked_axis(s, s.draws.point({Vec3(-0.3), Vec3(0.3)}), s.draws.direction(), s.draws.in(0.8, 2), s.draws.in(0.03, 0.15),
                     1 + s.draws.below(3));
}

/// Unbounded, never negative.
NodeId knife(Strain& s) {
  Draws& draws = s.draws;
  BlobTreeGrower& g = s.grower;
  const NodeId half = g.half_space();
  switch (draws.below(8)) {
    case 0: return g.add(Union{{half, g.half_space(), g.any(1)}});
    case 1: return g.add(Contact{{g.any(0), half}, 0.5, draws.in(0, 4)});
    case 2: return g.add(Ricci{{half, g.any(1), g.half_space()}, draws.in(1, 3)});
    case 3: return g.add(ScaleField{draws.in(0, 1.5), half});
    case 4: return g.add(Fork{half, {{g.any(0), draws.point(kPlace), draws.direction(), 0.1, 0.5}}, 0.5, 1});
    case 5: {
      const NodeId axis = g.add(Sphere{draws.point(kPlace), 0.3, 1});
      return g.add(Fork{axis, {{half, draws.point(kPlace), draws.direction(), 0.1, 0.5}}, 0.5, 1});
    }
    default: return half;
  }
}

// Half-spaces by themselves, joined, warped and scaled, each bounded by what it cuts.
NodeId cut(Strain& s) {
  Draws& draws = s.draws;
  BlobTreeGrower& g = s.grower;
  NodeId solid = g.any(2);
  for (int i = 0, n = 1 + draws.below(4); i < n; ++i) {
    switch (draws.below(5)) {
      case 0: solid = g.add(Intersection{{solid, knife(s)}}); break;
      case 1: solid = g.add(Intersection{{knife(s), solid, knife(s)}}); break;
      case 2: solid = g.add(Difference{{solid, g.half_space(), g.any(0)}}); break;
      // What is taken away may not exceed 1 anywhere: the rest would be negative without bounds.
      case 3: solid = g.add(Difference{{solid, g.add(Union{{g.half_space(), g.half_space()}})}}); break;
      default: solid = g.add(Difference{{solid, g.add(ScaleField{draws.in(0, 1), g.half_space()})}});
    }
    if (draws.chance(0.5)) solid = draws.chance(0.5) ? g.add(Sum{{solid, g.any(1)}}) : g.add(Union{{g.any(1), solid}});
  }
  return solid;
}

// Centres a power of two apart, supports of exactly those sizes: neighbours touch in one point, and the edges are doubles.
NodeId touching(Strain& s) {
  Draws& draws = s.draws;
  BlobTreeGrower& g = s.grower;
  Vec3 p(0.25 * (draws.below(9) - 4), 0.25 * (draws.below(9) - 4), 0.25 * (draws.below(9) - 4));
  std::vector<NodeId> children;
  for (int i = 0, n = 2 + draws.below(6); i < n; ++i) {
    const double support = std::ldexp(1.0, -1 - draws.below(4)), r = kRadiusPerSupport * support, strength = strength_of(draws);
    const int axis = draws.below(3);
    Vec3 across(0.0), along(0.0);
    across[axis] = support;
    along[(axis + 1) % 3] = 0.5;
    p += across;  // from the edge of the last support to this centre
    switch (draws.below(6)) {
      case 0: children.push_back(g.add(Chain{{{p, r}}, strength})); break;
      case 1: children.push_back(g.add(Chain{{{p, r}, {p + along, r}}, strength})); break;
      case 2: children.push_back(g.add(Capsule{p, p + along, r, strength})); break;
      case 3: children.push_back(g.add(Cone{p, p + along, r, r, strength})); break;
      case 4: children.push_back(g.add(RotatedBox{p + 0.5 * along, 0.5 * along, {1, 0, 0, 0}, r, strength})); break;
      default: children.push_back(g.add(Sphere{p, r, strength}));
    }
    for (const Vec3& mark : {p, p - across, p + across, p + along, p + along + across}) s.marks.push_back(mark);
    p += across;
  }
  switch (draws.below(6)) {
    case 0: return g.add(Sum{std::move(children)});
    case 1: return g.add(Union{std::move(children)});
    case 2: return g.add(Contact{std::move(children), 0.5, draws.in(0, 4)});
    case 3: return g.add(Ricci{std::move(children), draws.in(1, 3)});
    case 4: return g.add(Intersection{std::move(children)});
    default: return g.add(Difference{std::move(children)});
  }
}

}  // namespace

const std::vector<std::string>& strains() {
  static const std::vector<std::string> names{"Nest", "Decades", "OneSided", "Wide", "Folded", "Forked", "Cut", "Touching"};
  return names;
}

StrainedBlobTree strained_blobtree(std::size_t strain, std::uint64_t seed) {
  using Family = NodeId (*)(Strain&);
  constexpr Family kFamilies[] = {nest, nest, one_sided, wide, folded, forked, cut, touching, nest};
  const double decades = strain == 1 ? 3 : 0;
  Strain s{BlobTreeGrower(seed * 8 + strain, decades, strain == kFlaredStrain)};
  const NodeId root = kFamilies[strain](s);
  return {s.grower.finish(root), std::move(s.marks)};
}

}  // namespace cambium
