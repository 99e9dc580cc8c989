#include "polygonize/volume.h"

#include "blobtree/input_error.h"
#include "polygonize/mesh_distance.h"
#include "polygonize/polygonize.h"
#include "tests/polygonize/sample_fields.h"
#include "tests/polygonize/small_tree.h"
#include "tests/polygonize/written_volume.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <tuple>
#include <sys/wait.h>
#include <unistd.h>

namespace cambium {
namespace {

namespace fs = std::filesystem;

fs::path temporary(const std::string& name) {
  return fs::temp_directory_path() /
         (std::string("cambium_") + std::to_string(getpid()) + "_" +
          ::testing::UnitTest::GetInstance()->current_test_info()->name() + "_" + name);
}

VolumeReport write(const Field& field, VolumeKind kind, double voxel, const fs::path& path, int threads = 0) {
  VolumeOptions options;
  options.voxel = voxel;
  options.kind = kind;
  RunOptions run;
  run.threads = threads;
  const auto report = write_volume(field, options, path, run);
  EXPECT_TRUE(report.has_value());
  EXPECT_TRUE(fs::exists(path));
  return report.value_or(VolumeReport{});
}

// Opens the file with OpenVDB's own Python module in a process of its own: what a user's program would see.
// probes: world points; returns grid facts and the value at each.
nlohmann::json inspect(const fs::path& path, const std::string& grid, const std::string& probes) {
  const fs::path script = temporary("inspect.py"), out = temporary("out.json");
  std::ofstream(script) << R"(import json, sys
try:
    import pyopenvdb as vdb
except ImportError:
    try:
        import openvdb as vdb
    except ImportError:
        sys.exit(77)
g = vdb.read(sys.argv[1], sys.argv[2])
a = g.getConstAccessor()
probes = json.loads(sys.argv[3])
index = [tuple(int(round(c / g.transform.voxelSize()[0])) for c in p) for p in probes]
json.dump({"class": str(g.gridClass), "voxel": g.transform.voxelSize()[0], "active": g.activeVoxelCount(),
           "background": g.background, "half": g.saveFloatAsHalf, "name": g.name,
           "values": [a.getValue(i) for i in index], "on": [a.isValueOn(i) for i in index],
           "low": min((v["value"] if isinstance(v, dict) else v.value) for v in g.citerOnValues()),
           "high": max((v["value"] if isinstance(v, dict) else v.value) for v in g.citerOnValues())}, open(sys.argv[4], "w"))
)";
  const std::string command = std::string(SYSTEM_PYTHON) + " '" + script.string() + "' '" + path.string() + "' " + grid + " '" +
                              probes + "' '" + out.string() + "'";
  const int status = std::system(command.c_str());
  nlohmann::json result;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) result = nlohmann::json::parse(std::ifstream(out));
  else if (WIFEXITED(status) && WEXITSTATUS(status) == 77) result = "no module";
  fs::remove(script);
  fs::remove(out);
  return result;
}

#define SKIP_WITHOUT_PYTHON(facts) \
  if ((facts) == "no module") GTEST_SKIP() << "python3-openvdb is not installed"

TEST(Volume, TheLevelSetIsASignedDistanceNegativeInsideAndAllTheWayIn) {
  const fs::path path = temporary("sphere.vdb");
  const double voxel = 0.05;
  const VolumeReport report = write(testing::sphere_field(1, Vec3(0)), VolumeKind::kSdf, voxel, path);
  const auto facts = inspect(path, "surface", "[[0,0,0],[0.9,0,0],[0,1.1,0],[0,0,-1.0],[0.5,0.5,0],[1.5,1.5,1.5],[0.6,0.7,0.3]]");
  fs::remove(path);
  SKIP_WITHOUT_PYTHON(facts);
  ASSERT_TRUE(facts.is_object());
  EXPECT_EQ(facts["class"], "level set");
  EXPECT_EQ(facts["name"], "surface");
  EXPECT_NEAR(facts["voxel"].get<double>(), voxel, 1e-12);
  EXPECT_FALSE(facts["half"].get<bool>());
  EXPECT_NEAR(facts["background"].get<double>(), 3 * voxel, 1e-6);
  EXPECT_EQ(facts["active"].get<std::size_t>(), report.active_voxels);
  const double shell = 4 * std::numbers::pi * 6 / (voxel * voxel);   // area times band width, in voxels
  EXPECT_NEAR(double(report.active_voxels) / shell, 1, 0.05);
  const auto value = [&](int i) { return facts["values"][i].get<double>(); };
  EXPECT_NEAR(value(0), -3 * voxel, 1e-6);   // the centre: an inactive tile, still inside
  EXPECT_NEAR(value(1), -0.1, 0.1 * voxel);
  EXPECT_NEAR(value(2), 0.1, 0.1 * voxel);
  EXPECT_NEAR(value(3), 0, 0.1 * voxel);
  EXPECT_NEAR(value(4), -3 * voxel, 1e-6);
  EXPECT_NEAR(value(5), 3 * voxel, 1e-6);
  EXPECT_NEAR(value(6), std::sqrt(0.94) - 1, 0.15 * voxel);
  EXPECT_FALSE(facts["on"][0].get<bool>());
  EXPECT_TRUE(facts["on"][1].get<bool>());
  EXPECT_GE(facts["low"].get<double>(), -3 * voxel);
  EXPECT_LE(facts["high"].get<double>(), 3 * voxel);
}

