#include "malformed.h"
#include "skeletons/skeleton_io.h"

namespace cambium {
namespace {

TEST(Swc, ReadsCommentsBlankLinesAndWindowsLineEnds) {
  const Skeleton skeleton = parse_swc("# a tree\r\n\r\n1 0 0 0 0 0.5 -1\r\n2 3 1e0 -2 +3 .25 1 # end\r\n", "t.swc");
  ASSERT_EQ(skeleton.nodes.size(), 2u);
  EXPECT_EQ(skeleton.nodes[1].position, Vec3(1, -2, 3));
  EXPECT_EQ(skeleton.nodes[1].radius, 0.25);
  EXPECT_EQ(skeleton.nodes[1].parent, 0);
  EXPECT_FALSE(skeleton.nodes[1].base_radius);
}

TEST(Swc, PutsParentsFirst) {
  const Skeleton skeleton = parse_swc("7 0 2 0 0 1 5\n5 0 1 0 0 1 9\n3 0 3 0 0 1 5\n9 0 0 0 0 1 -1\n", "t.swc");
  ASSERT_EQ(skeleton.nodes.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(skeleton.nodes[i].parent, static_cast<std::int32_t>(i));
  EXPECT_EQ(skeleton.nodes[0].position.x, 0);
  EXPECT_EQ(skeleton.nodes[1].position.x, 1);
  EXPECT_EQ(skeleton.nodes[2].position.x, 2);
  EXPECT_EQ(skeleton.nodes[3].position.x, 3);
  EXPECT_EQ(skeleton.nodes[3].parent, 1);
}

TEST(Swc, PutsManyNodesWrittenBackwardsIntoOrderWithoutRecursion) {
  std::string text;
  constexpr int kCount = 300000;
  for (int i = kCount; i > 0; --i)
    text += std::to_string(i) + " 0 0 0 " + std::to_string(i) + " 1 " + (i > 1 ? std::to_string(i - 1) : "-1") + "\n";
  const Skeleton skeleton = parse_swc(text, "t.swc");
  ASSERT_EQ(skeleton.nodes.size(), static_cast<std::size_t>(kCount));
  EXPECT_EQ(skeleton.nodes.back().position.z, kCount);
}

TEST(Swc, RefusesMalformedTablesNamingLineAndColumn) {
  const Malformed table[] = {
      {"", 0, 0, "no nodes"},
      {"# only a comment\n", 0, 0, "no nodes"},
      {"1 0 0 0 0 1 -1\n2 0 0 0 1 1\n", 2, 11, "6 columns"},
      {"1 0 0 0 0 1 -1 9\n", 1, 16, "8 columns"},
      {"1 0 0 0 0 nan -1\n", 1, 11, "'nan'"},
      {"1 0 0 inf 0 1 -1\n", 1, 7, "'inf'"},
      {"1 0 0 1e999 0 1 -1\n", 1, 7, "finite"},
      {"1 0 0 1,5 0 1 -1\n", 1, 7, "'1,5'"},
      {"1 0 0 0 0 0 -1\n", 1, 11, "above 0"},
      {"1 0 0 0 0 -2 -1\n", 1, 11, "above 0"},
      {"x 0 0 0 0 1 -1\n", 1, 1, "'x'"},
      {"1.5 0 0 0 0 1 -1\n", 1, 1, "whole number"},
      {"1 0 0 0 0 1 -1\n1 0 0 0 1 1 1\n", 2, 1, "second time"},
      {"1 0 0 0 0 1 1\n", 1, 13, "own parent"},
      {"1 0 0 0 0 1 -1\n2 0 0 0 1 1 4\n", 2, 13, "parent 4"},
      {"1 0 0 0 0 1 -2\n", 1, 13, "'-2'"},
      {"1 0 0 0 0 1 -1\n2 0 0 0 1 1 3\n3 0 0 0 2 1 2\n", 2, 13, "cycle"},
  };
  for (const Malformed& bad : table) expect_refused(bad, parse_swc);
}

}  // namespace
}  // namespace cambium
