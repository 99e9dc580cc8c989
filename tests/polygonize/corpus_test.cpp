// Whatever the kernel can say, meshed: random nests of every primitive and operator, each through everything that is promised of
// a mesh. 40 of them; 2,000 with CAMBIUM_EXHAUSTIVE=1 in the environment.
#include "blobtree/input_error.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "tests/blobtree/random_blobtrees.h"
#include "tests/blobtree/strained_blobtrees.h"
#include "tests/polygonize/cgal_check.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string_view>

namespace cambium {
namespace {

std::uint64_t rounds() {
  const char* exhaustive = std::getenv("CAMBIUM_EXHAUSTIVE");
  return exhaustive && std::string_view(exhaustive) == "1" ? 2000 : 40;
}

// One in four is of a family that strains something; the others are small nests of anything.
BlobTree corpus_tree(std::uint64_t i) {
  if (i % 4 != 3) return random_blobtree(i, 1 + static_cast<int>(i % 3));
  return strained_blobtree(i / 4 % strains().size(), i).tree;
}

double longest(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

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
  const Verification v = *verify_mesh(mesh, field, {.tolerance = tolerance, .surface_samples = 20'000}, {});
  if (v.surface_to_mesh.samples == 0) {
    EXPECT_TRUE(mesh.triangles.empty());
    return;
  }
  EXPECT_TRUE(v.topology.closed_manifold())
      << "boundary edges " << v.topology.boundary_edges << ", non-manifold edges " << v.topology.nonmanifold_edges
      << ", vertices " << v.topology.nonmanifold_vertices << ", degenerate " << v.topology.degenerate_triangles;
  EXPECT_EQ(v.topology.unused_vertices, 0u);
  EXPECT_GT(v.topology.volume, 0);
  EXPECT_EQ(v.self_intersections, 0u);
  if (v.topology.closed_manifold()) {
    EXPECT_EQ(testing::cgal_self_intersections(mesh).size(), v.self_intersections);
  }
  // Nests that bend, twist and taper are worse than trees: there it is 99.9 % and all within twice (check_presets.sh).
  EXPECT_GE(v.mesh_to_surface.within, 0.98) << "99.9 % " << v.mesh_to_surface.p999;
  EXPECT_GE(v.mesh_to_surface.within_twice, 0.99) << "max " << v.mesh_to_surface.max;
}

TEST(Corpus, EveryMeshIsClosedManifoldFreeOfCrossingsAndWithinTolerance) {
  const std::uint64_t count = rounds();
  for (std::uint64_t i = 0; i < count; ++i) {
    const Field field(corpus_tree(i));
    if (field.bounds().empty()) continue;
    const double tolerance = 0.004 * longest(field.bounds().size());
    SCOPED_TRACE("tree " + std::to_string(i) + ", tolerance " + std::to_string(tolerance));
    expect_shippable(field, tolerance);
  }
}

}  // namespace
}  // namespace cambium