TEST(Volume, TheFieldGridIsTheFieldWhereItIsPositive) {
  const fs::path path = temporary("chain.vdb");
  const Field field = testing::chain_field();
  const VolumeReport report = write(field, VolumeKind::kField, 0.04, path);
  const auto facts = inspect(path, "field", "[[0,0,0],[0.2,0.04,0.4],[0.08,0,0.8],[2,2,2]]");
  fs::remove(path);
  SKIP_WITHOUT_PYTHON(facts);
  ASSERT_TRUE(facts.is_object());
  EXPECT_EQ(facts["background"].get<double>(), 0);
  const auto at = [&](int i) { return facts["values"][i].get<double>(); };
  EXPECT_NEAR(at(0), field.value(Vec3(0, 0, 0)), 1e-4);
  EXPECT_NEAR(at(1), field.value(Vec3(0.2, 0.04, 0.4)), 1e-4);
  EXPECT_NEAR(at(2), field.value(Vec3(0.08, 0, 0.8)), 1e-4);
  EXPECT_EQ(at(3), 0);
  EXPECT_FALSE(facts["on"][3].get<bool>());
  EXPECT_GT(facts["low"].get<double>(), 0);
  // Every voxel centre counted by hand.
  std::size_t positive = 0;
  const Box box = field.bounds();
  for (double x = std::floor(box.lo.x / 0.04); x * 0.04 <= box.hi.x; ++x)
    for (double y = std::floor(box.lo.y / 0.04); y * 0.04 <= box.hi.y; ++y)
      for (double z = std::floor(box.lo.z / 0.04); z * 0.04 <= box.hi.z; ++z) positive += field.value(Vec3(x, y, z) * 0.04) > 0;
  EXPECT_NEAR(double(report.active_voxels) / double(positive), 1, 0.002);   // floats may lose the very rim
}

TEST(Volume, FogIsOneInsideAndNothingOutside) {
  const fs::path path = temporary("fog.vdb");
  write(testing::sphere_field(1, Vec3(0)), VolumeKind::kFog, 0.05, path);
  const auto facts = inspect(path, "density", "[[0,0,0],[0.5,0,0],[1.1,0,0],[0.95,0,0]]");
  fs::remove(path);
  SKIP_WITHOUT_PYTHON(facts);
  ASSERT_TRUE(facts.is_object());
  EXPECT_EQ(facts["class"], "fog volume");
  EXPECT_EQ(facts["background"].get<double>(), 0);
  EXPECT_EQ(facts["values"][0].get<double>(), 1);
  EXPECT_EQ(facts["values"][1].get<double>(), 1);
  EXPECT_EQ(facts["values"][2].get<double>(), 0);
  EXPECT_GT(facts["values"][3].get<double>(), 0);
  EXPECT_LT(facts["values"][3].get<double>(), 1);
}

