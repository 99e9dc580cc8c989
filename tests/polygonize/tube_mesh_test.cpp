// Meshes in which tubes stand for the stretches between what an octree contours.
#include "polygonize/tube_mesh.h"

#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "tests/polygonize/mesh_checks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cambium {
namespace {

Field field_of(const Chain& chain) {
  BlobTreeBuilder b;
  return Field(b.build(b.add(chain)));
}

Chain bent_twig() {
  return {{{{0, 0, 0}, 0.004}, {{0, 0, 0.1}, 0.0035}, {{0.02, 0, 0.15}, 0.003}, {{0.06, 0.01, 0.2}, 0.003}, {{0.2, 0.05, 0.3}, 0.002}}};
}

Field forked_twig() {
  BlobTreeBuilder b;
  const NodeId twig = b.add(Chain{{{{0, 0, 0}, 0.006}, {{0.01, 0, 0.2}, 0.004}, {{0, 0.03, 0.45}, 0.002}}});
  const Vec3 up = glm::normalize(Vec3(1, 0.4, 1));
  const Vec3 at(0.006, 0, 0.12), higher(0.006, 0.012, 0.3);
  const NodeId shoot = b.add(Chain{{{at, 0.003}, {at + 0.2 * up, 0.002}}});
  const NodeId other = b.add(Chain{{{higher, 0.002}, {higher + 0.1 * Vec3(-up.x, up.y, up.z), 0.002}}});
  return Field(b.build(b.add(Fork{twig, {{shoot, at, {0, 0, 1}, 0.003, 0.02}, {other, higher, {0, 0, 1}, 0.002, 0.02}}, 0.5, 1})));
}

/// A bent twig at any angle with three shoots.
Field shooting_twig(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> any;
  const auto direction = [&] { return glm::normalize(Vec3(any(random), any(random), any(random))); };
  BlobTreeBuilder b;
  Chain twig;
  Vec3 p(0.0), along = direction();
  for (int k = 0; k < 5; ++k) {
    twig.nodes.push_back({p, 0.002 + 0.0005 * (5 - k)});
    along = glm::normalize(along + 0.15 * direction());
    p += 0.05 * along;
  }
  std::vector<Lateral> shoots;
  for (int k = 1; k < 4; ++k) {
    const Vec3 at = twig.nodes[k].position, axis = glm::normalize(twig.nodes[k + 1].position - twig.nodes[k - 1].position);
    const Vec3 out = glm::normalize(axis + direction());
    const NodeId shoot = b.add(Chain{{{at, 0.0015}, {at + 0.06 * out, 0.001}}});
    shoots.push_back({shoot, at, axis, 0.0015, 0.01});
  }
  return Field(b.build(b.add(Fork{b.add(twig), shoots, 0.5, 1})));
}

void expect_as_promised(const Field& field, const Mesh& mesh, double tolerance) {
  EXPECT_TRUE(testing::check_mesh(mesh).closed_manifold()) << testing::check_mesh(mesh);
  const auto found = verify_mesh(mesh, field, {.tolerance = tolerance, .surface_samples = 40'000}, {});
  EXPECT_TRUE(found->topology.closed_manifold());
  EXPECT_EQ(found->self_intersections, 0u);
  EXPECT_EQ(found->topology.components, 1u);
  for (const DistanceFigures& way : {found->mesh_to_surface, found->open_surface_to_mesh}) {
    EXPECT_GE(way.within, 0.999);
    EXPECT_EQ(way.within_twice, 1);
  }
}

TEST(TubeMesh, ATwigThatBendsAndTapersIsAsPromisedWithFewTriangles) {
  const Field field = field_of(bent_twig());
  for (const double tolerance : {0.001, 0.0005, 0.0001}) {
    SCOPED_TRACE(tolerance);
    const auto made = polygonize(field, {.tolerance = tolerance}, {});
    expect_as_promised(field, made->mesh, tolerance);
    EXPECT_GT(made->report.largest_error, 0.3 * tolerance);
    EXPECT_LT(made->report.largest_error, 1.3 * tolerance);
  }
  const std::size_t triangles = polygonize(field, {.tolerance = 0.0005}, {})->mesh.triangles.size();
  EXPECT_LT(triangles, 700u);   // an octree of cells no larger than 1.1 radii alone takes five thousand
}

TEST(TubeMesh, StretchesBetweenForksAreJoinedAtBothEnds) {
  const Field field = forked_twig();
  for (const double tolerance : {0.001, 0.0003}) {
    SCOPED_TRACE(tolerance);
    const auto made = polygonize(field, {.tolerance = tolerance}, {});
    expect_as_promised(field, made->mesh, tolerance);
  }
}

TEST(TubeMesh, TwigsAtAnyAngleAreClosed) {
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Chain chain;
    Vec3 p(any(random), any(random), any(random)), direction = glm::normalize(Vec3(any(random), any(random), any(random)));
    for (int k = 0; k < 6; ++k) {
      chain.nodes.push_back({p, 0.002 * (1 + 0.1 * (6 - k))});
      direction = glm::normalize(direction + 0.12 * Vec3(any(random), any(random), any(random)));
      p += 0.03 * direction;
    }
    const Field field = field_of(chain);
    const auto made = polygonize(field, {.tolerance = 0.0003}, {});
    EXPECT_TRUE(testing::check_mesh(made->mesh).closed_manifold());
    EXPECT_TRUE(self_intersections(made->mesh, {})->empty());
    EXPECT_LT(made->mesh.triangles.size(), 2000u);
  }
}

TEST(TubeMesh, ATrunkAmongItsTwigsIsJoinedToo) {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{{0, 0, 0}, 0.1}, {{0, 0, 2}, 0.09}, {{0.1, 0, 4}, 0.08}}});
  const Vec3 up = glm::normalize(Vec3(0.2, 1, 0.6)), at(0, 0, 1.9);
  const NodeId twig = b.add(Chain{{{at, 0.004}, {at + 0.5 * up, 0.003}}});
  const Field field(b.build(b.add(Fork{trunk, {{twig, at, {0, 0, 1}, 0.004, 0.15}}, 0.5, 1})));
  const auto made = polygonize(field, {.tolerance = 0.001}, {});
  expect_as_promised(field, made->mesh, 0.001);
}

