// A trunk with a limb and a sawn-off one, with the coordinates that a surface builder would give them.
#pragma once

#include "blobtree/field.h"
#include "polygonize/mesh_attributes.h"
#include "polygonize/polygonize.h"

namespace cambium::testing {

inline constexpr std::uint32_t kTrunk = 0, kLimb = 3, kSawn = 7;

inline std::vector<BranchInfo> small_tree_branches() {
  std::vector<BranchInfo> branches(8);
  branches[kTrunk] = {-1, Vec3(0), Vec3(0, 0, 1)};
  branches[kLimb] = {kTrunk, Vec3(0, 0, 1), glm::normalize(Vec3(1, 0, 0.6))};
  branches[kSawn] = {kTrunk, Vec3(0, 0, 1.5), Vec3(0, -1, 0)};
  return branches;
}

inline Field small_tree() {
  BlobTreeBuilder builder;
  const NodeId trunk = builder.add(Chain{{{Vec3(0, 0, 0), 0.10}, {Vec3(0.02, 0, 1), 0.085}, {Vec3(0, 0.02, 2), 0.06}}, 1});
  builder.set_attributes(trunk, {kTrunk, 0, 0, Vec3(1, 0, 0)});
  const Vec3 limb = glm::normalize(Vec3(1, 0, 0.6)), sawn(0, -1, 0);
  const NodeId lateral = builder.add(Chain{{{Vec3(0.02, 0, 1) + 0.05 * limb, 0.05}, {Vec3(0.02, 0, 1) + 1.0 * limb, 0.03}}, 1});
  builder.set_attributes(lateral, {kLimb, 1, 1.05, Vec3(0, 1, 0)});
  const NodeId stub = builder.add(Chain{{{Vec3(0.01, 0.01, 1.5) + 0.05 * sawn, 0.04}, {Vec3(0.01, 0.01, 1.5) + 0.5 * sawn, 0.04}}, 1});
  builder.set_attributes(stub, {kSawn, 1, 1.55, Vec3(1, 0, 0)});
  const NodeId cut = builder.add(Intersection{{stub, builder.add(HalfSpace{Vec3(0, -0.3, 1.5), sawn, 0.002})}});
  const NodeId root = builder.add(Fork{trunk, {{lateral, Vec3(0.02, 0, 1), Vec3(0, 0, 1), 0.03, 0.3},
                                               {cut, Vec3(0.01, 0.01, 1.5), Vec3(0, 0, 1), 0.03, 0.25}}, 0.5, 1});
  return Field(builder.build(root));
}

inline Mesh small_tree_mesh(const Field& field, double voxel = 0.012) {
  PolygonizeOptions options;
  options.voxel = voxel;
  return polygonize(field, options, {})->mesh;
}

inline MeshAttributes small_tree_attributes(const Field& field, const Mesh& mesh) {
  MeshAttributeOptions options;
  options.branches = small_tree_branches();
  return *mesh_attributes(field, mesh, options, {});
}

}  // namespace cambium::testing
