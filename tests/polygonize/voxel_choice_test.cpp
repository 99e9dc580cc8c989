#include "polygonize/voxel_choice.h"

#include "blobtree/input_error.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <numbers>

namespace cambium {
namespace {

TEST(VoxelChoice, TheAreaEstimateIsOfTheRightOrder) {
  const Field twig = testing::field_of(Capsule{Vec3(0), Vec3(0.3, 0.4, 5), 0.05, 1});
  const double exact = 2 * std::numbers::pi * 0.05 * glm::length(Vec3(0.3, 0.4, 5));
  EXPECT_NEAR(summarise_atoms(twig).area / exact, 1, 0.3);
  EXPECT_NEAR(summarise_atoms(twig).thinnest_radius, 0.05, 1e-12);
}

TEST(VoxelChoice, WhatIsAskedForComesFirst) {
  const Field field = testing::chain_field();
  const AtomSummary atoms = summarise_atoms(field);
  PolygonizeOptions options;
  EXPECT_NEAR(choose_voxel(field, atoms, options), 0.7 * 0.05, 1e-12);
  options.tolerance = 0.003;
  EXPECT_EQ(choose_voxel(field, atoms, options), 0.006);
  options.voxel = 0.02;
  EXPECT_EQ(choose_voxel(field, atoms, options), 0.02);
  options.voxel = -0.02;
  EXPECT_THROW(choose_voxel(field, atoms, options), InputError);
}

TEST(VoxelChoice, AThinTwigOnAGreatTrunkDoesNotAskForAHugeMesh) {
  BlobTreeBuilder builder;
  const NodeId trunk = builder.add(Capsule{Vec3(0), Vec3(0, 0, 20), 0.8, 1});
  const NodeId twig = builder.add(Capsule{Vec3(0, 0, 20), Vec3(0, 0, 22), 0.001, 1});
  const NodeId root = builder.add(Union{{trunk, twig}});
  const Field field(builder.build(root));
  const AtomSummary atoms = summarise_atoms(field);
  const double voxel = choose_voxel(field, atoms, {});
  EXPECT_GT(voxel, 0.0012);
  EXPECT_LE(expected_triangles(atoms.area, voxel), 1.0001 * kMostTriangles);
  PolygonizeReport report;
  report.voxel = voxel;
  report_thin_primitives(field, report);
  EXPECT_EQ(report.thin_primitives, 1u);
  EXPECT_NEAR(report.thinnest_radius, 0.001, 1e-12);
  EXPECT_GT(report.thin_length, 2);
  EXPECT_LT(report.thin_length, 2.1);
}

TEST(VoxelChoice, TwigsStayWholeWhereThatIsAffordable) {
  BlobTreeBuilder builder;
  const NodeId trunk = builder.add(Capsule{Vec3(0), Vec3(0, 0, 20), 0.8, 1});
  const NodeId twig = builder.add(Capsule{Vec3(0, 0, 20), Vec3(0, 0, 22), 0.005, 1});
  const NodeId root = builder.add(Union{{trunk, twig}});
  const Field field(builder.build(root));
  PolygonizeReport report;
  report.voxel = choose_voxel(field, summarise_atoms(field), {});
  EXPECT_GT(report.voxel, 0.7 * 0.005);  // finer than the wanted number of triangles allows
  report_thin_primitives(field, report);
  EXPECT_EQ(report.thin_primitives, 0u);
}

}  // namespace
}  // namespace cambium
