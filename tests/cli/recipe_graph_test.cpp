#include "cli/recipe_graph.h"

#include <gtest/gtest.h>

#include <numbers>

#include "cli/recipe.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr const char* kBeginning = "[skeleton.graph]\n";
constexpr const char* kLeast = "[skeleton.graph]\n[[skeleton.graph.volume]]\nshape = \"ball\"\n[[skeleton.graph.level]]\nk = 30\n";

GraphRecipe read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  TemporaryFolder folder;
  return *read_recipe(folder.write("a.tree.toml", text), overrides).skeleton.graph;
}

TEST(RecipeGraph, TheLeastThatThereMayBeHasThePlannersDefaults) {
  const GraphRecipe graph = read(kLeast);
  const GraphOptions defaults;
  EXPECT_EQ(graph.options.seed, 0u);
  EXPECT_EQ(graph.options.root, Vec3(0.0));
  EXPECT_EQ(graph.options.smoothing, defaults.smoothing);
  EXPECT_EQ(graph.options.edges.sectors, defaults.edges.sectors);
  EXPECT_EQ(graph.options.weight_high, defaults.weight_high);
  EXPECT_FALSE(graph.options.light || graph.options.wind || graph.options.refinement);
  EXPECT_TRUE(graph.roots.empty());
  ASSERT_EQ(graph.levels.size(), 1u);
  EXPECT_EQ(graph.levels[0].level.nodes, 30u);
  EXPECT_EQ(graph.levels[0].level.zeta, GraphLevel{}.zeta);
  EXPECT_EQ(std::get<BallSolid>(graph.volume[0].placed.solid).angle, kPi);
}

TEST(RecipeGraph, ReadsEverySolid) {
  const GraphRecipe graph = read(std::string(kLeast) + R"(
[[skeleton.graph.volume]]
shape = "ball"
radius = "50cm"
alpha = "0.3pi"
origin = [0, 0, "2m"]
axis = [1, 0, 1]
scale = 2
part = 3
endpoints = false
[[skeleton.graph.volume]]
shape = "hemisphere"
radius = 2
[[skeleton.graph.volume]]
shape = "ellipsoid"
half_size = [1, 2, "30cm"]
[[skeleton.graph.volume]]
shape = "cylinder"
radius = 0.25
height = 3
[[skeleton.graph.volume]]
shape = "cone"
radius_base = 0
radius_tip = 2
height = 4
[[skeleton.graph.volume]]
shape = "revolution"
stroke = [[0, 0], ["1m", 1], [0, 2]]
[[skeleton.graph.volume]]
shape = "revolution"
svg = "vase.svg"
svg_id = "outline"
svg_axis = 12
height = 5
[[skeleton.graph.volume]]
shape = "mesh"
mesh = "crown.PLY"
)");
  ASSERT_EQ(graph.volume.size(), 9u);
  const PlacedSolid& ball = graph.volume[1].placed;
  EXPECT_DOUBLE_EQ(std::get<BallSolid>(ball.solid).radius, 0.5);
  EXPECT_DOUBLE_EQ(std::get<BallSolid>(ball.solid).angle, 0.3 * kPi);
  EXPECT_EQ(ball.origin, Vec3(0, 0, 2));
  EXPECT_EQ(ball.axis, Vec3(1, 0, 1));
  EXPECT_EQ(ball.scale, 2);
  EXPECT_EQ(ball.part, 3);
  EXPECT_FALSE(ball.endpoints);
  EXPECT_DOUBLE_EQ(std::get<BallSolid>(graph.volume[2].placed.solid).angle, kPi / 2);
  EXPECT_TRUE(graph.volume[2].placed.endpoints);
  EXPECT_EQ(std::get<EllipsoidSolid>(graph.volume[3].placed.solid).half_size, Vec3(1, 2, 0.3));
  EXPECT_EQ(std::get<CylinderSolid>(graph.volume[4].placed.solid).height, 3);
  EXPECT_EQ(std::get<ConeSolid>(graph.volume[5].placed.solid).radius_base, 0);
  EXPECT_EQ(std::get<ConeSolid>(graph.volume[5].placed.solid).radius_tip, 2);
  ASSERT_EQ(std::get<RevolutionSolid>(graph.volume[6].placed.solid).stroke.size(), 3u);
  EXPECT_EQ(std::get<RevolutionSolid>(graph.volume[6].placed.solid).stroke[1].x, 1);
  EXPECT_EQ(graph.volume[7].svg->file.filename(), "vase.svg");
  EXPECT_EQ(graph.volume[7].svg_options.id, "outline");
  EXPECT_EQ(graph.volume[7].svg_options.axis, 12);
  EXPECT_EQ(graph.volume[7].svg_options.height, 5);
  EXPECT_EQ(graph.volume[8].mesh->file.filename(), "crown.PLY");
}

