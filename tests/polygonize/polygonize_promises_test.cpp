// What polygonize() promises of every mesh, on solids that are known and on fields that are anything.
//
// With CAMBIUM_EXHAUSTIVE=1 in the environment the random fields are a thousand.
#include "polygonize/polygonize.h"

#include "polygonize/thinnest_radius.h"
#include "polygonize/verify.h"
#include "tests/polygonize/cgal_check.h"
#include "tests/polygonize/crease_curves.h"
#include "tests/polygonize/mesh_checks.h"
#include "tests/polygonize/octrees.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <map>
#include <set>
#include <thread>

namespace cambium {
namespace {

bool same(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles && a.creases == b.creases;
}

Polygonized at_tolerance(const Field& field, double tolerance, int threads = 0) {
  RunOptions run;
  run.threads = threads;
  return polygonize(field, {.tolerance = tolerance}, run).value();
}

TEST(PolygonizePromises, NearlyAllCreaseVerticesAreWithinAHundredthOfACellOfTheTrueCurve) {
  for (const testing::CreasedSolid& solid : testing::creased_solids()) {
    for (const double tolerance : {0.01, 0.001}) {
      SCOPED_TRACE(solid.name);
      const Polygonized made = at_tolerance(solid.field, tolerance);
      ASSERT_TRUE(check_topology(made.mesh).closed_manifold());
      std::set<std::uint32_t> vertices;
      for (const auto& crease : made.mesh.creases) vertices.insert(crease.begin(), crease.end());
      ASSERT_GT(vertices.size(), 30u);
      // But for those on a chord of the crease, because it passes their leaf by.
      std::size_t off = 0;
      for (const std::uint32_t vertex : vertices) {
        const double distance = solid.from_crease(made.mesh.positions[vertex]);
        EXPECT_LT(distance, 2 * tolerance);
        off += distance > 0.01 * made.report.smallest_cell;
      }
      EXPECT_LE(off, vertices.size() / 40);
    }
  }
}

TEST(PolygonizePromises, MostCreaseEdgesKeepTheirAngleToTwoDegrees) {
  for (const testing::CreasedSolid& solid : testing::creased_solids()) {
    SCOPED_TRACE(solid.name);
    const Polygonized made = at_tolerance(solid.field, 3e-4);
    const Mesh& mesh = made.mesh;
    std::map<std::array<std::uint32_t, 2>, std::vector<Vec3>> normals;   // of the triangles at each edge
    for (const auto& t : mesh.triangles) {
      const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t p = t[k], r = t[(k + 1) % 3];
        if (std::binary_search(mesh.creases.begin(), mesh.creases.end(), std::array{std::min(p, r), std::max(p, r)})) {
          normals[{std::min(p, r), std::max(p, r)}].push_back(glm::normalize(glm::cross(b - a, c - a)));
        }
      }
    }
    ASSERT_EQ(normals.size(), mesh.creases.size());
    std::vector<double> degrees;
    for (const auto& [edge, sides] : normals) {
      ASSERT_EQ(sides.size(), 2u);
      const auto sheets = solid.sheet_normals((mesh.positions[edge[0]] + mesh.positions[edge[1]]) / 2.0);
      if (sheets.size() != 2) continue;   // at a corner
      const auto between = [](const Vec3& a, const Vec3& b) { return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)); };
      degrees.push_back(std::abs(between(sheets[0], sheets[1]) - between(sides[0], sides[1])) * 180 / std::numbers::pi);
    }
    ASSERT_GT(degrees.size(), 50u);
    std::sort(degrees.begin(), degrees.end());
    EXPECT_LT(degrees[degrees.size() / 2], 1);
    EXPECT_LT(degrees[degrees.size() * 3 / 4], 2);
  }
}

/// Two branches that part at six degrees: the gap between them opens from nothing.
Field crevice_field() {
  BlobTreeBuilder b;
  const NodeId one = b.add(Capsule{Vec3(0, 0, 0), Vec3(0.02, 0.03, 1), 0.1, 1});
  const NodeId other = b.add(Capsule{Vec3(0.19, 0, 0), Vec3(0.31, 0.03, 1), 0.1, 1});
  return Field(b.build(b.add(Union{{one, other}})));
}

