#include "malformed.h"
#include "skeletons/skeleton_io.h"

namespace cambium {
namespace {

std::string with_nodes(const std::string& nodes) {
  return "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[\n" + nodes + "\n]}";
}

TEST(SkelJson, ReadsNodesWithTheirOptionalKeys) {
  const Skeleton skeleton = parse_skel_json(
      with_nodes(R"({"position":[0,0,0],"radius":1,"parent":-1},
                    {"position":[0,0,2],"radius":0.5,"parent":0,"base_radius":0.75,"lateral":true})"), "s.skel.json");
  ASSERT_EQ(skeleton.nodes.size(), 2u);
  EXPECT_FALSE(skeleton.nodes[0].base_radius);
  EXPECT_FALSE(skeleton.nodes[0].lateral);
  EXPECT_EQ(skeleton.nodes[1].base_radius, 0.75);
  EXPECT_EQ(skeleton.nodes[1].lateral, true);
}

TEST(SkelJson, PutsParentsFirst) {
  const Skeleton skeleton = parse_skel_json(
      with_nodes(R"({"position":[0,0,1],"radius":1,"parent":1},{"position":[0,0,0],"radius":1,"parent":-1})"), "s");
  ASSERT_EQ(skeleton.nodes.size(), 2u);
  EXPECT_EQ(skeleton.nodes[0].parent, -1);
  EXPECT_EQ(skeleton.nodes[1].parent, 0);
}

TEST(SkelJson, RefusesMalformedFilesNamingLineAndColumn) {
  const struct { std::string text; int line, column; const char* in_message; } table[] = {
      {"", 1, 1, "expected"},
      {"[]", 1, 1, "object"},
      {"{\"format\":\"x\",\"version\":1,\"nodes\":[]}", 1, 11, "cambium-skeleton"},
      {"{\"format\":\"cambium-skeleton\",\"version\":2,\"nodes\":[]}", 1, 40, "version 1"},
      {"{\"format\":\"cambium-skeleton\",\"version\":1}", 1, 1, "nodes"},
      {"{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[],\"k\":1}", 1, 53, "unknown key"},
      {"{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[]}", 1, 50, "no nodes"},
      {with_nodes(R"({"position":[0,0,0],"radius":0,"parent":-1})"), 2, 30, "above 0"},
      {with_nodes(R"({"position":[0,0,0],"radius":-1,"parent":-1})"), 2, 30, "above 0"},
      {with_nodes(R"({"position":[0,0],"radius":1,"parent":-1})"), 2, 13, "2"},
      {with_nodes(R"({"position":[0,0,NaN],"radius":1,"parent":-1})"), 2, 18, "expected"},
      {with_nodes(R"({"position":[0,0,0],"radius":1,"parent":0})"), 2, 41, "own parent"},
      {with_nodes(R"({"position":[0,0,0],"radius":1,"parent":3})"), 2, 41, "parent 3"},
      {with_nodes(R"({"position":[0,0,0],"radius":1,"parent":-7})"), 2, 41, "-7"},
      {with_nodes(R"({"position":[0,0,0],"radius":1,"parent":-1,"colour":2})"), 2, 44, "colour"},
      {with_nodes(R"({"position":[0,0,0],"parent":-1})"), 2, 1, "radius"},
      {with_nodes(R"({"position":[0,0,0],"radius":1,"parent":-1,"base_radius":0})"), 2, 58, "above 0"},
      {with_nodes(R"({"position":[0,0,0],"radius":1,"parent":-1,"lateral":1})"), 2, 54, "number 1"},
      {with_nodes("{\"position\":[0,0,0],\"radius\":1,\"parent\":1},\n{\"position\":[0,0,0],\"radius\":1,\"parent\":0}"), 2, 41,
       "cycle"},
  };
  for (const auto& bad : table) expect_refused({bad.text.c_str(), bad.line, bad.column, bad.in_message}, parse_skel_json);
}

}  // namespace
}  // namespace cambium