TEST(RecipeGraph, ReadsEveryKeyOfALevel) {
  const GraphRecipe graph = read(std::string(kLeast) + R"(d = "4cm"
b = [2, 9]
d_e = "30cm"
placement = "taproot"
at = [[0, 0, "50cm"]]
zeta = 0.6
[[skeleton.graph.level]]
levels = [2, 8]
alpha = "0.25pi"
r = "80cm"
a = 1
v_g = "vertical"
turn = { angle = "-0.12pi", axis = [0, 1, 0] }
around_all = true
b = 1
d_e = 0.2
[[skeleton.graph.level.shape]]
shape = "cone"
radius_base = 0
)");
  ASSERT_EQ(graph.levels.size(), 8u);
  const GraphLevel& first = graph.levels[0].level;
  EXPECT_DOUBLE_EQ(*first.spacing, 0.04);
  EXPECT_EQ(first.endpoints, (std::array{2, 9}));
  EXPECT_DOUBLE_EQ(first.shell, 0.3);
  EXPECT_EQ(first.placement, EndpointPlacement::kTaproot);
  ASSERT_EQ(first.given_endpoints.size(), 1u);
  EXPECT_EQ(first.given_endpoints[0], Vec3(0, 0, 0.5));
  EXPECT_DOUBLE_EQ(first.zeta, 0.6);
  for (std::size_t i = 1; i < 8; ++i) {
    const GraphLevel& level = graph.levels[i].level;
    EXPECT_DOUBLE_EQ(level.alpha, 0.25 * kPi);
    EXPECT_DOUBLE_EQ(*level.radius, 0.8);
    EXPECT_EQ(level.shrink, 1);
    EXPECT_EQ(level.orientation, GraphOrientation::kVertical);
    EXPECT_DOUBLE_EQ(level.turn.angle, -0.12 * kPi);
    EXPECT_EQ(level.turn.axis, Vec3(0, 1, 0));
    EXPECT_TRUE(level.around_all);
    EXPECT_EQ(level.endpoints, (std::array{1, 1}));
    EXPECT_EQ(level.placement, EndpointPlacement::kShell);
    EXPECT_EQ(std::get<ConeSolid>(graph.levels[i].shape.at(0).placed.solid).radius_base, 0);
  }
}

