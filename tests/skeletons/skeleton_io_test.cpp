#include "skeletons/skeleton_io.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace cambium {
namespace {

/// A folder of its own, gone with the test.
class SkeletonFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("cambium_skeleton_io_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

Skeleton awkward_skeleton() {
  Skeleton skeleton;
  skeleton.nodes.push_back({{0.1, 1.0 / 3, -253.888632}, 0.047199, -1, std::nullopt, std::nullopt});
  skeleton.nodes.push_back({{std::nextafter(1.0, 2.0), 1e-300, -0.0}, 1e-7, 0, 0.03, false});
  skeleton.nodes.push_back({{3e8, 2.5e-5, 7}, std::sqrt(2.0) / 100, 0, std::nullopt, true});
  return skeleton;
}

void expect_same(const Skeleton& a, const Skeleton& b, bool optional_keys) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].position, b.nodes[i].position);
    EXPECT_EQ(a.nodes[i].radius, b.nodes[i].radius);
    EXPECT_EQ(a.nodes[i].parent, b.nodes[i].parent);
    if (!optional_keys) continue;
    EXPECT_EQ(a.nodes[i].base_radius, b.nodes[i].base_radius);
    EXPECT_EQ(a.nodes[i].lateral, b.nodes[i].lateral);
  }
}

TEST_F(SkeletonFiles, SkelJsonReadsBackTheSameDoubles) {
  write_skeleton(awkward_skeleton(), folder_ / "t.skel.json", "skel.json");
  expect_same(read_skeleton(folder_ / "t.skel.json"), awkward_skeleton(), true);
}

TEST_F(SkeletonFiles, SwcReadsBackTheSameDoubles) {
  write_skeleton(awkward_skeleton(), folder_ / "t.swc", ".swc");
  expect_same(read_skeleton(folder_ / "t.swc"), awkward_skeleton(), false);
}

TEST_F(SkeletonFiles, OptionalKeysAreWrittenOnlyWhenSet) {
  Skeleton skeleton;
  skeleton.nodes.push_back({{0, 0, 0}, 1, -1, std::nullopt, std::nullopt});
  const std::string text = skeleton_text(skeleton, "skel.json");
  EXPECT_EQ(text.find("base_radius"), std::string::npos);
  EXPECT_EQ(text.find("lateral"), std::string::npos);
}

TEST_F(SkeletonFiles, AMissingFileAFolderAndAnUnknownExtensionAreInputErrors) {
  EXPECT_THROW(read_skeleton(folder_ / "none.swc"), InputError);
  std::filesystem::create_directories(folder_ / "folder.csv");
  EXPECT_THROW(read_skeleton(folder_ / "folder.csv"), InputError);
  EXPECT_THROW(read_skeleton(folder_ / "t.obj"), InputError);
}

TEST_F(SkeletonFiles, AFailedWriteNamesThePath) {
  const std::filesystem::path path = folder_ / "no_such_folder" / "t.swc";
  try {
    write_skeleton(awkward_skeleton(), path, "swc");
    FAIL() << "was written";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
  EXPECT_THROW(write_skeleton(awkward_skeleton(), folder_ / "t.obj", "obj"), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "t.obj"));
}

TEST_F(SkeletonFiles, AFullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(write_skeleton(awkward_skeleton(), "/dev/full", "swc"), std::runtime_error);
}

}  // namespace
}  // namespace cambium
