#include "cli/recipe.h"

#include <gtest/gtest.h>

#include <numbers>

#include "temporary_folder.h"

namespace cambium {
namespace {

Recipe read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  TemporaryFolder folder;
  return read_recipe(folder.write("a.tree.toml", text), overrides);
}

constexpr const char* kFull = R"(# a comment
[skeleton]
lsystem = "poplar.l"
steps = 9
seed = 3
step = "5cm"
angle = 45
width = "2cm"
tropism = [0, 0, -1]
elasticity = 0.2
[surface]
profile = "galbraith"
ridges = false
lip = 1.5
width = 0.4
bend = [0, 12]
[surface.conditioning]
smooth = 2
min_radius = "1mm"
[[prune]]
branch = 3
distance = 0.2
[[prune]]
position = [0, "10cm", 2]
normal = [0, 0, 1]
[[scar]]
branch = 0
along = 1
angle = 90
depth = 2
[scars]
count = 12
min_radius = "3cm"
[bark]
style = "plated"
texture_size = "30cm"
[[bark.order]]
color = [0.1, 0.2, 0.3]
[[bark.order]]
style = "smooth"
texture = "bark.png"
[render]
size = "20x30"
samples = "2..4"
noise = 0.01
filter = 2
crop = [1, 2, 11, 12]
smooth = false
exposure = "-1 stop"
background = "#ffffff"
[render.camera]
azimuth = 180
f_number = 2.8
focus = [0, 0, "1m"]
close_up = 3
frame = [[1, 1, 1], [0, 0, 0]]
[render.light]
ground = false
[mesh]
tolerance = "0.5mm"
lod = [1200000, "50k", "20k"]
occlusion = false
[volume]
voxel = "5mm"
kind = "fog"
)";

