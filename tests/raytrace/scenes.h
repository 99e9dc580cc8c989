// Small BlobTrees that rays and renders are tested on.
#pragma once

#include "blobtree/field.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cambium::scenes {

inline NodeId add_chain(BlobTreeBuilder& builder, std::vector<ChainNode> nodes, std::uint32_t branch = 0, std::uint32_t order = 0) {
  const NodeId id = builder.add(Chain{std::move(nodes)});
  Attributes attributes;
  attributes.branch = branch;
  attributes.order = order;
  builder.set_attributes(id, attributes);
  return id;
}

inline Field sphere(const Vec3& center, double radius) {
  BlobTreeBuilder builder;
  return Field(builder.build(builder.add(Sphere{center, radius})));
}

inline Field trunk() {
  BlobTreeBuilder builder;
  return Field(builder.build(add_chain(builder, {{{0, 0, 0}, 0.2}, {{0.05, 0, 1}, 0.16}, {{0, 0.05, 2}, 0.12}})));
}

/// A twig of 1 mm radius, 30 m up.
inline Field thin_twig() {
  BlobTreeBuilder builder;
  return Field(builder.build(add_chain(builder, {{{0.1, 0.2, 30.0}, 0.001}, {{0.25, 0.3, 30.05}, 0.001}, {{0.4, 0.28, 30.2}, 0.001}})));
}

inline Field forked() {
  BlobTreeBuilder builder;
  const NodeId axis = add_chain(builder, {{{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.08}}, 0, 0);
  const Vec3 point(0, 0, 0.5), direction = glm::normalize(Vec3(1, 0, 1)), to_crotch = glm::normalize(Vec3(-1, 0, 1));
  const Vec3 start = point + 0.06 * direction;
  const NodeId lateral = add_chain(builder, {{start, 0.07}, {start + 0.6 * direction, 0.03}}, 1, 1);
  return Field(builder.build(builder.add(Fork{axis, {{lateral, point, to_crotch, 0.042, 0.34}}})));
}

/// A log sawn off at z = 0.5 and scarred at its side.
inline Field sawn() {
  BlobTreeBuilder builder;
  const NodeId log = add_chain(builder, {{{0, 0, 0}, 0.1}, {{0, 0, 1}, 0.1}});
  const NodeId above = builder.add(HalfSpace{{0, 0, 0.5}, {0, 0, -1}, 0.01});
  return Field(builder.build(builder.add(Difference{{log, above}})));
}

/// The first t in [begin, end] at which f is inside, by steps; infinity if none. The tests' own way, blind and slow.
template <typename Ray>
double sampled_root(Evaluator& evaluator, const PrunedField& field, const Ray& ray, double begin, double end, double step) {
  for (double t = begin; t <= end; t += step) {
    if (evaluator.value(field, ray.at(t)) < kIso) continue;
    double outside = std::max(begin, t - step), inside = t;
    while (inside - outside > 1e-12) {
      const double middle = 0.5 * (outside + inside);
      (evaluator.value(field, ray.at(middle)) < kIso ? outside : inside) = middle;
    }
    return inside;
  }
  return kInfinity;
}

}  // namespace cambium::scenes
