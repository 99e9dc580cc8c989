#include "cli/recipe_light.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cli/job.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

/// The [render] part of a recipe; the text begins in its third line.
RenderRecipe read(const std::string& text) {
  TemporaryFolder folder;
  return read_recipe(folder.write("a.tree.toml", "[skeleton]\nfile = \"b.swc\"\n" + text), {}).render;
}

TEST(RecipeLight, DaylightIsTheDefault) {
  const RenderRecipe r = read("[render.light]\nturbidity = 4\nsun_elevation = 30\n");
  EXPECT_EQ(r.light.sky, SkyKind::kDaylight);
  EXPECT_DOUBLE_EQ(r.light.turbidity, 4);
  EXPECT_DOUBLE_EQ(r.light.sun_elevation, std::numbers::pi / 6);
  EXPECT_FALSE(r.light.sun_color);
  EXPECT_TRUE(r.light.sun && r.light.ground && !r.light.catcher);
  EXPECT_EQ(read("[render.light]\nsun = false\nsun_elevation = 3").light.sun, false);
}

TEST(RecipeLight, ColoursOfTheSkyMakeItAGradient) {
  const RenderRecipe r = read("[render.light]\nsky_zenith = [0, 0, 1]\n");
  EXPECT_EQ(r.light.sky, SkyKind::kGradient);
  EXPECT_EQ(r.light.sky_zenith, Vec3(0, 0, 1));
  EXPECT_EQ(read("[render.light]\nsky = \"gradient\"\n").light.sky, SkyKind::kGradient);
}

TEST(RecipeLight, AnImageIsAllThereIsUnlessASunIsAskedFor) {
  const RenderRecipe r = read("[render.light]\nenvironment = \"room.exr\"\nenvironment_rotation = 90\nenvironment_strength = 2\n");
  EXPECT_EQ(r.light.sky, SkyKind::kEnvironment);
  EXPECT_EQ(r.environment->file.filename(), "room.exr");
  EXPECT_DOUBLE_EQ(r.environment->rotation, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(r.environment->strength, 2);
  EXPECT_FALSE(r.light.sun);
  EXPECT_TRUE(read("[render.light]\nenvironment = \"room.exr\"\nsun = true\nsun_azimuth = 3").light.sun);
}

TEST(RecipeLight, LampsAreRead) {
  const RenderRecipe r = read(R"([[render.light.area]]
position = [0, 0, "50cm"]
target = [0, 0, 0]
size = [2, "10cm"]
intensity = 4
color = [1, 0.5, 0]
[[render.light.area]]
shape = "sphere"
radius = 0.2
visible = false
)");
  ASSERT_EQ(r.light.area.size(), 2u);
  const AreaLight& panel = r.light.area[0];
  EXPECT_EQ(panel.shape, AreaLight::Shape::kRectangle);
  EXPECT_EQ(panel.direction, Vec3(0, 0, -0.5));
  EXPECT_DOUBLE_EQ(panel.width, 2);
  EXPECT_DOUBLE_EQ(panel.height, 0.1);
  EXPECT_EQ(panel.radiance, Vec3(4, 2, 0));
  EXPECT_EQ(r.light.area[1].shape, AreaLight::Shape::kSphere);
  EXPECT_DOUBLE_EQ(r.light.area[1].radius, 0.2);
  EXPECT_FALSE(r.light.area[1].visible);
}

TEST(RecipeLight, GroundAndBackground) {
  EXPECT_TRUE(read("[render.light]\nground = \"catcher\"\n").light.catcher);
  EXPECT_FALSE(read("[render.light]\nground = false\n").light.ground);
  EXPECT_EQ(read("[render]\nbackground = \"transparent\"\n").light.backdrop, Backdrop::kTransparent);
  EXPECT_EQ(read("[render]\nbackground = \"sky\"\n").light.backdrop, Backdrop::kSky);
  const RenderRecipe r = read("[render]\nbackground = \"#ffffff\"\nbounces = 3\nclamp = 20\nocclusion_distance = \"20cm\"\n");
  EXPECT_EQ(r.light.backdrop, Backdrop::kColor);
  EXPECT_EQ(r.light.backdrop_color, Vec3(1.0));
  EXPECT_EQ(r.paths.bounces, 3);
  EXPECT_DOUBLE_EQ(r.paths.clamp, 20);
  EXPECT_DOUBLE_EQ(r.paths.occlusion_distance, 0.2);
}

TEST(RecipeLight, WhatDoesNotGoTogetherIsRefusedAtItsPlace) {
  struct Case {
    const char* text;
    int line, column;
    const char* found;
  };
  const Case table[] = {
      {"[render]\nbackground = \"blue\"", 4, 14, "the string 'blue'"},
      {"[render]\nbounces = -1", 4, 11, "the number -1"},
      {"[render.light]\nsky = \"dawn\"", 4, 7, "the string 'dawn'"},
      {"[render.light]\nturbidity = 1", 4, 13, "the number 1"},
      {"[render.light]\nsky_zenith = [0,0,1]\nturbidity = 3", 5, 13, "'render.light.turbidity'"},
      {"[render.light]\nsky = \"daylight\"\nsky_zenith = [0,0,1]", 5, 14, "'render.light.sky_zenith'"},
      {"[render.light]\nenvironment = \"a.exr\"\nsky_horizon = [0,0,1]", 5, 15, "'render.light.sky_horizon'"},
      {"[render.light]\nenvironment = \"a.exr\"\nsky = \"daylight\"", 4, 15, "'render.light.environment'"},
      {"[render.light]\nenvironment_rotation = 10", 4, 24, "'render.light.environment_rotation'"},
      {"[render.light]\nenvironment = \"a.exr\"\nsun_elevation = 10", 5, 17, "'render.light.sun_elevation'"},
      {"[render.light]\nsun = false\nsun_color = [1,1,1]", 5, 13, "'render.light.sun_color'"},
      {"[render.light]\nground = \"glass\"", 4, 10, "the string 'glass'"},
      {"[[render.light.area]]\nshape = \"cube\"", 4, 9, "the string 'cube'"},
      {"[[render.light.area]]\nradius = 1", 4, 10, "'render.light.area.0.radius'"},
      {"[[render.light.area]]\nshape = \"disc\"\nsize = [1, 1]", 5, 8, "'render.light.area.0.size'"},
      {"[[render.light.area]]\nshape = \"sphere\"\ndirection = [0, 0, 1]", 5, 13, "'render.light.area.0.direction'"},
      {"[[render.light.area]]\nposition = [0, 0, 1]\ntarget = [0, 0, 1]", 5, 10, "'render.light.area.0.target'"},
  };
  for (const Case& bad : table) {
    SCOPED_TRACE(bad.text);
    try {
      read(bad.text);
      ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, bad.line) << error.what();
      EXPECT_EQ(error.location().column, bad.column) << error.what();
      EXPECT_NE(error.found().find(bad.found), std::string::npos) << error.what();
    }
  }
}

TEST(RecipeLight, AnImageThatIsNoneIsRefusedWhereItIsNamed) {
  TemporaryFolder folder;
  folder.write("text.exr", "not an image");
  for (const char* name : {"none.exr", "text.exr"}) {
    const std::string text = std::string("[skeleton]\nfile = \"b.swc\"\n[render.light]\nenvironment = \"") + name + "\"\n";
    const Recipe recipe = read_recipe(folder.write("a.tree.toml", text), {});
    try {
      load_surroundings(recipe.render);
      ADD_FAILURE() << name << " was read";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, 4);
      EXPECT_EQ(error.location().column, 15);
      EXPECT_NE(error.found().find(name), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace cambium
