#include "cli/mesh_look.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "raytrace/image_file.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

void write_image(const std::string& path, const std::string& format, int width, int height) {
  Pixels pixels{width, height, 3, {}, true};
  for (int i = 0; i < width * height; ++i)
    for (const float value : {0.8f, 0.4f, 0.1f}) pixels.data.push_back(value);
  const SampleType type = format == ".png" ? SampleType::kUint8 : SampleType::kFloat;
  write_pixels(pixels, {.channel_names = {"R", "G", "B"}, .sample_types = std::vector<SampleType>(3, type)}, path, format);
}

constexpr const char* kTwoBarks = R"([skeleton]
file = "a.skel.json"
[[bark.order]]
texture = "bark.png"
[[bark.order]]
style = "smooth"
color = [0.1, 0.2, 0.3]
crack_color = [0.1, 0.2, 0.3]
)";

/// The vertex colour halfway along a plain branch of the given order.
std::array<std::uint8_t, 4> color_on(const MeshLook& look, std::uint32_t order, double around = 0, double spacing = 0) {
  BlobTreeBuilder builder;
  const NodeId id = builder.add(Chain{{{Vec3(0), 0.1}, {Vec3(0, 0, 1), 0.1}}});
  builder.set_attributes(id, {0, order, 0, Vec3(1, 0, 0)});
  const Field field(builder.build(id));
  Evaluator evaluator;
  const Vec3 n(std::cos(around), std::sin(around), 0), p = 0.1 * n + Vec3(0, 0, 0.5);
  std::vector<Contribution> contributions;
  evaluator.contributions(field.whole(), p, contributions);
  return vertex_colors(look.bark)(contributions, evaluator.surface_traits(field.whole(), p), {p, n, spacing});
}

TEST(MeshLook, TexturesGoAlongAsTheyAreAndColoursThenOnlyTintThem) {
  TemporaryFolder folder;
  write_image(folder.path("bark.png"), ".png", 8, 4);
  const MeshLook look = mesh_look(read_recipe(folder.write("a.tree.toml", kTwoBarks), {}), true);
  ASSERT_EQ(look.materials.size(), 2u);
  ASSERT_TRUE(look.materials[0].texture);
  EXPECT_EQ(*look.materials[0].texture, folder.read("bark.png"));
  EXPECT_FALSE(look.materials[1].texture);
  EXPECT_DOUBLE_EQ(look.aspect, 2);
  const auto textured = color_on(look, 0), plain = color_on(look, 1);
  EXPECT_GT(textured[0], 200);
  EXPECT_EQ(textured[0], textured[2]);
  EXPECT_LT(plain[0], plain[2]);
}

TEST(MeshLook, VerticesShowNothingFinerThanTheMesh) {
  const Recipe recipe = empty_recipe("a.skel.json", {});
  const MeshLook look = mesh_look(recipe, false);
  std::set<std::array<std::uint8_t, 4>> close, coarse;
  for (int i = 0; i < 12; ++i) {
    close.insert(color_on(look, 0, 0.5 * i, 1e-4));
    coarse.insert(color_on(look, 0, 0.5 * i, 1.0));
  }
  EXPECT_GT(close.size(), 6u);
  EXPECT_EQ(coarse.size(), 1u);
}

TEST(MeshLook, MapsGoAlongUnlessTheirNormalsPointTheOtherWay) {
  TemporaryFolder folder;
  for (const char* name : {"bark.png", "normal.png", "rough.png"}) write_image(folder.path(name), ".png", 4, 4);
  const std::string recipe = "[skeleton]\nfile = \"a.skel.json\"\n[bark]\ntexture = \"bark.png\"\nnormal_map = \"normal.png\"\n"
                             "roughness_map = \"rough.png\"\n";
  const MeshLook look = mesh_look(read_recipe(folder.write("a.tree.toml", recipe), {}), true);
  ASSERT_TRUE(look.materials.at(0).normal_map && look.materials[0].roughness_map);
  EXPECT_EQ(*look.materials[0].normal_map, folder.read("normal.png"));
  EXPECT_EQ(look.materials[0].roughness, 1);
  EXPECT_TRUE(look.warnings.empty());
  const MeshLook other = mesh_look(read_recipe(folder.write("b.tree.toml", recipe + "normal_convention = \"directx\"\n"), {}), true);
  EXPECT_FALSE(other.materials.at(0).normal_map);
  ASSERT_EQ(other.warnings.size(), 1u);
  EXPECT_NE(other.warnings[0].find("normal.png"), std::string::npos);
}

TEST(MeshLook, WithoutRoomForTexturesTheirColoursAreInTheVertices) {
  TemporaryFolder folder;
  write_image(folder.path("bark.png"), ".png", 8, 4);
  const MeshLook look = mesh_look(read_recipe(folder.write("a.tree.toml", kTwoBarks), {}), false);
  EXPECT_FALSE(look.materials[0].texture);
  EXPECT_EQ(look.aspect, 1);
  const auto color = color_on(look, 0);
  EXPECT_NEAR(color[0], 204, 4);
  EXPECT_NEAR(color[2], 26, 4);
}

TEST(MeshLook, ImagesThatNoMeshTakesBecomeVertexColours) {
  TemporaryFolder folder;
  write_image(folder.path("bark.exr"), ".exr", 4, 4);
  const Recipe recipe = read_recipe(folder.write("a.tree.toml", "[skeleton]\nfile = \"a.skel.json\"\n[bark]\ntexture = \"bark.exr\"\n"), {});
  const MeshLook look = mesh_look(recipe, true);
  EXPECT_FALSE(look.materials.at(0).texture);
  ASSERT_EQ(look.warnings.size(), 1u);
  EXPECT_NE(look.warnings[0].find("bark.exr"), std::string::npos);
  EXPECT_GT(color_on(look, 0)[0], color_on(look, 0)[2] + 100);
}

TEST(MeshLook, TheBuiltInBarkHasAMaterialForEveryOrder) {
  TemporaryFolder folder;
  const MeshLook look = mesh_look(read_recipe(folder.write("a.tree.toml", "[skeleton]\nfile = \"a.skel.json\"\n"), {}), true);
  EXPECT_EQ(look.materials.size(), poplar_bark().size());
  for (const MeshMaterial& material : look.materials) EXPECT_FALSE(material.texture);
}

}  // namespace
}  // namespace cambium
