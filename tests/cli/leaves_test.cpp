#include "cli/leaves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "program.h"
#include "raytrace/image_file.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

constexpr const char* kLeafy = R"({"format":"cambium-skeleton","version":1,"nodes":[
{"position":[0,0,0],"radius":0.1,"parent":-1},
{"position":[0,0,1],"radius":0.1,"parent":0,"lateral":false},
{"position":[0,0,2],"radius":0.08,"parent":1,"lateral":false},
{"position":[0.5,0,1.6],"radius":0.05,"parent":1,"lateral":true}],
"shapes":[{"name":"blade"},
{"name":"polygon1","vertices":[[0,0,0],[0.3,0.5,0],[0,1,0],[-0.3,0.5,0]],"triangles":[[0,1,2],[0,2,3]]}],
"organs":[
{"shape":0,"node":2,"position":[0,0,2],"left":[-1,0,0],"heading":[0,0,1],"up":[0,1,0],"scale":0.5},
{"shape":1,"node":3,"position":[0.5,0,1.6],"left":[0,1,0],"heading":[1,0,0],"up":[0,0,-1],"scale":0.2,"color":2},
{"shape":1,"node":3,"position":[0.5,0,1.6],"left":[-1,0,0],"heading":[0,0,1],"up":[0,1,0],"scale":0.3}]})";

constexpr const char* kRecipe = "[skeleton]\nfile = \"a.skel.json\"\n[mesh]\nvoxel = \"4cm\"\n[render]\nsize = \"24x32\"\nsamples = 1\n";

void write_leaf_image(const std::string& path) {
  Pixels pixels{2, 4, 4, {}, true};
  for (int i = 0; i < 8; ++i)
    for (const float value : {0.2f, 0.5f, 0.1f, i < 2 ? 0.0f : 1.0f}) pixels.data.push_back(value);
  write_pixels(pixels, {{"R", "G", "B", "A"}, std::vector<SampleType>(4, SampleType::kUint8)}, path, ".png");
}

