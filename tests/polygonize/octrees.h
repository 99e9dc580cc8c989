// Octrees that need not fit their field, what is contoured on them, and the questions that can be put to that by brute force.
#pragma once

#include "polygonize/contour_refiner.h"
#include "polygonize/patch_polygons.h"
#include "polygonize/polygon_ring.h"
#include "tests/blobtree/random_blobtrees.h"
#include "tests/blobtree/strained_blobtrees.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace cambium::testing {

/// Many small spheres that add and take away: signs about as good as random on cells of their size.
inline Field noise_field(std::uint64_t seed, int spheres = 120, double half_size = 0.6) {
  Draws draws(seed);
  BlobTreeBuilder builder;
  std::vector<NodeId> children;
  for (int i = 0; i < spheres; ++i) {
    const double strength = draws.chance(0.4) ? draws.in(-1.5, -0.3) : draws.in(0.8, 1.6);
    children.push_back(builder.add(Sphere{draws.point({Vec3(-half_size), Vec3(half_size)}), draws.in(0.05, 0.15), strength}));
  }
  return Field(builder.build(builder.add(Sum{std::move(children)})));
}

/// One of many: nests of everything, strained ones, and noise.
inline Field any_field(std::uint64_t seed) {
  const std::uint64_t families = strains().size() + 2, family = seed % families;
  if (family < strains().size()) return Field(strained_blobtree(family, seed).tree);
  if (family == strains().size()) return Field(random_blobtree(seed, 3));
  return noise_field(seed);
}

inline double longest_side(const Field& field) {
  const Vec3 size = field.bounds().size();
  return std::max({size.x, size.y, size.z});
}

struct OnOctree {
  SurfaceCover cover;
  SurfaceOctree tree;
};

/// Leaves as large as the cells of the cover, whatever is in them; they may be cut `finer` times.
inline OnOctree coarse_octree(const Field& field, double cell, int finer, LeafRule rule = {.radii = kInfinity}) {
  CoverOptions options;
  options.cell = cell;
  OnOctree made{cover_surface(field, options, {}).value(), {}};
  made.tree = SurfaceOctree::build(made.cover, finer, rule, {}).value();
  return made;
}

inline std::vector<std::uint32_t> live_leaves(const SurfaceOctree& tree) {
  std::vector<std::uint32_t> live;
  for (std::uint32_t i = 0; i < tree.leaves().size(); ++i)
    if (tree.find(tree.leaves()[i].place) == i) live.push_back(i);
  return live;
}

/// Cuts leaves drawn at random, and their larger neighbours.
inline void split_at_random(OnOctree& on, Draws& draws, double share) {
  std::vector<std::uint32_t> leaves;
  for (const std::uint32_t leaf : live_leaves(on.tree))
    if (on.tree.leaves()[leaf].level > 0 && draws.chance(share)) leaves.push_back(leaf);
  on.tree.split(on.cover, std::move(leaves), {});
}

/// The octree is cut until its cells can be contoured.
inline Contour contour_on(OnOctree& on, std::size_t* relinked_faces = nullptr) {
  ContourRefiner refiner = ContourRefiner::begin(on.tree, on.cover, {}).value();
  refiner.place({});
  on.tree = refiner.tree();
  if (relinked_faces) *relinked_faces += refiner.relinked_faces();
  refiner.compact(living_part(refiner.contour()));
  return refiner.contour();
}

inline std::vector<Vec3> positions_of(const Contour& contour) {
  std::vector<Vec3> positions;
  for (const PatchVertex& vertex : contour.vertices) positions.push_back(vertex.position);
  return positions;
}

/// All to be chosen.
inline std::vector<std::optional<Split>> splits_of(const Contour& contour) {
  return std::vector<std::optional<Split>>(contour.edges.size());
}

inline DualMesh polygons_on(const OnOctree& on, const Contour& contour) {
  return build_polygons(on.tree, on.cover, contour, positions_of(contour), splits_of(contour), kInfinity, {}).value();
}

/// The low end of a minimal edge, in units.
inline CellPlace low_place(const SurfaceOctree& tree, const MinimalEdge& edge) {
  const OctreeLeaf& owner = tree.leaves()[edge.owner()];
  CellPlace place = owner.place;
  const int corner = edge_low_corner(edge.edge_of_owner());
  for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(corner >> a & 1) << owner.level;
  return place;
}

/// How often a closed mesh winds around a point: 1 inside, 0 outside (van Oosterom & Strackee 1983).
inline double winding_number(const Mesh& mesh, const Vec3& p) {
  double angle = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]] - p, b = mesh.positions[t[1]] - p, c = mesh.positions[t[2]] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    angle += std::atan2(glm::dot(a, glm::cross(b, c)),
                        la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return angle / (2 * std::numbers::pi);
}

}  // namespace cambium::testing
