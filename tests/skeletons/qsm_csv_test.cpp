#include "malformed.h"
#include "skeletons/skeleton_io.h"

namespace cambium {
namespace {

const char* const kHeader = "ID,parentID,startX,startY,startZ,endX,endY,endZ,radius\n";

Skeleton parse(const std::string& rows) { return parse_qsm_csv(kHeader + rows, "q.csv"); }

TEST(QsmCsv, MakesAnInternodeOfEveryCylinder) {
  const Skeleton skeleton = parse("0,-1,0,0,0,0,0,1,0.1\n1,0,0,0,1,0,0,2,0.08\n");
  ASSERT_EQ(skeleton.nodes.size(), 3u);
  EXPECT_EQ(skeleton.nodes[0].parent, -1);
  EXPECT_EQ(skeleton.nodes[1].parent, 0);
  EXPECT_EQ(skeleton.nodes[2].parent, 1);
  EXPECT_EQ(skeleton.nodes[2].position, Vec3(0, 0, 2));
  EXPECT_EQ(skeleton.nodes[2].radius, 0.08);
}

TEST(QsmCsv, ClosesSmallGapsAndKeepsWideOnes) {
  const Skeleton skeleton = parse("0,-1,0,0,0,0,0,1,0.1\n1,0,0.05,0,1,0,0,2,0.08\n2,0,0.5,0,1,1,0,1,0.02\n");
  ASSERT_EQ(skeleton.nodes.size(), 5u);
  EXPECT_EQ(skeleton.nodes[2].parent, 1);                     // 5 cm away with a radius of 8 cm
  EXPECT_EQ(skeleton.nodes[3].position, Vec3(0.5, 0, 1));     // 50 cm away with a radius of 2 cm
  EXPECT_EQ(skeleton.nodes[3].parent, 1);
  EXPECT_EQ(skeleton.nodes[4].parent, 3);
}

TEST(QsmCsv, FindsColumnsByNameWhateverTheirCaseOrderAndSeparator) {
  const Skeleton skeleton = parse_qsm_csv(
      " \"Radius (m)\" ; start_x;start_y;start_z;END.X;end.y; end.z;other;Parent_ID;id\n0.5;1;2;3;4;5;6;text;-1;8\n", "q.csv");
  ASSERT_EQ(skeleton.nodes.size(), 2u);
  EXPECT_EQ(skeleton.nodes[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(skeleton.nodes[1].position, Vec3(4, 5, 6));
}

TEST(QsmCsv, TakesRowNumbersAxesAndParentZeroAsTreeQsmWritesThem) {
  const Skeleton skeleton = parse_qsm_csv(
      "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent\n"
      "0.5,2,0,0,0,0,0,1,0\n0.4,3,0,0,2,0,0,1,1\n", "q.csv");
  ASSERT_EQ(skeleton.nodes.size(), 3u);
  EXPECT_EQ(skeleton.nodes[2].position, Vec3(0, 0, 5));
  EXPECT_EQ(skeleton.nodes[2].parent, 1);
}

TEST(QsmCsv, TakesChildrenBeforeTheirParents) {
  const Skeleton skeleton = parse("1,0,0,0,1,0,0,2,0.08\n0,-1,0,0,0,0,0,1,0.1\n");
  ASSERT_EQ(skeleton.nodes.size(), 3u);
  EXPECT_EQ(skeleton.nodes[2].position, Vec3(0, 0, 2));
}

TEST(QsmCsv, RefusesMalformedTablesNamingLineAndColumn) {
  const std::string good = "0,-1,0,0,0,0,0,1,0.1\n";
  const struct { std::string rows; int line, column; const char* in_message; } table[] = {
      {"", 0, 0, "no nodes"},
      {good + "1,0,0,0,1,0,0,2\n", 3, 15, "8 columns"},
      {good + "1,0,0,0,1,0,0,2,0.1,7\n", 3, 21, "10 columns"},
      {good + "1,0,0,nan,1,0,0,2,0.1\n", 3, 7, "'nan'"},
      {good + "1,0,0,0,1,0,0,2,0\n", 3, 17, "above 0"},
      {good + "1,0,0,0,1,0,0,2,-1\n", 3, 17, "above 0"},
      {good + "1,0,0,0,1,0,,2,0.1\n", 3, 13, "nothing"},
      {good + "0,-1,0,0,1,0,0,2,1\n", 3, 1, "second time"},
      {good + "1,1,0,0,1,0,0,2,1\n", 3, 3, "own parent"},
      {good + "1,5,0,0,1,0,0,2,1\n", 3, 3, "parent 5"},
      {good + "1,2,0,0,1,0,0,2,1\n2,1,0,0,1,0,0,2,1\n", 3, 3, "cycle"},
  };
  for (const auto& bad : table) {
    const std::string text = kHeader + bad.rows;
    expect_refused({text.c_str(), bad.line, bad.column, bad.in_message}, parse_qsm_csv);
  }
  expect_refused({"", 0, 0, "empty"}, parse_qsm_csv);
  expect_refused({"\nid,parent,x,y\n", 2, 1, "radius"}, parse_qsm_csv);
  expect_refused({"id,parent,radius\n", 1, 1, "startX"}, parse_qsm_csv);
}

}  // namespace
}  // namespace cambium