TEST(RecipeGraph, ReadsWhatIsNotOfALevel) {
  const GraphRecipe graph = read(R"([skeleton.graph]
seed = 7
root = [0, 0, "-10cm"]
smoothing = 0
with_roots = false
[[skeleton.graph.volume]]
shape = "ball"
[[skeleton.graph.level]]
[skeleton.graph.refinement]
spheres = 5
radius = 0.6
cone_radius = 0.4
[skeleton.graph.edges]
rule = "threshold"
sectors = 12
threshold = 2
[skeleton.graph.weights]
low = 0.5
high = 2
times_length = true
volume = "paint.vdb"
[[skeleton.graph.weights.ball]]
center = [1, 2, 3]
radius = "50cm"
factor = 0.2
[[skeleton.graph.obstacle]]
shape = "half_space"
point = [0, 0, 1]
normal = [1, 0, 0]
[[skeleton.graph.obstacle]]
shape = "cylinder"
radius = 0.1
[skeleton.graph.lifespan]
L = 4.5
rule = "30/70"
sizes = true
[skeleton.graph.light]
direction = [1, 0, 1]
on_endpoints = false
on_lifespan = false
[skeleton.graph.wind]
direction = [0, 1, 0]
strength = 0.3
[skeleton.graph.thickness]
rule = "pipe"
trunk_radius = "20cm"
tip_radius = "1mm"
e = 2.3
unit = "4cm"
every_level = false
[[skeleton.graph.roots.volume]]
shape = "hemisphere"
axis = [0, 0, -1]
[[skeleton.graph.roots.level]]
b = 3
[skeleton.graph.roots.thickness]
trunk_radius = "15cm"
)");
  const GraphOptions& options = graph.options;
  EXPECT_EQ(options.seed, 7u);
  EXPECT_EQ(options.root, Vec3(0, 0, -0.1));
  EXPECT_EQ(options.smoothing, 0);
  EXPECT_FALSE(options.with_roots);
  EXPECT_EQ(options.refinement->spheres, 5u);
  EXPECT_DOUBLE_EQ(options.refinement->radius, 0.6);
  EXPECT_DOUBLE_EQ(options.refinement->cone_radius, 0.4);
  EXPECT_EQ(options.edges.rule, EdgeRule::kThreshold);
  EXPECT_EQ(options.edges.sectors, 12);
  EXPECT_EQ(options.edges.threshold, 2);
  EXPECT_DOUBLE_EQ(options.weight_low, 0.5);
  EXPECT_EQ(options.weight_high, 2);
  EXPECT_TRUE(options.weight_times_length);
  EXPECT_EQ(graph.weight_volume->file.filename(), "paint.vdb");
  ASSERT_EQ(graph.weight_balls.size(), 1u);
  EXPECT_EQ(graph.weight_balls[0].center, Vec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(graph.weight_balls[0].radius, 0.5);
  EXPECT_DOUBLE_EQ(graph.weight_balls[0].factor, 0.2);
  ASSERT_EQ(graph.half_spaces.size(), 1u);
  EXPECT_EQ(graph.half_spaces[0].normal, Vec3(1, 0, 0));
  ASSERT_EQ(graph.obstacles.size(), 1u);
  EXPECT_DOUBLE_EQ(std::get<CylinderSolid>(graph.obstacles[0].placed.solid).radius, 0.1);
  EXPECT_EQ(options.lifespan.initial, 4.5);
  EXPECT_TRUE(options.lifespan.sizes);
  ASSERT_EQ(options.lifespan.outcomes.size(), 2u);
  EXPECT_TRUE(options.lifespan.outcomes[0].relative);
  EXPECT_EQ(options.light->direction, Vec3(1, 0, 1));
  EXPECT_FALSE(options.light->on_endpoints || options.light->on_lifespan);
  EXPECT_EQ(options.wind->direction, Vec3(0, 1, 0));
  EXPECT_DOUBLE_EQ(options.wind->strength, 0.3);
  EXPECT_EQ(options.thickness.rule, ThicknessRule::kPipe);
  EXPECT_DOUBLE_EQ(options.thickness.trunk_radius, 0.2);
  EXPECT_DOUBLE_EQ(options.thickness.tip_radius, 0.001);
  EXPECT_DOUBLE_EQ(*options.thickness.exponent, 2.3);
  EXPECT_DOUBLE_EQ(*options.thickness.unit, 0.04);
  EXPECT_FALSE(options.thickness.every_level);
  ASSERT_EQ(graph.roots.size(), 1u);
  EXPECT_EQ(graph.roots[0].volume[0].placed.axis, Vec3(0, 0, -1));
  EXPECT_EQ(graph.roots[0].levels[0].level.endpoints, (std::array{3, 3}));
  EXPECT_DOUBLE_EQ(graph.roots[0].options.thickness.trunk_radius, 0.15);
}

TEST(RecipeGraph, TakesATableOfLifespansOutcomes) {
  const GraphRecipe graph = read(std::string(kLeast) + R"([[skeleton.graph.lifespan.rule]]
probability = 3
low = 0.5
high = 1.5
[[skeleton.graph.lifespan.rule]]
relative = true
)");
  const auto& outcomes = graph.options.lifespan.outcomes;
  ASSERT_EQ(outcomes.size(), 2u);
  EXPECT_EQ(outcomes[0].probability, 3);
  EXPECT_DOUBLE_EQ(outcomes[0].high, 1.5);
  EXPECT_FALSE(outcomes[0].relative);
  EXPECT_TRUE(outcomes[1].relative);
}

TEST(RecipeGraph, IsSetFromTheCommandLine) {
  const GraphRecipe graph = read(kLeast, {"skeleton.graph.level.0.b=5", "skeleton.graph.level.1.alpha=0.2pi", "skeleton.graph.seed=9",
                                          "skeleton.graph.thickness.trunk_radius=30cm"});
  EXPECT_EQ(graph.levels[0].level.endpoints[0], 5);
  ASSERT_EQ(graph.levels.size(), 2u);
  EXPECT_DOUBLE_EQ(graph.levels[1].level.alpha, 0.2 * kPi);
  EXPECT_EQ(graph.options.seed, 9u);
  EXPECT_DOUBLE_EQ(graph.options.thickness.trunk_radius, 0.3);
}

TEST(RecipeGraph, RefusesWhatItCannotUseNamingThePlace) {
  const struct { const char* text; int line, column; const char* in_message; } table[] = {
      {"flavour = 1\n", 6, 1, "unknown key"},
      {"alpha = \"0.3pi\"\n", 6, 9, "from level 2 on"},
      {"shape = []\n", 6, 9, "from level 2 on"},
      {"[[skeleton.graph.level]]\nk = 0\n", 7, 5, "from 1"},
      {"b = -1\n", 6, 5, "from 0"},
      {"b = [3, 2]\n", 6, 5, "[least, most]"},
      {"b = [1]\n", 6, 5, "array of 2"},
      {"d = 0\n", 6, 5, "greater than 0"},
      {"zeta = 0\n", 6, 8, "greater than 0"},
      {"placement = \"shell\"\n", 6, 13, "d_e"},
      {"placement = \"uniform\"\nd_e = 1\n", 6, 13, "d_e"},
      {"levels = 2\n", 6, 10, "the next level"},
      {"levels = [1, 2]\nd_e = 1\n", 7, 7, "level 1 by itself"},
      {"levels = [1, 2]\nat = []\n", 7, 6, "level 1 alone"},
      {"[[skeleton.graph.level]]\nalpha = 0\n", 7, 9, "0.1 to 180"},
      {"[[skeleton.graph.level]]\nalpha = \"1.1pi\"\n", 7, 9, "0.1 to 180"},
      {"[[skeleton.graph.level]]\nalpha = \"0.3\"\n", 7, 9, "0.1pi"},
      {"[[skeleton.graph.level]]\na = 0\n", 7, 5, "greater than 0"},
      {"[[skeleton.graph.level]]\nat = [[0, 0, 0]]\n", 7, 6, "level 1 alone"},
      {"[[skeleton.graph.level]]\nd_e = \"5cm\"\n", 7, 7, "0 to 2"},
      {"[[skeleton.graph.level]]\nlevels = [3, 4]\n", 7, 10, "the next level"},
      {"[[skeleton.graph.level]]\nlevels = [2, 1]\n", 7, 10, "the next level"},
      {"[[skeleton.graph.level]]\nv_g = \"up\"\n", 7, 7, "vertical"},
      {"[[skeleton.graph.level]]\nturn = { angles = 3 }\n", 7, 10, "unknown key"},
      {"[[skeleton.graph.volume]]\nradius = 1\n", 6, 1, "shape"},
      {"[[skeleton.graph.volume]]\nshape = \"blob\"\n", 7, 9, "hemisphere"},
      {"[[skeleton.graph.volume]]\nshape = \"ball\"\nheight = 2\n", 8, 1, "unknown key"},
      {"[[skeleton.graph.volume]]\nshape = \"ball\"\nradius = 0\n", 8, 10, "greater than 0"},
      {"[[skeleton.graph.volume]]\nshape = \"ellipsoid\"\nhalf_size = [1, 1]\n", 8, 13, "array of 3"},
      {"[[skeleton.graph.volume]]\nshape = \"ball\"\naxis = [0, 0, 0]\n", 8, 8, "not zero"},
      {"[[skeleton.graph.volume]]\nshape = \"half_space\"\n", 6, 1, "obstacles only"},
      {"[[skeleton.graph.volume]]\nshape = \"revolution\"\n", 6, 1, "stroke"},
      {"[[skeleton.graph.volume]]\nshape = \"revolution\"\nstroke = [[-1, 0], [1, 1]]\n", 8, 10, "stroke"},
      {"[[skeleton.graph.volume]]\nshape = \"revolution\"\nstroke = [[1, 0], [1, 1]]\nsvg = \"a.svg\"\n", 9, 7, "not both"},
      {"[[skeleton.graph.volume]]\nshape = \"revolution\"\nstroke = [[1, 0], [1, 1]]\nheight = 2\n", 6, 1, "svg"},
      {"[[skeleton.graph.volume]]\nshape = \"mesh\"\n", 6, 1, "mesh = "},
      {"[[skeleton.graph.volume]]\nshape = \"mesh\"\nmesh = \"a.stl\"\n", 8, 8, ".obj or .ply"},
      {"[[skeleton.graph.obstacle]]\nshape = \"half_space\"\nradius = 2\n", 8, 1, "unknown key"},
      {"[skeleton.graph.edges]\nsectors = 3\n", 7, 11, "4 to 64"},
      {"[skeleton.graph.weights]\nlow = 2\nhigh = 1\n", 8, 8, "at least 2"},
      {"[skeleton.graph.lifespan]\nrule = \"70/30\"\n", 7, 8, "30/70"},
      {"[skeleton.graph.lifespan]\nrule = []\n", 7, 8, "one outcome"},
      {"[skeleton.graph.thickness]\ntrunk_radius = -1\n", 7, 16, "greater than 0"},
      {"[skeleton.graph.roots]\n", 6, 1, "no volume"},
      {"[skeleton.graph.roots]\nseed = 3\n", 7, 1, "unknown key"},
  };
  for (const auto& bad : table) {
    SCOPED_TRACE(bad.text);
    try {
      read(std::string(kLeast) + bad.text);
      FAIL() << "was read";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, bad.line) << error.what();
      EXPECT_EQ(error.location().column, bad.column) << error.what();
      EXPECT_NE(std::string(error.what()).find(bad.in_message), std::string::npos) << error.what();
    }
  }
}

