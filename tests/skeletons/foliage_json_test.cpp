#include "skeletons/foliage_json.h"

#include "leafy_trees.h"
#include "malformed.h"
#include "skeletons/skeleton_io.h"
#include "small_trees.h"

namespace cambium {
namespace {

Foliage awkward_foliage() {
  Foliage foliage = leaves_at({{1, {1.0 / 3, 0.1, -2}}, {-1, {0, 0, 0}}});
  foliage.shapes.push_back({"a \"b\"\\\n", {}, {}});
  OrganPlacement& organ = foliage.organs[0];
  organ.heading = glm::normalize(Vec3(0.3, 0.2, 0.9));
  organ.left = glm::normalize(glm::cross(organ.heading, Vec3(0, 1, 0)));
  organ.up = glm::cross(organ.left, organ.heading);
  organ.scale = 0.1;
  organ.color = 7;
  foliage.organs[1].shape = 1;
  return foliage;
}

TEST(FoliageJson, ReadsBackTheSame) {
  const Foliage written = awkward_foliage();
  const Plant plant = parse_plant_json(skeleton_text(fork_tree(0.1, 0.05, 60, 2), "skel.json", written), "p.skel.json");
  EXPECT_EQ(plant.skeleton.nodes.size(), 4u);
  ASSERT_EQ(plant.foliage.shapes.size(), 2u);
  ASSERT_EQ(plant.foliage.organs.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const OrganShape &shape = plant.foliage.shapes[i], &same = written.shapes[i];
    EXPECT_EQ(shape.name, same.name);
    EXPECT_EQ(shape.vertices, same.vertices);
    EXPECT_EQ(shape.triangles, same.triangles);
    const OrganPlacement &organ = plant.foliage.organs[i], &as_written = written.organs[i];
    EXPECT_EQ(organ.shape, as_written.shape);
    EXPECT_EQ(organ.node, as_written.node);
    EXPECT_EQ(organ.position, as_written.position);
    EXPECT_EQ(organ.left, as_written.left);
    EXPECT_EQ(organ.heading, as_written.heading);
    EXPECT_EQ(organ.up, as_written.up);
    EXPECT_EQ(organ.scale, as_written.scale);
    EXPECT_EQ(organ.color, as_written.color);
  }
}

TEST(FoliageJson, ASkeletonWithoutFoliageHasNoneOfItsKeys) {
  const std::string text = skeleton_text(fork_tree(0.1, 0.05, 60, 2), "skel.json");
  EXPECT_EQ(text.find("shapes"), std::string::npos);
  EXPECT_EQ(text.find("organs"), std::string::npos);
}

constexpr const char* kNodes = R"("nodes":[{"position":[0,0,1],"radius":1,"parent":1},{"position":[0,0,0],"radius":1,"parent":-1}])";

std::string with(const std::string& shapes, const std::string& organs) {
  return std::string("{\"format\":\"cambium-skeleton\",\"version\":1,") + kNodes + ",\n\"shapes\":" + shapes + ",\n\"organs\":" + organs +
         "}";
}

constexpr const char* kShape = R"([{"name":"l","vertices":[[0,0,0],[1,0,0],[0,1,0]],"triangles":[[0,1,2]]}])";
constexpr const char* kFrame = R"("position":[0,0,0],"left":[-1,0,0],"heading":[0,0,1],"up":[0,1,0])";

TEST(FoliageJson, OrgansFollowTheirNodesWhereParentsArePutFirst) {
  const Plant plant = parse_plant_json(with(kShape, std::string(R"([{"shape":0,"node":0,"scale":1,)") + kFrame + "}]"), "p");
  ASSERT_EQ(plant.skeleton.nodes[0].parent, -1);
  EXPECT_EQ(plant.foliage.organs[0].node, 1);
}

TEST(FoliageJson, RefusesMalformedFilesNamingLineAndColumn) {
  const std::string frame = kFrame;
  const auto organ = [&](const std::string& head) { return with(kShape, "[{" + head + "," + frame + "}]"); };
  const struct { std::string text; int line, column; const char* in_message; } table[] = {
      {with("3", "[]"), 2, 10, "array"},
      {with("[{}]", "[]"), 2, 11, "name"},
      {with(R"([{"name":3}])", "[]"), 2, 19, "string"},
      {with(R"([{"name":"l","vertices":[[0,0]]}])", "[]"), 2, 35, "3"},
      {with(R"([{"name":"l","triangles":[[0,1,2]]}])", "[]"), 2, 37, "number 0"},
      {with(R"([{"name":"l","vertices":[[0,0,0]],"triangles":[[0,0,1]]}])", "[]"), 2, 62, "from 0 to 0"},
      {with(R"([{"name":"l","vertices":[[0,0,0]],"triangles":[[0,0]]}])", "[]"), 2, 57, "3"},
      {with(R"([{"name":"l","sides":2}])", "[]"), 2, 23, "sides"},
      {with("[]", R"([{"shape":0}])"), 3, 11, "no shape"},
      {organ(R"("shape":1,"node":0,"scale":1)"), 3, 20, "from 0 to 0"},
      {organ(R"("shape":0,"node":2,"scale":1)"), 3, 29, "from -1 to 1"},
      {organ(R"("shape":0,"node":-2,"scale":1)"), 3, 29, "from -1 to 1"},
      {organ(R"("shape":0,"node":0,"scale":0)"), 3, 39, "above 0"},
      {organ(R"("shape":0,"node":0,"scale":1,"color":-1)"), 3, 49, "from 0"},
      {organ(R"("shape":0,"node":0)"), 3, 11, "scale"},
      {organ(R"("shape":0,"node":0,"scale":1,"size":3)"), 3, 41, "size"},
      {with(kShape, R"([{"shape":0,"node":0,"scale":1,"position":[0,0,0],"left":[-1,0,0],"heading":[0,0,1],"up":[0,-1,0]}])"), 3, 11,
       "left x heading"},
      {with(kShape, R"([{"shape":0,"node":0,"scale":1,"position":[0,0,0],"left":[-2,0,0],"heading":[0,0,0.5],"up":[0,1,0]}])"), 3, 11,
       "unit"},
  };
  for (const auto& bad : table) expect_refused({bad.text.c_str(), bad.line, bad.column, bad.in_message}, parse_plant_json);
}

}  // namespace
}  // namespace cambium