// One such twig in a hundred has an end that a tube does not fit, at one of these tolerances.
TEST(TubeMesh, AStretchWhoseTubeDoesNotFitIsContouredInstead) {
  const std::pair<unsigned, double> misfits[] = {{151, 0.0005}, {291, 0.001}, {316, 0.0003}};
  for (const auto& [seed, tolerance] : misfits) {
    SCOPED_TRACE(seed);
    const Field field = shooting_twig(seed);
    const auto made = polygonize(field, {.tolerance = tolerance}, {});
    EXPECT_EQ(made->report.misfit_tubes, 1u) << "the case this is for";
    expect_as_promised(field, made->mesh, tolerance);
  }
}

TEST(TubeMesh, SameBytesForAnyNumberOfThreads) {
  for (const Field& field : {forked_twig(), shooting_twig(151), shooting_twig(1223)}) {
    const auto with = [&](int threads) {
      RunOptions run;
      run.threads = threads;
      return polygonize(field, {.tolerance = 0.0005}, run)->mesh;
    };
    const Mesh one = with(1);
    for (const int threads : {2, 4}) {
      const Mesh other = with(threads);
      EXPECT_EQ(one.positions, other.positions);
      EXPECT_EQ(one.normals, other.normals);
      EXPECT_EQ(one.triangles, other.triangles);
    }
  }
}

TEST(TubeMesh, AllCellsOfOneSizeLeaveNoRoomForTubes) {
  const auto made = polygonize(field_of(bent_twig()), {.voxel = 0.002}, {});
  EXPECT_TRUE(testing::check_mesh(made->mesh).closed_manifold());
  EXPECT_GT(made->mesh.triangles.size(), 2500u);
}

}  // namespace
}  // namespace cambium