TEST(RecipeGraph, IsOneOfThreeSources) {
  EXPECT_THROW(read(std::string("[skeleton]\nlsystem = \"a.l\"\n") + kLeast), InputError);
  EXPECT_THROW(read(std::string("[skeleton]\nfile = \"a.swc\"\n") + kLeast), InputError);
  EXPECT_THROW(read("[skeleton]\ngraph = \"a\"\n"), InputError);
  EXPECT_THROW(read(kBeginning), InputError);
}

/// The planner names settings; the recipe knows their places.
TEST(RecipeGraph, NotesWhereEverySettingStands) {
  const GraphRecipe graph = read(std::string(kLeast) + R"([[skeleton.graph.level]]
levels = [2, 4]
alpha = 20
[skeleton.graph.light]
direction = [1, 0, 0]
[[skeleton.graph.volume]]
shape = "ball"
radius = 3
[skeleton.graph.roots]
[[skeleton.graph.roots.volume]]
shape = "ball"
[[skeleton.graph.roots.level]]
b = 4
)");
  EXPECT_EQ(graph.places.at("").line, 1);
  EXPECT_EQ(graph.places.at("volume 1").line, 2);
  EXPECT_EQ(graph.places.at("level 1: k").line, 5);
  EXPECT_EQ(graph.places.at("level 1: k").column, 5);
  EXPECT_EQ(graph.places.at("level 4: alpha").line, 8);
  EXPECT_EQ(graph.places.at("light: direction").line, 10);
  EXPECT_EQ(graph.places.at("volume 2: radius").line, 13);
  EXPECT_EQ(graph.places.at("roots: volume 1").line, 15);
  EXPECT_EQ(graph.places.at("roots: level 1: b").line, 18);
}

}  // namespace
}  // namespace cambium