TEST(Volume, ThinTwigsAndHollowsKeepTheirSigns) {
  BlobTreeBuilder builder;
  const NodeId outer = builder.add(Sphere{Vec3(0), 1, 1});
  const NodeId inner = builder.add(Sphere{Vec3(0), 0.5, 1});
  const NodeId shell = builder.add(Difference{{outer, inner}});
  const NodeId twig = builder.add(Chain{{{Vec3(2, 0, -1), 0.06}, {Vec3(2, 0, 1), 0.06}}, 1});
  const NodeId root = builder.add(Union{{shell, twig}});
  const Field field(builder.build(root));
  const fs::path path = temporary("hollow.vdb");
  write(field, VolumeKind::kSdf, 0.04, path);
  const auto facts = inspect(path, "surface", "[[0,0,0],[0.76,0,0],[0,0,-0.76],[2,0,0],[2,0,0.8],[2.2,0,0],[1.4,0,0]]");
  fs::remove(path);
  SKIP_WITHOUT_PYTHON(facts);
  ASSERT_TRUE(facts.is_object());
  const auto value = [&](int i) { return facts["values"][i].get<double>(); };
  EXPECT_GT(value(0), 0);   // the hollow
  EXPECT_LT(value(1), 0);
  EXPECT_LT(value(2), 0);
  EXPECT_NEAR(value(3), -0.06, 0.02);
  EXPECT_NEAR(value(4), -0.06, 0.02);
  EXPECT_GT(value(5), 0);
  EXPECT_GT(value(6), 0);
}

// Farthest vertex or centroid of one mesh from another.
double farthest(const Mesh& mesh, const Mesh& from, Vec3& where) {
  const MeshDistance distance(from);
  double most = 0;
  const auto ask = [&](const Vec3& p) {
    const double d = distance(p);
    if (d > most) most = d, where = p;
  };
  for (const Vec3& p : mesh.positions) ask(p);
  for (const auto& [a, b, c] : mesh.triangles) ask((mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0);
  return most;
}

TEST(Volume, WhereALevelSetIsZeroIsWithinAVoxelOfTheMeshBothWays) {
  const fs::path path = temporary("zero.vdb");
  const std::tuple<const char*, Field, double> cases[] = {
      {"tree", testing::small_tree(), 0.015},     {"fork", testing::fork_field(), 0.05},
      {"cut box", testing::cut_box_field(), 0.1}, {"contact", testing::contact_field(), 0.05},
      {"chain", testing::chain_field(), 0.04},    {"nest", testing::random_field(9), 0.05},
      {"coarse chain", testing::chain_field(), 0.1}};
  for (const auto& [name, field, voxel] : cases) {
    SCOPED_TRACE(name);
    write(field, VolumeKind::kSdf, voxel, path);
    const Mesh volume = testing::zero_set(path);
    fs::remove(path);
    ASSERT_GT(volume.triangles.size(), 500u);
    PolygonizeOptions options;
    options.tolerance = voxel / 5;
    const Mesh mesh = polygonize(field, options, {})->mesh;
    Vec3 at(0.0);
    EXPECT_LT(farthest(volume, mesh, at) / voxel, 1) << "at " << at.x << ", " << at.y << ", " << at.z;
    EXPECT_LT(farthest(mesh, volume, at) / voxel, 1) << "at " << at.x << ", " << at.y << ", " << at.z;
  }
}

TEST(Volume, TheGridsAreTheSameForAnyNumberOfThreads) {
  const Field field = testing::random_field(9);
  for (const VolumeKind kind : {VolumeKind::kField, VolumeKind::kSdf}) {
    const fs::path one = temporary("one.vdb"), two = temporary("two.vdb");
    EXPECT_EQ(write(field, kind, 0.03, one, 1).active_voxels, write(field, kind, 0.03, two, 2).active_voxels);
    const char* name = kind == VolumeKind::kField ? "field" : "surface";
    const std::string probes = "[[0,0,0],[0.3,0.3,0.3],[-0.6,0.3,0],[0.9,-0.3,0.6]]";
    const auto facts = inspect(one, name, probes);
    EXPECT_FALSE(facts.is_null());
    EXPECT_EQ(facts, inspect(two, name, probes));
    fs::remove(one);
    fs::remove(two);
  }
}

TEST(Volume, CancelledOrFailedItLeavesNoFile) {
  const fs::path path = temporary("none.vdb");
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(write_volume(testing::chain_field(), {}, path, run).has_value());
  EXPECT_FALSE(fs::exists(path));
  VolumeOptions coarse;
  coarse.voxel = 0.1;
  try {
    write_volume(testing::chain_field(), coarse, "/nonexistent/dir/tree.vdb", {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/dir/tree.vdb"), std::string::npos);
  }
  for (const double bad : {0.0, -1.0, std::nan(""), 1e-9}) {
    VolumeOptions options;
    options.voxel = bad;
    EXPECT_THROW(write_volume(testing::chain_field(), options, path, {}), InputError) << bad;
  }
  VolumeOptions options;
  options.half_width = 0;
  EXPECT_THROW(write_volume(testing::chain_field(), options, path, {}), InputError);
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace cambium
