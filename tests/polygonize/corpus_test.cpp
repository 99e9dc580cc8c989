// Whatever the kernel can say, meshed: random nests of every primitive and operator, each through everything that is promised of
// a mesh. 40 of them; 2,000 with CAMBIUM_EXHAUSTIVE=1 in the environment, in twenty cases that can be run apart: a quarter of an hour
// in all.
#include "blobtree/input_error.h"
#include "polygonize/mesh_distance.h"
#include "polygonize/polygonize.h"
#include "polygonize/surface_samples.h"
#include "polygonize/verify.h"
#include "tests/blobtree/random_blobtrees.h"
#include "tests/blobtree/strained_blobtrees.h"
#include "tests/polygonize/cgal_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace cambium {
namespace {

constexpr std::uint64_t kCases = 20;
constexpr std::size_t kSamples = 20'000;

std::uint64_t nests_of_a_case() {
  const char* exhaustive = std::getenv("CAMBIUM_EXHAUSTIVE");
  return exhaustive && std::string_view(exhaustive) == "1" ? 100 : 2;
}

// One in four is of a family that strains something; the others are small nests of anything.
BlobTree corpus_tree(std::uint64_t i) {
  if (i % 4 != 3) return random_blobtree(i, 1 + static_cast<int>(i % 3));
  return strained_blobtree(i / 4 % strains().size(), i).tree;
}

double longest(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

/// Whether air at a point of the surface is narrower than `width`, straight out.
bool is_in_gap(const Field& field, const Vec3& p, double width) {
  constexpr int kSteps = 64;
  const Vec3 in = glm::normalize(field.sample(p).gradient);
  for (int k = 1; k <= kSteps; ++k)
    if (field.sample(p - width * k / kSteps * in).value >= kIso) return true;
  return false;
}

// Gaps are closed where they are about as narrow as the tolerance, and what of the rest is missing is reported at that place.
void expect_nothing_is_lost_silently(const Field& field, const SurfaceSamples& surface, const Polygonized& made) {
  constexpr double kGap = 1.25, kNear = 8;   // tolerances; between the walls of a wedge it is farther along their normals than across
  const double tolerance = made.report.tolerance;
  const MeshDistance distance(made.mesh);
  std::size_t silent = 0;
  for (const Vec3& p : surface.points) {
    if (!(distance(p) > 2 * tolerance) || is_in_gap(field, p, kGap * tolerance)) continue;
    const auto near = [&](const Vec3& place) { return glm::length(place - p) < kNear * tolerance; };
    silent += std::none_of(made.report.unseen.begin(), made.report.unseen.end(), near) &&
              std::none_of(made.report.left_out.begin(), made.report.left_out.end(), near);
  }
  EXPECT_EQ(silent, 0u);
}

void expect_shippable(const Field& field, double tolerance) {
  PolygonizeOptions options;
  options.tolerance = tolerance;
  std::optional<Polygonized> made;
  try {
    made = polygonize(field, options, {});
  } catch (const InputError&) {
    return;   // a hair's breadth of plate across metres: more cells than there is room for
  }
  ASSERT_TRUE(made.has_value());
  const Mesh& mesh = made->mesh;
  const Verification v = *verify_mesh(mesh, field, {.tolerance = tolerance, .surface_samples = kSamples}, {});
  const SurfaceSamples surface = *sample_surface(field, kSamples, {});
  Box around;
  for (const Vec3& p : surface.points) around.extend(p);
  if (surface.points.empty()) {
    EXPECT_TRUE(mesh.triangles.empty());
    return;
  }
  if (longest(around.size()) < tolerance && mesh.triangles.empty()) return;   // a speck
  EXPECT_TRUE(v.topology.closed_manifold())
      << "boundary edges " << v.topology.boundary_edges << ", non-manifold edges " << v.topology.nonmanifold_edges
      << ", vertices " << v.topology.nonmanifold_vertices << ", degenerate " << v.topology.degenerate_triangles;
  EXPECT_EQ(v.topology.unused_vertices, 0u);
  EXPECT_GT(v.topology.volume, 0);
  EXPECT_EQ(v.self_intersections, 0u);
  if (v.topology.closed_manifold()) {
    EXPECT_EQ(testing::cgal_self_intersections(mesh).size(), v.self_intersections);
  }
  EXPECT_GE(v.mesh_to_surface.within, 0.998) << "99.9 % " << v.mesh_to_surface.p999;
  EXPECT_LE(v.mesh_to_surface.max, 2 * tolerance) << v.mesh_to_surface.max / tolerance;
  if (v.open_surface_to_mesh.within_twice < 1) expect_nothing_is_lost_silently(field, surface, *made);
}

double tolerance_of(const Field& field) { return 0.004 * longest(field.bounds().size()); }

class Corpus : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Corpus, EveryMeshIsClosedManifoldFreeOfCrossingsAndWithinTolerance) {
  const std::uint64_t count = nests_of_a_case();
  for (std::uint64_t i = count * GetParam(); i < count * (GetParam() + 1); ++i) {
    const Field field(corpus_tree(i));
    if (field.bounds().empty()) continue;
    const double tolerance = tolerance_of(field);
    SCOPED_TRACE("tree " + std::to_string(i) + ", tolerance " + std::to_string(tolerance));
    expect_shippable(field, tolerance);
  }
}

// A corpus of its own: that of the nests is keyed by number. Flares by themselves and in nests of anything.
TEST(CorpusOfFlares, EveryMeshIsClosedManifoldFreeOfCrossingsAndWithinTolerance) {
  const std::uint64_t count = nests_of_a_case() * 10;
  for (std::uint64_t i = 0; i < count; ++i) {
    SCOPED_TRACE("tree " + std::to_string(i));
    const Field field(random_flared_blobtree(i, 1 + static_cast<int>(i % 2)));
    if (field.bounds().empty()) continue;
    expect_shippable(field, tolerance_of(field));
  }
}

// Each of these once lost surface beside what its leaves show, and nothing said so: plates thinner than the tolerance, bumps, crumbs.
TEST(CorpusOfOld, NestsThatOnceLostSurfaceSilentlyMeshOrReportIt) {
  for (const std::uint64_t i : {170, 219, 285, 347, 394, 770, 795}) {
    SCOPED_TRACE("tree " + std::to_string(i));
    const Field field(corpus_tree(i));
    expect_shippable(field, tolerance_of(field));
  }
}

// The tube's joins ran through its walls where the chain bends sharply just before its end.
TEST(CorpusOfOld, ANestWhoseTubeOnceCrossedItselfDoesNot) {
  SCOPED_TRACE("tree 1847");
  const Field field(corpus_tree(1847));
  expect_shippable(field, tolerance_of(field));
}

INSTANTIATE_TEST_SUITE_P(Slices, Corpus, ::testing::Range(std::uint64_t{0}, kCases));

}  // namespace
}  // namespace cambium
