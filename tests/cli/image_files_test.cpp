#include "cli/image_files.h"

#include <gtest/gtest.h>

#include "blobtree/input_error.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

TEST(ImageFiles, ReadsEachOnceAndWarnsOfWhatNoGlbTakes) {
  TemporaryFolder folder;
  const std::string png = folder.write("a.png", "\x89PNG\r\n\x1a\nrest"), other = folder.write("a.tif", "II*");
  std::vector<std::string> warnings;
  ImageFiles files(warnings);
  const auto first = files.read(png, "x");
  ASSERT_TRUE(first);
  EXPECT_EQ(files.read(png, "x"), first);
  EXPECT_TRUE(warnings.empty());
  EXPECT_FALSE(files.read(other, "leaves are without it"));
  EXPECT_FALSE(files.read(other, "leaves are without it"));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("leaves are without it"), std::string::npos);
  EXPECT_THROW(files.read(folder.path("none.png"), "x"), InputError);
}

}  // namespace
}  // namespace cambium
