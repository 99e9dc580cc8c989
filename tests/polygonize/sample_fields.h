// Small BlobTrees that between them show everything a contour has to cope with.
#pragma once

#include "blobtree/field.h"

#include <cmath>
#include <random>
#include <utility>

namespace cambium::testing {

inline Field field_of(Node node) {
  BlobTreeBuilder builder;
  const NodeId root = builder.add(std::move(node));
  return Field(builder.build(root));
}

inline Field sphere_field(double radius = 1, Vec3 center = Vec3(0.03, -0.02, 0.01)) {
  return field_of(Sphere{center, radius, 1});
}

inline Field torus_field() { return field_of(Torus{Vec3(0.1, 0, 0), glm::normalize(Vec3(1, 2, 3)), 1.0, 0.3, 1}); }

inline Field chain_field(Vec3 at = Vec3(0)) {
  return field_of(Chain{{{at, 0.20}, {at + Vec3(0.1, 0, 1), 0.15}, {at + Vec3(-0.1, 0.2, 2), 0.1}, {at + Vec3(0, 0.1, 3), 0.05}}, 1});
}

inline Field fork_field() {
  BlobTreeBuilder builder;
  const NodeId axis = builder.add(Chain{{{Vec3(0, 0, 0), 0.2}, {Vec3(0, 0, 1), 0.18}, {Vec3(0, 0, 2), 0.15}}, 1});
  const Vec3 direction = glm::normalize(Vec3(1, 0, 1));
  const NodeId lateral = builder.add(Chain{{{Vec3(0, 0, 1) + 0.1 * direction, 0.13}, {Vec3(0, 0, 1) + 1.3 * direction, 0.1}}, 1});
  const NodeId root = builder.add(Fork{axis, {{lateral, Vec3(0, 0, 1), Vec3(0, 0, 1), 0.08, 0.6}}, 0.5, 1});
  return Field(builder.build(root));
}

inline Field contact_field() {
  BlobTreeBuilder builder;
  Contact contact;
  for (int i = 0; i < 3; ++i) {
    const double a = 2.1 * i;
    contact.children.push_back(builder.add(Capsule{Vec3(0, 0, 0), Vec3(std::cos(a), std::sin(a), 1), 0.3, 1}));
  }
  contact.lip = 2;
  const NodeId root = builder.add(contact);
  return Field(builder.build(root));
}

/// A box of half size 1 rounded by 0.1, cut by the plane x + y = 1.
inline constexpr double kCutWidth = 0.2;
inline Field cut_box_field() {
  BlobTreeBuilder builder;
  const NodeId box = builder.add(RotatedBox{Vec3(0), Vec3(1), glm::dvec4(1, 0, 0, 0), 0.1, 1});
  const NodeId half = builder.add(HalfSpace{Vec3(0.5, 0.5, 0), glm::normalize(Vec3(-1, -1, 0)), kCutWidth});
  const NodeId root = builder.add(Difference{{box, half}});
  return Field(builder.build(root));
}

/// Sums, unions, contacts, differences, Ricci blends and dents of spheres, capsules, tori and chains.
inline Field random_field(unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const auto point = [&] { return Vec3(number(-1, 1), number(-1, 1), number(-1, 1)); };
  BlobTreeBuilder builder;
  const auto primitive = [&]() -> NodeId {
    const double r = number(0.12, 0.4), strength = number(0, 1) < 0.2 ? -number(0.3, 1.2) : number(0.8, 1.5);
    switch (random() % 4) {
      case 0: return builder.add(Sphere{point(), r, strength});
      case 1: return builder.add(Capsule{point(), point(), r, strength});
      case 2: return builder.add(Torus{point(), glm::normalize(point()), number(0.3, 0.8), 0.5 * r, strength});
      default: return builder.add(Chain{{{point(), r}, {point(), 0.8 * r}, {point(), 0.6 * r}}, strength});
    }
  };
  std::vector<NodeId> groups;
  for (int g = 0; g < 4; ++g) {
    std::vector<NodeId> children;
    for (int i = 0; i < 3; ++i) children.push_back(primitive());
    switch (random() % 5) {
      case 0: groups.push_back(builder.add(Sum{children})); break;
      case 1: groups.push_back(builder.add(Union{children})); break;
      case 2: groups.push_back(builder.add(Difference{children})); break;
      case 3: groups.push_back(builder.add(Ricci{children, 3})); break;
      default: groups.push_back(builder.add(Contact{children, 0.5, 1})); break;
    }
  }
  const NodeId root = builder.add(Sum{groups});
  return Field(builder.build(root));
}

}  // namespace cambium::testing
