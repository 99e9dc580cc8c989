#include "polygonize/volume_read.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

namespace cambium {
namespace {

namespace fs = std::filesystem;

/// A file of a test that goes with it.
class VolumeRead : public ::testing::Test {
 protected:
  VolumeRead() { openvdb::initialize(); }
  ~VolumeRead() override { fs::remove(path_); }

  void write(const openvdb::GridPtrVec& grids) const { openvdb::io::File(path_.string()).write(grids); }

  /// Voxels of 0.5 m, `background` but for those of 0 .. 7, which are 2 + x / 10 (in voxels).
  static openvdb::FloatGrid::Ptr ramp(const std::string& name, float background = 1) {
    auto grid = openvdb::FloatGrid::create(background);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    grid->setName(name);
    for (openvdb::Coord at; at.x() < 8; at.offset(1, 0, 0))
      for (at.y() = 0; at.y() < 8; ++at.y())
        for (at.z() = 0; at.z() < 8; ++at.z()) grid->tree().setValue(at, 2 + 0.1f * static_cast<float>(at.x()));
    return grid;
  }

  void expect_refused(const std::string& in_message, const std::string& grid = {}) const {
    try {
      read_factor_volume(path_, grid);
      FAIL() << in_message;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, path_.string());
      EXPECT_NE(std::string(error.what()).find(in_message), std::string::npos) << error.what();
    }
  }

  fs::path path_ = fs::temp_directory_path() / ("cambium_factors_" + std::to_string(getpid()) + "_" +
                                                ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".vdb");
};

TEST_F(VolumeRead, IsLinearBetweenVoxelsAndItsBackgroundOutside) {
  write({ramp("factor")});
  const auto factor = read_factor_volume(path_);
  EXPECT_NEAR(factor({1, 1, 1}), 2.2, 1e-6);
  EXPECT_NEAR(factor({1.25, 1.1, 1.9}), 2.25, 1e-6);
  EXPECT_NEAR(factor({-0.25, 1, 1}), 1.5, 1e-6) << "between background and the first voxel";
  for (const Vec3& far : {Vec3(-5, 0, 0), Vec3(1e6, 1e6, -1e6)}) EXPECT_EQ(factor(far), 1);
}

TEST_F(VolumeRead, IsOneOutsideWhereItsBackgroundIsNought) {
  write({ramp("factor", 0.0f)});
  const auto factor = read_factor_volume(path_);
  EXPECT_NEAR(factor({1, 1, 1}), 2.2, 1e-6);
  EXPECT_EQ(factor({-5, 0, 0}), 1);
  EXPECT_NEAR(factor({-0.25, 1, 1}), 1.5, 1e-6) << "between that and the first voxel";
}

TEST_F(VolumeRead, TakesTheGridNamedOrTheFirstOfFloats) {
  auto other = ramp("other");
  for (auto at = other->beginValueOn(); at; ++at) at.setValue(5);
  auto vectors = openvdb::Vec3SGrid::create();
  vectors->setName("wind");
  write({vectors, ramp("factor"), other});
  EXPECT_NEAR(read_factor_volume(path_)({1, 1, 1}), 2.2, 1e-6);
  EXPECT_NEAR(read_factor_volume(path_, "other")({1, 1, 1}), 5, 1e-6);
  expect_refused("'wind' of another kind", "wind");
  expect_refused("named 'none'", "none");
}

TEST_F(VolumeRead, IsTheSameToThreadsAtOnce) {
  write({ramp("factor")});
  const auto factor = read_factor_volume(path_);
  std::vector<double> sums(4, 0);
  std::vector<std::thread> threads;
  for (double& sum : sums)
    threads.emplace_back([&factor, &sum] {
      for (int i = 0; i < 20000; ++i) sum += factor({0.0002 * i, 0.1, 0.3});
    });
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, sums[0]);
}

TEST_F(VolumeRead, RefusesValuesThatAreNoFactors) {
  for (const float bad : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto grid = ramp("factor");
    grid->tree().setValue({3, 4, 5}, bad);
    write({grid});
    expect_refused("at (1.500000, 2.000000, 2.500000)");
    if (bad == 0) continue;
    write({ramp("factor", bad)});
    expect_refused("background");
  }
}

TEST_F(VolumeRead, OfAFileThatIsNoneNamesIt) {
  const auto fails = [&] {
    try {
      read_factor_volume(path_);
      return false;
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).find(path_.string()) != std::string::npos;
    }
  };
  EXPECT_TRUE(fails()) << "there is none";
  std::ofstream(path_) << "no volume at all";
  EXPECT_TRUE(fails());
  write({ramp("factor")});
  fs::resize_file(path_, fs::file_size(path_) / 2);
  EXPECT_TRUE(fails());
}

}  // namespace
}  // namespace cambium
