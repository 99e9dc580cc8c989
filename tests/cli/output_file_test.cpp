#include "cli/output_file.h"

#include <gtest/gtest.h>

#include "blobtree/input_error.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

using Names = std::vector<std::string>;

TEST(OutputFile, IsThereOnlyAfterCommit) {
  TemporaryFolder folder;
  {
    OutputFile output(folder.path("a.obj"));
    write_text(output.temporary(), "new");
    EXPECT_FALSE(folder.has("a.obj"));
    output.commit();
  }
  EXPECT_EQ(folder.names(), Names{"a.obj"});
  EXPECT_EQ(folder.read("a.obj"), "new");
}

TEST(OutputFile, LeavesTheOldFileAndNoTraceUnlessCommitted) {
  TemporaryFolder folder;
  folder.write("a.obj", "old");
  {
    OutputFile output(folder.path("a.obj"));
    write_text(output.temporary(), "half");
  }
  EXPECT_EQ(folder.names(), Names{"a.obj"});
  EXPECT_EQ(folder.read("a.obj"), "old");
}

TEST(OutputFile, FollowsALinkInsteadOfReplacingIt) {
  TemporaryFolder folder;
  folder.write("real.obj", "old");
  std::filesystem::create_symlink("real.obj", folder.path("link.obj"));
  OutputFile output(folder.path("link.obj"));
  write_text(output.temporary(), "new");
  output.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path("link.obj")));
  EXPECT_EQ(folder.read("real.obj"), "new");
}

TEST(OutputFile, RefusesPlacesThatCannotBeWritten) {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.path("folder.obj"));
  for (const std::string& path : {folder.path("none/a.obj"), folder.path("folder.obj"), std::string(), folder.path("")})
    EXPECT_THROW(OutputFile{path}, InputError) << path;
  EXPECT_EQ(folder.names(), Names{"folder.obj"});
}

TEST(OutputFile, ADeviceIsWrittenToAndNotReplaced) {
  OutputFile output("/dev/null");
  write_text(output.temporary(), "text");
  output.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(OutputFile, ExtensionsAreTheLongestListed) {
  EXPECT_EQ(require_extension("a/B.Skel.JSON", {".skel.json", ".swc"}), ".skel.json");
  EXPECT_THROW(require_extension("a.json", {".skel.json", ".swc"}), InputError);
  EXPECT_THROW(require_extension(".swc", {".skel.json", ".swc"}), InputError);
  EXPECT_THROW(require_extension("", {".swc"}), InputError);
}

TEST(NumberedPath, PutsTheNumberBeforeTheWholeExtension) {
  EXPECT_EQ(numbered_path("a/tree.png", 7), "a/tree.0007.png");
  EXPECT_EQ(numbered_path("tree.skel.json", 12), "tree.0012.skel.json");
  EXPECT_EQ(numbered_path("my.tree.glb", 9999), "my.tree.9999.glb");
}

}  // namespace
}  // namespace cambium