TEST(PolygonizePromises, GapsAsWideAsTheToleranceAreOpen) {
  const Field field = crevice_field();
  for (const double tolerance : {0.0012, 0.001, 0.0008, 0.0006}) {
    SCOPED_TRACE(tolerance);
    const Polygonized made = at_tolerance(field, tolerance);
    const Verification v = verify_mesh(made.mesh, field, {.tolerance = tolerance, .surface_samples = 100'000}, {}).value();
    EXPECT_GT(v.in_cracks, 0u) << "the case this is for";
    EXPECT_EQ(v.open_surface_to_mesh.within_twice, 1) << v.open_surface_to_mesh.max / tolerance;
  }
}

TEST(PolygonizePromises, BothDistancesAreWithinTheToleranceButForAThousandthAndWithinTwiceAlways) {
  struct Case {
    std::string name;
    Field field;
    double tolerance;
  };
  for (const Case& c : {Case{"sphere", testing::sphere_field(), 0.004}, Case{"torus", testing::torus_field(), 0.003},
                        Case{"chain", testing::chain_field(), 0.002}, Case{"cut box", testing::cut_box_field(), 0.004},
                        Case{"cut sphere", testing::cut_sphere().field, 0.003}, Case{"octant", testing::octant().field, 0.005}}) {
    SCOPED_TRACE(c.name);
    const Polygonized made = at_tolerance(c.field, c.tolerance);
    const Verification v = verify_mesh(made.mesh, c.field, {.tolerance = c.tolerance, .surface_samples = 60'000}, {}).value();
    EXPECT_TRUE(v.topology.closed_manifold());
    EXPECT_EQ(v.self_intersections, 0u);
    for (const DistanceFigures& d : {v.mesh_to_surface, v.surface_to_mesh}) {
      EXPECT_GE(d.within, 0.999) << d.max;
      EXPECT_EQ(d.within_twice, 1) << d.max;
    }
  }
}

TEST(PolygonizePromises, RandomFieldsGiveManifoldsThatDoNotCrossThemselves) {
  const std::uint64_t fields = std::getenv("CAMBIUM_EXHAUSTIVE") ? 1000 : 40;
  int certain = 0, uncertain = 0, crossing_where_uncertain = 0, of_cgal = 0;
  for (std::uint64_t seed = 1; seed <= fields; ++seed) {
    const Field field = testing::any_field(seed);
    for (const int parts : {60, 150}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", a " << parts << "th");
      const double tolerance = testing::longest_side(field) / parts;
      if (thinnest_radius(field) < tolerance / 64) continue;   // six sides around that: a hundred times the triangles
      const Polygonized made = at_tolerance(field, tolerance);
      const testing::MeshChecks checks = testing::check_mesh(made.mesh);
      ASSERT_TRUE(checks.closed_manifold()) << checks;
      const MeshTopology topology = check_topology(made.mesh);
      EXPECT_EQ(topology.degenerate_triangles, 0u);
      if (topology.components > 0) {
        EXPECT_GT(topology.volume, 0);
      }
      const std::size_t crossings = self_intersections(made.mesh, {})->size();
      if (!made.report.uncertain.empty()) {
        ++uncertain;
        crossing_where_uncertain += crossings > 0;
        continue;
      }
      ++certain;
      EXPECT_EQ(crossings, 0u);
      if (seed % 2 == 0 && !made.mesh.triangles.empty() && made.mesh.triangles.size() < 20000) {
        ++of_cgal;
        EXPECT_TRUE(testing::cgal_self_intersections(made.mesh).empty());
      }
    }
  }
  RecordProperty("certain", certain);
  RecordProperty("uncertain", uncertain);
  RecordProperty("crossing_where_uncertain", crossing_where_uncertain);
  EXPECT_GT(certain, static_cast<int>(fields) / 4);
  EXPECT_GT(of_cgal, 5);
}

TEST(PolygonizePromises, CreasedMeshesAreTheSameBytesForAnyNumberOfThreads) {
  for (const Field& field : {testing::fork_field(), testing::contact_field(), testing::octant().field}) {
    for (const double tolerance : {0.01, 0.002}) {
      const Polygonized one = at_tolerance(field, tolerance, 1);
      ASSERT_GT(one.mesh.creases.size(), 4u);
      for (const int threads : {2, 4}) {
        const Polygonized other = at_tolerance(field, tolerance, threads);
        EXPECT_TRUE(same(one.mesh, other.mesh)) << threads << " threads at " << tolerance;
        EXPECT_EQ(one.report.uncertain, other.report.uncertain);
        EXPECT_EQ(one.report.rounds, other.report.rounds);
      }
    }
  }
}

TEST(PolygonizePromises, CancelledAtAnyProgressItGivesNothing) {
  const Field field = testing::fork_field();
  int told = 0;
  RunOptions counting;
  counting.progress = [&](std::string_view, double) { ++told; };
  ASSERT_TRUE(polygonize(field, {.tolerance = 0.002}, counting).has_value());
  ASSERT_GT(told, 5);
  for (int stop = 0; stop + 1 < told; ++stop) {   // with the last one it is done
    std::atomic<bool> cancel{false};
    int at = 0;
    RunOptions run;
    run.cancel = &cancel;
    run.progress = [&](std::string_view, double) {
      if (at++ >= stop) cancel = true;
    };
    const auto made = polygonize(field, {.tolerance = 0.002}, run);
    EXPECT_TRUE(!made.has_value() || !cancel) << stop << " of " << told;
  }
}

TEST(PolygonizePromises, CancelledAtAnyTimeItGivesNothingOrAllOfIt) {
  const Field field = testing::fork_field();
  const PolygonizeOptions options{.tolerance = 0.002};
  const auto begin = std::chrono::steady_clock::now();
  const Polygonized whole = polygonize(field, options, {}).value();
  const std::chrono::duration<double> full = std::chrono::steady_clock::now() - begin;
  Draws draws(5);
  int stopped = 0;
  for (int turn = 0; turn < 12; ++turn) {
    const double wait = draws.in(0, turn < 6 ? 0.3 : 1) * full.count();
    std::atomic<bool> cancel{false};
    RunOptions run;
    run.cancel = &cancel;
    std::thread waiter([&] {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait));
      cancel = true;
    });
    const auto made = polygonize(field, options, run);
    waiter.join();
    stopped += !made.has_value();
    if (made) {
      EXPECT_TRUE(same(made->mesh, whole.mesh));
    }
  }
  EXPECT_GT(stopped, 0);
}

}  // namespace
}  // namespace cambium