TEST(Recipe, EveryPartIsRead) {
  const Recipe recipe = read(kFull);
  EXPECT_EQ(recipe.skeleton.lsystem->filename(), "poplar.l");
  EXPECT_EQ(recipe.skeleton.steps, 9);
  EXPECT_EQ(recipe.skeleton.seed, 3u);
  EXPECT_DOUBLE_EQ(recipe.skeleton.turtle.step, 0.05);
  EXPECT_DOUBLE_EQ(recipe.skeleton.turtle.angle.value_or(0), std::numbers::pi / 4);
  EXPECT_EQ(recipe.surface.profile, Profile::kGalbraith);
  EXPECT_FALSE(recipe.surface.ridges);
  EXPECT_DOUBLE_EQ(recipe.surface.lip, 1.5);
  ASSERT_EQ(recipe.surface.bend.size(), 2u);
  EXPECT_DOUBLE_EQ(recipe.surface.bend[1], std::numbers::pi / 15);
  EXPECT_DOUBLE_EQ(*recipe.surface.conditioning.min_radius, 0.001);
  ASSERT_EQ(recipe.surface.prunes.size(), 2u);
  EXPECT_EQ(recipe.surface.prunes[0].where.branch, 3u);
  EXPECT_EQ(recipe.surface.prunes[1].where.position, Vec3(0, 0.1, 2));
  EXPECT_EQ(recipe.prunes_at[1].line, 23);
  ASSERT_EQ(recipe.surface.scars.size(), 1u);
  EXPECT_DOUBLE_EQ(recipe.surface.scars[0].angle, std::numbers::pi / 2);
  EXPECT_EQ(recipe.surface.random_scars.count, 12);
  ASSERT_EQ(recipe.bark.size(), 2u);
  EXPECT_EQ(recipe.bark[0].material.style, BarkStyle::kPlated);
  EXPECT_EQ(recipe.bark[0].material.color, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(recipe.bark[1].material.style, BarkStyle::kSmooth);
  EXPECT_DOUBLE_EQ(recipe.bark[1].material.texture_size, 0.3);
  EXPECT_EQ(recipe.bark[1].texture->file.filename(), "bark.png");
  EXPECT_EQ(recipe.render.width, 20);
  EXPECT_EQ(recipe.render.height, 30);
  EXPECT_EQ(recipe.render.sampling.min, 2);
  EXPECT_EQ(recipe.render.sampling.max, 4);
  EXPECT_DOUBLE_EQ(recipe.render.sampling.noise, 0.01);
  EXPECT_DOUBLE_EQ(recipe.render.sampling.filter_radius, 2);
  EXPECT_EQ(recipe.render.crop, (PixelRect{1, 2, 11, 12}));
  EXPECT_FALSE(recipe.render.smooth);
  EXPECT_DOUBLE_EQ(recipe.render.exposure, 0.5);
  EXPECT_EQ(recipe.render.light.backdrop_color, Vec3(1.0));
  EXPECT_FALSE(recipe.render.light.ground);
  EXPECT_EQ(recipe.render.camera.frame->hi, Vec3(1.0));
  EXPECT_EQ(recipe.render.camera.f_number, 2.8);
  EXPECT_EQ(recipe.render.camera.focus, Vec3(0, 0, 1));
  EXPECT_EQ(recipe.render.close_up->id, 3u);
  EXPECT_GT(recipe.render.close_up->at.line, 40);
  EXPECT_DOUBLE_EQ(*recipe.mesh.polygonize.tolerance, 0.0005);
  EXPECT_EQ(recipe.mesh.lod, (std::vector<std::size_t>{1200000, 50000, 20000}));
  EXPECT_FALSE(recipe.mesh.occlusion);
  EXPECT_EQ(recipe.volume.kind, VolumeKind::kFog);
}

TEST(Recipe, LevelsOfTheCommandLineDescend) {
  EXPECT_EQ(parse_levels("1.2M,50k,5000", {"--lod"}), (std::vector<std::size_t>{1200000, 50000, 5000}));
  EXPECT_EQ(parse_levels("7", {"--lod"}), std::vector<std::size_t>{7});
  for (const char* text : {"", ",", "5k,", ",5k", "5k,5k", "5k,6k", "5k;2k", "5k,-1"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(parse_levels(text, {"--lod"}), InputError);
  }
}

TEST(Recipe, PathsAreRelativeToTheRecipe) {
  TemporaryFolder folder;
  const Recipe recipe = read_recipe(folder.write("a.tree.toml", "[skeleton]\nfile = \"b.swc\"\n"), {});
  EXPECT_EQ(recipe.skeleton.file->string(), folder.path("b.swc"));
}

struct Malformed {
  const char* text;
  int line, column;
  const char* found;  // a part of it
};

TEST(Recipe, MalformedOnesAreRefusedAtTheirPlace) {
  const Malformed table[] = {
      {"[skeleton\nfile = 1", 1, 10, ""},
      {"[skeleton]\nlsystem = \"a.l\"\nlsytem = \"b.l\"", 3, 1, "unknown key 'skeleton.lsytem'"},
      {"[tree]\n", 1, 2, "unknown key 'tree'"},
      {"skeleton = 3", 1, 12, "the number 3 for 'skeleton'"},
      {"[skeleton]\nlsystem = 3", 2, 11, "the number 3 for 'skeleton.lsystem'"},
      {"[skeleton]\nlsystem = \"a.l\"\nfile = \"b.swc\"", 3, 8, "the string 'b.swc'"},
      {"[skeleton]\ngraph = \"g.json\"", 2, 9, "'skeleton.graph'"},
      {"[skeleton]\nlsystem = \"\"", 2, 11, "the string ''"},
      {"[skeleton]\nsteps = -1", 2, 9, "the number -1"},
      {"[skeleton]\nsteps = 1.5", 2, 9, "the number 1.5"},
      {"[skeleton]\nstep = \"5 miles\"", 2, 8, "'5 miles'"},
      {"[skeleton]\ntropism = [0, 0]", 2, 11, "an array of 2"},
      {"[skeleton]\ntropism = [0, 0, 0]", 2, 11, "an array of 3"},
      {"[surface]\nlip = nan", 2, 7, "the number nan"},
      {"[surface]\nlip = 4.5", 2, 7, "the number 4.5"},
      {"[surface]\nwidth = 0", 2, 9, "the number 0"},
      {"[surface]\nprofile = \"round\"", 2, 11, "the string 'round'"},
      {"[surface]\nridges = \"yes\"", 2, 10, "the string 'yes'"},
      {"[surface]\nbend = [0, \"x\"]", 2, 12, "'surface.bend.1'"},
      {"[surface.conditioning]\nmin_radius = 0", 2, 14, "the number 0"},
      {"prune = 3", 1, 9, "the number 3"},
      {"[[prune]]\ndistance = 1", 1, 1, "a table for 'prune.0'"},
      {"[[prune]]\nbranch = 1\nposition = [0,0,0]", 1, 1, "a table for 'prune.0'"},
      {"[[prune]]\nbranch = -1", 2, 10, "the number -1"},
      {"[[scar]]\nbranch = 1\nradius = -1", 3, 10, "the number -1"},
      {"[scars]\ncount = 1.5", 2, 9, "the number 1.5"},
      {"[bark]\nstyle = \"furry\"", 2, 9, "the string 'furry'"},
      {"[bark]\ncolor = \"#12345\"", 2, 9, "the string '#12345'"},
      {"[bark]\nnormal_map = \"n.png\"", 2, 14, "a normal map alone"},
      {"[bark]\ntexture = \"t.png\"\nnormal_convention = \"blue\"", 3, 21, "the string 'blue'"},
      {"[bark]\nmature_radius = \"-1cm\"", 2, 17, "-1cm"},
      {"[[bark.order]]\norder = 1", 2, 1, "unknown key 'bark.order.0.order'"},
      {"[render]\nsize = \"0x0\"", 2, 8, "'0x0'"},
      {"[render]\nsize = [0, 10]", 2, 9, "the number 0"},
      {"[render]\nsamples = 0", 2, 11, "the number 0"},
      {"[render]\nsamples = \"8..4\"", 2, 11, "'8..4'"},
      {"[render]\nnoise = -1", 2, 9, "the number -1"},
      {"[render]\nfilter = 9", 2, 10, "the number 9"},
      {"[render]\ncrop = [0, 0, 8]", 2, 8, "an array of 3"},
      {"[render]\ncrop = [8, 0, 8, 8]", 2, 8, "an array of 4"},
      {"[render]\nexposure = \"2 steps\"", 2, 12, "'2 steps'"},
      {"[render.camera]\nfov = 0", 2, 7, "the number 0"},
      {"[render.camera]\nf_number = 0", 2, 12, "the number 0"},
      {"[render.camera]\nfocal_length = \"50mm\"\nfov = 30", 3, 7, "the number 30"},
      {"[render.camera]\nfocus = 3\nfocus_distance = 1", 3, 18, "the number 1"},
      {"[render.camera]\nclose_up = -1", 2, 12, "the number -1"},
      {"[render.camera]\nframe = [[0,0,0],[0,0,0]]", 2, 9, "an array of 2"},
      {"[mesh]\nvoxel = 0.1\ntolerance = 0.1", 3, 13, "the number 0.1"},
      {"[mesh]\nlod = 5", 2, 7, "the number 5"},
      {"[mesh]\nlod = [5, 0]", 2, 11, "the number 0"},
      {"[mesh]\nlod = [\"5k\", \"5x\"]", 2, 14, "'5x'"},
      {"[mesh]\nlod = [5000, \"5k\"]", 2, 14, "the string '5k'"},
      {"[mesh]\nocclusion = 1", 2, 13, "the number 1"},
      {"[volume]\nkind = \"density\"", 2, 8, "the string 'density'"},
      {"a = 1\na = 2", 2, 5, ""},
      {"a = \"\xff\"", 1, 5, ""},
  };
  for (const Malformed& malformed : table) {
    SCOPED_TRACE(malformed.text);
    try {
      read(malformed.text);
      ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, malformed.line) << error.what();
      EXPECT_EQ(error.location().column, malformed.column) << error.what();
      EXPECT_NE(error.found().find(malformed.found), std::string::npos) << error.what();
    }
  }
}

TEST(Recipe, OneWithoutASkeletonIsRefused) { EXPECT_THROW(read("[surface]\nlip = 1\n"), InputError); }

TEST(Recipe, SetOverridesAnyKeyAndArrayIndex) {
  const Recipe recipe =
      read(kFull, {"surface.lip=2", "prune.0.branch=7", "prune.2.branch=9", "surface.bend.1=24", "mesh.tolerance=2mm",
                   "render.camera.frame=[[0,0,0],[2,2,2]]", "bark.order.0.style=birch", "surface.conditioning=off"});
  EXPECT_DOUBLE_EQ(recipe.surface.lip, 2);
  EXPECT_EQ(recipe.surface.prunes[0].where.branch, 7u);
  EXPECT_DOUBLE_EQ(recipe.surface.prunes[0].distance, 0.2);
  ASSERT_EQ(recipe.surface.prunes.size(), 3u);
  EXPECT_EQ(recipe.surface.prunes[2].where.branch, 9u);
  EXPECT_DOUBLE_EQ(recipe.surface.bend[1], 24 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(*recipe.mesh.polygonize.tolerance, 0.002);
  EXPECT_EQ(recipe.render.camera.frame->hi, Vec3(2.0));
  EXPECT_EQ(recipe.bark[0].material.style, BarkStyle::kBirch);
  EXPECT_FALSE(recipe.surface.conditioning.enabled);
}

TEST(Recipe, SetWorksOnInputsThatAreNoRecipe) {
  const Recipe recipe = empty_recipe("a/b.swc", {"prune.0.branch=3", "surface.profile=galbraith", "bark.texture=t.png"});
  ASSERT_EQ(recipe.surface.prunes.size(), 1u);
  EXPECT_EQ(recipe.surface.prunes[0].where.branch, 3u);
  EXPECT_EQ(recipe.surface.profile, Profile::kGalbraith);
  EXPECT_EQ(recipe.bark[0].texture->file.string(), "a/t.png");
  EXPECT_THROW(empty_recipe("a/b.swc", {"skeleton.file=c.swc"}), InputError);
}

TEST(Recipe, BadSettingsAreNamed) {
  for (const char* text :
       {"surface.lipp=2", "surface.lip", "surface..lip=2", "=2", "surface.lip=high", "prune.1.branch=0", "prune.x.branch=0",
        "surface.lip.x=1", "skeleton.graph=g", "prune.0.branch=-3", "surface.lip=1\nwidth = 2"}) {
    SCOPED_TRACE(text);
    try {
      read("[skeleton]\nlsystem = \"a.l\"\n[surface]\nlip = 1\n", {text});
      ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "--set " + std::string(text)) << error.what();
    }
  }
}

}  // namespace
}  // namespace cambium