Foliage two_organs() {
  Foliage foliage;
  foliage.shapes = {{"blade", {}, {}}, {"polygon1", {{0, 0, 0}, {0.3, 0.5, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
  foliage.organs.resize(2);
  foliage.organs[0].scale = 0.5;
  foliage.organs[1].shape = 1;
  foliage.organs[1].scale = 0.2;
  foliage.organs[1].position = {1, 2, 3};
  return foliage;
}

const std::vector<std::uint32_t> kBranches{0, 4};

TEST(Leaves, WithoutTablesOutlinesAreAsDrawnAndNamesArePlainLeavesAllGreen) {
  const Leaves leaves = dress_leaves(Recipe{}, two_organs(), kBranches);
  ASSERT_EQ(leaves.scene.instances.size(), 2u);
  EXPECT_EQ(leaves.shapeless, (std::map<std::string, std::size_t>{{"blade", 1}}));
  EXPECT_EQ(leaves.scene.shapes[1].sheet.triangles.size(), 1u);
  EXPECT_GT(leaves.scene.shapes[0].sheet.triangles.size(), 4u);
  ASSERT_EQ(leaves.scene.materials.size(), 1u);
  const Vec3 color = leaves.scene.materials[0].color;
  EXPECT_GT(color.y, color.x);
  EXPECT_GT(color.x, color.z);
  EXPECT_EQ(leaves.scene.instances[1].branch, 4);
  EXPECT_EQ(leaves.scene.instances[1].position, Vec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(glm::length(leaves.scene.instances[1].axes[1]), 0.2);
  EXPECT_EQ(leaves.triangles(), leaves.scene.shapes[0].sheet.triangles.size() + 1);
}

TEST(Leaves, TheFirstTableThatMatchesIsTheOrgans) {
  Recipe recipe;
  recipe.leaf.resize(3);
  recipe.leaf[0].name = "polygon";
  recipe.leaf[0].color = Vec3(1, 0, 0);
  recipe.leaf[0].card = {0.04, 0.06};
  recipe.leaf[1].name = "polygon1";
  recipe.leaf[2].name = "*";
  recipe.leaf[2].scale = 3;
  const Leaves leaves = dress_leaves(recipe, two_organs(), kBranches);
  EXPECT_EQ(leaves.scene.shapes[1].material, 0u);
  EXPECT_EQ(leaves.scene.shapes[0].material, 2u);
  EXPECT_DOUBLE_EQ(glm::length(leaves.scene.instances[0].axes[0]), 1.5);
  // A card in place of an outline has its own size, whatever that of the outline was.
  EXPECT_DOUBLE_EQ(glm::length(leaves.scene.instances[1].axes[0]), 1);
}

TEST(Leaves, OrgansWithoutSizeAreLeftOutAndThoseBeyondFloatsRefused) {
  Foliage foliage = two_organs();
  for (OrganPlacement& organ : foliage.organs) organ.scale = 0;
  EXPECT_TRUE(dress_leaves(Recipe{}, foliage, kBranches).scene.instances.empty());
  const auto refused = [](void (*spoil)(Foliage&)) {
    Foliage spoiled = two_organs();
    spoil(spoiled);
    EXPECT_THROW(dress_leaves(Recipe{}, spoiled, kBranches), InputError);
  };
  refused([](Foliage& f) { f.organs[1].position.x = std::numeric_limits<double>::infinity(); });
  refused([](Foliage& f) { f.organs[1].position.x = 2e9; });
  refused([](Foliage& f) { f.organs[0].scale = 1e300; });
  refused([](Foliage& f) { f.organs[1].scale = std::numeric_limits<double>::infinity(); });
  refused([](Foliage& f) { f.shapes[1].vertices[2].y = 1e99; });
}

TEST(Leaves, MergedTheyLieWhereTheyAreAndKnowWhereTheyAreHeld) {
  std::vector<std::string> warnings;
  const auto parts = merged_leaves(Recipe{}, dress_leaves(Recipe{}, two_organs(), kBranches), warnings);
  ASSERT_EQ(parts.size(), 1u);
  const MeshLeaves& part = parts[0];
  const std::size_t last = part.sheet.positions.size() - 1;   // the outline's third corner
  EXPECT_LT(glm::distance(part.sheet.positions[last], glm::vec3(1, 2, 3.2)), 1e-6f);
  EXPECT_EQ(part.pivot[last], glm::vec3(1, 2, 3));
  EXPECT_EQ(part.branch[last], 4u);
  EXPECT_EQ(part.branch[0], 0u);
  for (const glm::vec3& n : part.sheet.normals) EXPECT_LT(glm::distance(n, glm::vec3(0, 1, 0)), 1e-6f);
  EXPECT_TRUE(part.material.leaf);
  EXPECT_TRUE(warnings.empty());
}

TEST(Leaves, MeshFilesWithAPlaceForThemHoldThemTheOthersSayThatTheyDoNot) {
  TemporaryFolder folder;
  const std::string skeleton = folder.write("a.skel.json", kLeafy);
  const std::vector<std::string> common{"--set", "mesh.voxel=4cm", "--json"};
  const auto mesh = [&](const std::string& name, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"mesh", skeleton, "-o", folder.path(name)};
    arguments.insert(arguments.end(), common.begin(), common.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
  };
  const Ran glb = mesh("a.glb"), obj = mesh("a.obj"), ply = mesh("a.ply"), bare = mesh("b.glb", {"--no-leaves"});
  for (const Ran* ran : {&glb, &obj, &ply, &bare}) EXPECT_EQ(ran->status, 0) << ran->err;
  EXPECT_NE(Json::parse(glb.out)["leaves"]["organs"], 0);
  EXPECT_EQ(Json::parse(glb.out)["leaves"]["without_shape"]["blade"], 1);
  EXPECT_NE(folder.read("a.glb").find("\"leaves\""), std::string::npos);
  EXPECT_NE(folder.read("a.obj").find("o leaves"), std::string::npos);
  EXPECT_NE(ply.err.find("leaves are left out"), std::string::npos);
  EXPECT_FALSE(Json::parse(ply.out).contains("leaves"));
  EXPECT_FALSE(Json::parse(bare.out).contains("leaves"));
  EXPECT_EQ(folder.read("b.glb").find("\"leaves\""), std::string::npos);
  EXPECT_EQ(Json::parse(glb.out)["triangles"], Json::parse(bare.out)["triangles"]) << "the wood is the same";
}

TEST(Leaves, GrowKeepsThemAndInfoCountsThem) {
  TemporaryFolder folder;
  const std::string skeleton = folder.write("a.skel.json", kLeafy);
  ASSERT_EQ(run_program({"grow", skeleton, "-o", folder.path("b.skel.json")}).status, 0);
  ASSERT_EQ(run_program({"grow", folder.path("b.skel.json"), "-o", folder.path("c.skel.json")}).status, 0);
  EXPECT_EQ(folder.read("b.skel.json"), folder.read("c.skel.json"));
  const Json info = Json::parse(run_program({"info", folder.path("b.skel.json"), "--json"}).out);
  EXPECT_EQ(info["organs"]["blade"], 1);
  EXPECT_EQ(info["organs"]["polygon1"], 2);
  const Ran swc = run_program({"grow", skeleton, "-o", folder.path("b.swc")});
  EXPECT_EQ(swc.status, 0);
  EXPECT_NE(swc.err.find("leaves are left out"), std::string::npos);
  const Ran pruned = run_program({"info", skeleton, "--json", "--set", "prune.0.branch=1", "--set", "prune.0.distance=0.1"});
  EXPECT_EQ(Json::parse(pruned.out)["organs_pruned"], 2) << pruned.err;
}

TEST(Leaves, AnLSystemsOutlinesAreDrawn) {
  TemporaryFolder folder;
  const std::string model =
      folder.write("a.l", "lsystem: a\nderivation length: 1\naxiom: !(0.1)F(1)A\nA --> [&(40){-(30)f(0.2)+(60)f(0.2)+(120)f(0.2)}]\nendlsystem\n");
  const Ran ran = run_program({"mesh", model, "-o", folder.path("a.glb"), "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(Json::parse(ran.out)["leaves"]["organs"], 1);
}

TEST(Leaves, AGivenMeshAndACutOutImageAreUsed) {
  TemporaryFolder folder;
  folder.write("a.skel.json", kLeafy);
  folder.write("leaf.obj", "v 0 0 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\n");
  write_leaf_image(folder.path("leaf.png"));
  const std::string recipe = folder.write("a.tree.toml", std::string(kRecipe) +
      "[[leaf]]\nname = \"blade\"\nmesh = \"leaf.obj\"\n[[leaf]]\nsize = [\"10cm\", \"20cm\"]\ntexture = \"leaf.png\"\n");
  const Ran mesh = run_program({"mesh", recipe, "-o", folder.path("a.glb"), "--json"});
  ASSERT_EQ(mesh.status, 0) << mesh.err;
  EXPECT_EQ(Json::parse(mesh.out)["leaves"]["triangles"], 1 + 2 * 2);
  const std::string glb = folder.read("a.glb");
  EXPECT_NE(glb.find("\"alphaMode\":\"MASK\""), std::string::npos);
  EXPECT_NE(glb.find("\"doubleSided\":true"), std::string::npos);
  const Ran render = run_program({"render", recipe, "-o", folder.path("a.png"), "--json"}),
            bare = run_program({"render", recipe, "-o", folder.path("b.png"), "--json", "--set", "leaves=false"});
  EXPECT_EQ(render.status, 0) << render.err;
  EXPECT_EQ(bare.status, 0) << bare.err;
  EXPECT_NE(folder.read("a.png"), folder.read("b.png"));
}

TEST(Leaves, FilesThatCannotBeReadAreNamedWithTheirPlace) {
  TemporaryFolder folder;
  folder.write("a.skel.json", kLeafy);
  folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
  folder.write("bad.png", "no image");
  const auto refused = [&](const std::string& table) {
    const std::string recipe = folder.write("a.tree.toml", std::string(kRecipe) + "[[leaf]]\n" + table + "\n");
    const Ran ran = run_program({"mesh", recipe, "-o", folder.path("a.glb")});
    EXPECT_EQ(ran.status, 2) << table;
    EXPECT_FALSE(folder.has("a.glb"));
    return ran.err;
  };
  EXPECT_NE(refused("mesh = \"none.obj\"").find("a.tree.toml:9:"), std::string::npos);
  EXPECT_NE(refused("mesh = \"bad.obj\"").find("bad.obj:2:5: "), std::string::npos);
  EXPECT_NE(refused("texture = \"none.png\"").find("a.tree.toml:9:"), std::string::npos);
  EXPECT_NE(refused("texture = \"bad.png\"").find("bad.png"), std::string::npos);
}

}  // namespace
}  // namespace cambium
