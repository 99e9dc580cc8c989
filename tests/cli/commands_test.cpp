// Every command of the real program on tiny inputs.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"
#include "tiny_inputs.h"

namespace cambium {
namespace {

using Json = nlohmann::json;

class Commands : public ::testing::Test {
 protected:
  Commands() {
    folder_.write("tiny.l", kTinyLSystem);
    folder_.write("tiny.tree.toml", kTinyRecipe);
    folder_.write("tiny.skel.json", kTinySkeleton);
    folder_.write("tiny.swc", kTinySwc);
    folder_.write("tiny.csv", kTinyCsv);
    folder_.write("tiny.blob.json", kTinyBlobTree);
  }

  std::string at(const std::string& name) const { return folder_.path(name); }

  /// Runs with --json and gives the figures.
  Json figures(std::vector<std::string> arguments) const {
    arguments.push_back("--json");
    const Ran ran = run_program(arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    return ran.status == 0 ? Json::parse(ran.out) : Json();
  }

  TemporaryFolder folder_;
};

TEST_F(Commands, DeriveCountsModulesAndLengths) {
  const Json json = figures({"derive", at("tiny.l"), "-o", at("string.txt")});
  EXPECT_EQ(json["command"], "derive");
  EXPECT_EQ(json["symbols"], (Json{{"!", 3}, {"+", 2}, {"A", 1}, {"F", 4}, {"[", 2}, {"]", 2}}));
  EXPECT_EQ(json["modules"], 14);
  EXPECT_DOUBLE_EQ(json["total_length"].get<double>(), 3.2);
  EXPECT_DOUBLE_EQ(json["last_width"].get<double>(), 0.1);
  EXPECT_TRUE(json["seconds"].contains("derive"));
  EXPECT_GT(json["peak_memory_bytes"].get<double>(), 0);
  EXPECT_EQ(folder_.read("string.txt"), "!(0.2)F(1)[+(50)!(0.1)F(0.6)]F(1)[+(50)!(0.1)F(0.6)]A\n");
}

TEST_F(Commands, DerivePrintsTheStringWithoutOutput) {
  const Ran ran = run_program({"derive", at("tiny.l"), "--set", "skeleton.steps=0"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.out, "!(0.2)A\n");
  EXPECT_EQ(ran.err, "");
}

TEST_F(Commands, DeriveStopsAtAStepAndExplainsIt) {
  folder_.write("grow.l", "lsystem: 1\nderivation length: 9\nStart: {n = 3; printf(\"n is %g\\n\", n);}\naxiom: A(0)\n"
                          "A(x) --> F(x)A(x+1)\nendlsystem\n");
  const std::string input = at("grow.l");
  EXPECT_EQ(run_program({"derive", input, "--step", "2"}).out, "F(0)F(1)A(2)\n");
  EXPECT_EQ(run_program({"derive", input, "--step", "2"}).err, "n is 3\n");
  EXPECT_EQ(run_program({"derive", input, "--step", "2", "--explain", "--quiet"}).out,
            "stays\tF(0)\tF(0)\n" + input + ":5:1\tA(1)\tF(1)A(2)\n");
  EXPECT_EQ(run_program({"derive", input, "--step", "0", "--explain", "--quiet"}).status, 2);
  const Ran limited = run_program({"derive", input, "--max-modules", "5", "--quiet"});
  EXPECT_EQ(limited.status, 2);
  EXPECT_NE(limited.err.find(input + ":5:1: found a string of more than 5 modules"), std::string::npos) << limited.err;
}

TEST_F(Commands, DeriveRunsTheLSystemThatIsNamed) {
  folder_.write("two.l",
                "lsystem: first\nderivation length: 0\naxiom: A\nendlsystem\nlsystem: second\nderivation length: 0\naxiom: B\nendlsystem\n");
  EXPECT_EQ(run_program({"derive", at("two.l")}).out, "A\n");
  EXPECT_EQ(run_program({"derive", at("two.l"), "--lsystem", "second"}).out, "B\n");
  EXPECT_EQ(run_program({"derive", at("two.l"), "--set", "skeleton.label=second"}).out, "B\n");
  const Ran ran = run_program({"derive", at("two.l"), "--lsystem", "third"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("no L-system 'third'"), std::string::npos) << ran.err;
}

TEST_F(Commands, ReadOtherDialectsByOptionRecipeOrExtension) {
  folder_.write("koch.lpy", "Axiom: F\nderivation length: 1\nproduction:\nF --> F-F\nendlsystem\n");
  folder_.write("koch.l", "Generations: 1\nPremise: F\nRule 1: F=F-F\n");
  folder_.write("koch.tree.toml", "[skeleton]\nlsystem = \"koch.l\"\ndialect = \"houdini\"\n");
  EXPECT_EQ(run_program({"derive", at("koch.lpy")}).out, "F-F\n");
  EXPECT_EQ(run_program({"derive", at("koch.l"), "--dialect", "houdini"}).out, "F-F\n");
  EXPECT_EQ(run_program({"derive", at("koch.tree.toml")}).out, "F-F\n");
  EXPECT_EQ(run_program({"derive", at("koch.tree.toml"), "--set", "skeleton.dialect=lpy"}).status, 2);
  EXPECT_EQ(run_program({"derive", at("koch.l")}).status, 2);
  EXPECT_EQ(run_program({"derive", at("koch.l"), "--dialect", "maya"}).status, 2);
}

TEST_F(Commands, GrowWritesASkeletonThatReadsBack) {
  for (const char* input : {"tiny.l", "tiny.tree.toml", "tiny.skel.json", "tiny.swc", "tiny.csv"})
    for (const char* output : {"grown.skel.json", "grown.swc"}) {
      SCOPED_TRACE(std::string(input) + " to " + output);
      const Json first = figures({"grow", at(input), "-o", at(output)});
      EXPECT_GE(first["nodes"].get<int>(), 4);
      EXPECT_EQ(figures({"grow", at(output), "-o", at("again.skel.json")})["nodes"], first["nodes"]);
    }
}

TEST_F(Commands, SurfaceWritesABlobTreeOfTheSameField) {
  folder_.write("p.csv", "x,y,z\n0,0,1.1\n0.1,0,1.2\n0.3,0.02,1.4\n9,9,9\n");
  figures({"surface", at("tiny.tree.toml"), "-o", at("built.blob.json")});
  const Json json = figures({"eval", at("tiny.tree.toml"), "--points", at("p.csv"), "-o", at("recipe.csv")});
  EXPECT_EQ(json["points"], 4);
  figures({"eval", at("built.blob.json"), "--points", at("p.csv"), "-o", at("blob.csv")});
  EXPECT_EQ(folder_.read("recipe.csv"), folder_.read("blob.csv"));
  EXPECT_EQ(folder_.read("blob.csv").substr(0, 17), "x,y,z,f,gx,gy,gz\n");
  EXPECT_NE(folder_.read("blob.csv").find("\n9,9,9,0,"), std::string::npos);
}

TEST_F(Commands, EvalGivesTheFieldOfASphereInNineDigits) {
  folder_.write("p.csv", "0,0,1\n0.5,0,1\n");
  figures({"eval", at("tiny.blob.json"), "--points", at("p.csv"), "-o", at("f.csv")});
  std::istringstream rows(folder_.read("f.csv"));
  std::string header, center, surface;
  std::getline(rows, header), std::getline(rows, center), std::getline(rows, surface);
  EXPECT_EQ(center.substr(0, 8), "0,0,1,1,");
  EXPECT_EQ(surface.substr(0, 10), "0.5,0,1,0.");
  EXPECT_NEAR(std::stod(surface.substr(8)), 0.5, 1e-9);
}

TEST_F(Commands, MeshWritesEveryFormatFromEveryInput) {
  for (const char* output : {"a.obj", "a.ply", "a.stl", "a.off", "a.glb"}) {
    SCOPED_TRACE(output);
    const Json json = figures({"mesh", at("tiny.tree.toml"), "-o", at(output)});
    EXPECT_GT(json["triangles"].get<int>(), 100);
    EXPECT_EQ(json["components"], 1);
    EXPECT_DOUBLE_EQ(json["smallest_cell"].get<double>(), 0.04);
    EXPECT_GT(folder_.read(output).size(), 1000u);
  }
  for (const char* input : {"tiny.l", "tiny.skel.json", "tiny.swc", "tiny.csv", "tiny.blob.json"}) {
    SCOPED_TRACE(input);
    EXPECT_GT(figures({"mesh", at(input), "-o", at("b.ply"), "--voxel", "4cm"})["triangles"].get<int>(), 100);
  }
}

TEST_F(Commands, ToleranceOverridesTheRecipesVoxel) {
  const Json json = figures({"mesh", at("tiny.tree.toml"), "-o", at("a.obj"), "--tolerance", "3cm"});
  EXPECT_DOUBLE_EQ(json["tolerance"].get<double>(), 0.03);
  const Json uniform = figures({"mesh", at("tiny.tree.toml"), "-o", at("a.obj"), "--set", "mesh.voxel=5cm"});
  EXPECT_DOUBLE_EQ(uniform["smallest_cell"].get<double>(), 0.05);
  EXPECT_FALSE(uniform.contains("tolerance"));
}

TEST_F(Commands, MoreSidesAreMoreTrianglesAndAPreviewIsFewer) {
  const auto triangles = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"mesh", at("tiny.skel.json"), "-o", at("a.off"), "--tolerance", "2cm"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return figures(arguments)["triangles"].get<int>();
  };
  const int usual = triangles({});
  EXPECT_GT(triangles({"--min-sides", "32"}), usual);
  EXPECT_LT(triangles({"--preview"}), usual);
  EXPECT_EQ(triangles({"--set", "mesh.min_sides=32"}), triangles({"--min-sides", "32"}));
}

// A preview keeps every twig, so it draws them no thinner than its cells can be few.
TEST_F(Commands, APreviewThickensTwigsAndHasNoOcclusion) {
  folder_.write("twig.skel.json", R"({"format":"cambium-skeleton","version":1,"nodes":[
{"position":[0,0,0],"radius":0.002,"parent":-1},
{"position":[0,0,5],"radius":0.002,"parent":0}]})");
  const auto mesh = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"mesh", at("twig.skel.json"), "-o", at(output), "--tolerance", "0.5mm"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return figures(arguments);
  };
  const double usual = mesh("a.ply", {})["smallest_cell"].get<double>();
  const double preview = mesh("b.ply", {"--preview"})["smallest_cell"].get<double>();
  EXPECT_LE(usual, 1.1 * 0.002);
  EXPECT_GT(preview, 1.9 * usual);   // 5 m / 1250 is twice the radius
  EXPECT_NE(folder_.read("a.ply").find("occlusion"), std::string::npos);
  EXPECT_EQ(folder_.read("b.ply").find("occlusion"), std::string::npos);
}

TEST_F(Commands, LevelsOfDetailGoIntoOneGlbAndOneFileEachOtherwise) {
  const Json glb = figures({"mesh", at("tiny.tree.toml"), "-o", at("a.glb"), "--lod", "2k,500,100"});
  ASSERT_EQ(glb["levels"].size(), 3u);
  const std::size_t most[] = {2000, 500, 100};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(glb["levels"][i]["triangles"].get<std::size_t>(), most[i]);
    EXPECT_GT(glb["levels"][i]["triangles"].get<std::size_t>(), most[i] / 2);
  }
  EXPECT_EQ(glb["triangles"], glb["levels"][0]["triangles"]);
  EXPECT_NE(folder_.read("a.glb").find("MSFT_lod"), std::string::npos);
  figures({"mesh", at("tiny.tree.toml"), "-o", at("b.off"), "--lod", "2k,500,100"});
  EXPECT_FALSE(folder_.has("b.off"));
  for (std::size_t i = 0; i < 3; ++i) {
    std::istringstream file(folder_.read("b_lod" + std::to_string(i) + ".off"));
    std::string magic;
    std::size_t vertices = 0, triangles = 0;
    file >> magic >> vertices >> triangles;
    EXPECT_EQ(triangles, glb["levels"][i]["triangles"].get<std::size_t>());
  }
  figures({"mesh", at("tiny.tree.toml"), "-o", at("c.off"), "--lod", "500"});
  EXPECT_TRUE(folder_.has("c.off"));
}

TEST_F(Commands, LevelsThatCannotBeReachedAreSaid) {
  const Ran ran = run_program({"mesh", at("tiny.tree.toml"), "-o", at("a.off"), "--lod", "3"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_TRUE(ran.err.starts_with("cambium: level 0 has ")) << ran.err;
  EXPECT_TRUE(folder_.has("a.off"));
}

TEST_F(Commands, VerifyMeasuresBothWaysAndSaysOnStderrWhatIsMissed) {
  const Json json = figures({"mesh", at("tiny.blob.json"), "-o", at("a.off"), "--tolerance", "2cm", "--verify"});
  for (const char* way : {"mesh_to_surface", "surface_to_mesh"}) {
    const Json& d = json["verify"][way];
    EXPECT_GT(d["samples"].get<int>(), 100);
    EXPECT_LE(d["mean"].get<double>(), d["p99"].get<double>());
    EXPECT_LE(d["p99"].get<double>(), d["p999"].get<double>());
    EXPECT_LE(d["p999"].get<double>(), d["max"].get<double>());
    EXPECT_GT(d["max"].get<double>(), 0);
    EXPECT_LE(d["max"].get<double>(), 0.04);
    EXPECT_EQ(d["within_twice"], 1);
  }
  EXPECT_EQ(json["verify"]["self_intersections"], 0);
  EXPECT_EQ(json["verify"]["topology"]["euler"], 2);
  EXPECT_EQ(json["verify"]["topology"]["boundary_edges"], 0);
  // The first level of detail is what the tolerance is asked of; eight triangles are no sphere.
  const Ran ran = run_program({"mesh", at("tiny.blob.json"), "-o", at("a.off"), "--tolerance", "1cm", "--lod", "8", "--verify"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_NE(ran.err.find("misses its tolerance of 0.01 m"), std::string::npos) << ran.err;
  EXPECT_TRUE(folder_.has("a.off"));
}

TEST_F(Commands, UpTurnsTheMesh) {
  figures({"mesh", at("tiny.blob.json"), "-o", at("z.off"), "--voxel", "20cm"});
  figures({"mesh", at("tiny.blob.json"), "-o", at("y.off"), "--voxel", "20cm", "--up", "y"});
  EXPECT_NE(folder_.read("z.off"), folder_.read("y.off"));
}

TEST_F(Commands, VolumeWritesEveryKind) {
  for (const char* kind : {"sdf", "field", "fog"}) {
    SCOPED_TRACE(kind);
    const Json json = figures({"volume", at("tiny.tree.toml"), "-o", at("a.vdb"), "--kind", kind});
    EXPECT_GT(json["active_voxels"].get<int>(), 100);
    EXPECT_GT(folder_.read("a.vdb").size(), 1000u);
  }
}

TEST_F(Commands, RenderWritesImagesAndAovs) {
  const Json json = figures({"render", at("tiny.tree.toml"), "-o", at("a.png"), "--aov", "depth,normal"});
  EXPECT_EQ(json["width"], 24);
  EXPECT_EQ(json["height"], 32);
  for (const char* name : {"a.png", "a.depth.png", "a.normal.png"})
    EXPECT_EQ(folder_.read(name).substr(1, 3), "PNG") << name;
  figures({"render", at("tiny.tree.toml"), "-o", at("a.exr"), "--size", "8x8", "--samples", "2", "--aov", "branch"});
  EXPECT_EQ(folder_.read("a.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_FALSE(folder_.has("a.branch.exr"));
}

TEST_F(Commands, RenderMakesAPartOfThePicture) {
  const Json json = figures({"render", at("tiny.tree.toml"), "-o", at("a.png"), "--crop", "4,8,20,31", "--samples", "1..4", "--noise",
                             "0.01", "--bounces", "0", "--bits", "16", "--aov", "all"});
  EXPECT_EQ(json["width"], 16);
  EXPECT_EQ(json["height"], 23);
  EXPECT_EQ(json["samples"], 4);
  EXPECT_EQ(json["aovs"].size(), 11u);
  EXPECT_TRUE(folder_.has("a.cryptomatte.png"));
}

TEST_F(Commands, RenderWalksAroundTheTreeAndMakesOneFrameOfThatAlone) {
  const std::vector<std::string> base = {"render", at("tiny.tree.toml"), "-o", at("turn.png"), "--size", "12x16", "--samples", "1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), base.begin(), base.end());
    return more;
  };
  const Json json = figures(with({"--turntable", "3"}));
  EXPECT_EQ(json["frames"].size(), 3u);
  EXPECT_FALSE(folder_.has("turn.png"));
  const std::string first = folder_.read("turn.0001.png"), second = folder_.read("turn.0002.png");
  EXPECT_NE(first, second);
  EXPECT_TRUE(folder_.has("turn.0003.png"));
  EXPECT_EQ(figures(with({"--turntable", "3", "--frame", "2", "--set", "render.samples=1"}))["frames"].size(), 1u);
  EXPECT_EQ(folder_.read("turn.0002.png"), second);
}

TEST_F(Commands, GrowMakesASkeletonForEachTimeOfAGrowingPlant) {
  const Json json = figures({"grow", at("tiny.l"), "-o", at("tree.skel.json"), "--step", "0.5"});
  ASSERT_EQ(json["frames"].size(), 5u);
  EXPECT_EQ(json["frames"][0]["nodes"], 0);
  EXPECT_EQ(json["frames"][3]["time"], 1.5);
  EXPECT_FALSE(folder_.has("tree.skel.json"));
  figures({"grow", at("tiny.l"), "-o", at("whole.skel.json")});
  EXPECT_EQ(folder_.read("tree.0005.skel.json"), folder_.read("whole.skel.json"));
  const Json half = Json::parse(folder_.read("tree.0002.skel.json"));
  EXPECT_DOUBLE_EQ(half["nodes"][1]["position"][2].get<double>(), 0.5);
  EXPECT_DOUBLE_EQ(half["nodes"][1]["radius"].get<double>(), 0.05);
  const std::string second = folder_.read("tree.0002.skel.json");
  EXPECT_EQ(figures({"grow", at("tiny.l"), "-o", at("tree.skel.json"), "--step", "0.5", "--frame", "2"})["frames"].size(), 1u);
  EXPECT_EQ(folder_.read("tree.0002.skel.json"), second);
  EXPECT_EQ(figures({"grow", at("tiny.l"), "-o", at("year.swc"), "--step", "1.5"})["frames"].size(), 2u);
}

TEST_F(Commands, MeshAndRenderMakeAFileForEachTimeWhenThereIsWood) {
  const Ran ran = run_program({"mesh", at("tiny.tree.toml"), "-o", at("tree.ply"), "--step", "1"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("nothing has grown yet: 1"), std::string::npos) << ran.err;
  EXPECT_FALSE(folder_.has("tree.0001.ply"));
  EXPECT_TRUE(folder_.has("tree.0002.ply"));
  figures({"mesh", at("tiny.tree.toml"), "-o", at("whole.ply")});
  EXPECT_EQ(folder_.read("tree.0003.ply"), folder_.read("whole.ply"));
  const std::vector<std::string> render = {"render", at("tiny.tree.toml"), "-o", at("tree.png"), "--step", "0.5"};
  const auto with_threads = [&](const char* threads) {
    std::vector<std::string> arguments = render;
    arguments.insert(arguments.end(), {"--threads", threads});
    EXPECT_EQ(run_program(arguments).status, 0);
  };
  with_threads("1");
  EXPECT_TRUE(folder_.has("tree.0005.png"));
  EXPECT_FALSE(folder_.has("tree.0006.png"));
  const std::string third = folder_.read("tree.0003.png");
  EXPECT_NE(third, folder_.read("tree.0004.png"));
  with_threads("2");
  EXPECT_EQ(folder_.read("tree.0003.png"), third);
}

TEST_F(Commands, RenderComesCloseToABranch) {
  figures({"render", at("tiny.skel.json"), "-o", at("far.png"), "--size", "12x16", "--samples", "1"});
  figures({"render", at("tiny.skel.json"), "-o", at("near.png"), "--size", "12x16", "--samples", "1", "--close-up", "1"});
  EXPECT_NE(folder_.read("far.png"), folder_.read("near.png"));
}

TEST_F(Commands, InfoListsBranchesAndBounds) {
  const Json json = figures({"info", at("tiny.skel.json")});
  EXPECT_EQ(json["axes"], 2);
  ASSERT_EQ(json["branches"].size(), 2u);
  EXPECT_EQ(json["branches"][0]["branch"], 0);
  EXPECT_EQ(json["branches"][0]["order"], 0);
  EXPECT_EQ(json["branches"][1]["order"], 1);
  EXPECT_GT(json["bounds"]["hi"][2].get<double>(), 2);
  EXPECT_TRUE(json["conditioning"].contains("radii_clamped"));
  EXPECT_EQ(figures({"info", at("tiny.blob.json")})["primitives"], 1);
}

TEST_F(Commands, QuietPrintsNothing) {
  const Ran ran = run_program({"mesh", at("tiny.blob.json"), "-o", at("a.obj"), "--voxel", "20cm", "--quiet"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.out + ran.err, "");
}

TEST_F(Commands, SetPrunesABranchByItsIndex) {
  const Json whole = figures({"mesh", at("tiny.skel.json"), "-o", at("a.off"), "--voxel", "2cm"});
  const Json cut = figures({"mesh", at("tiny.skel.json"), "-o", at("b.off"), "--voxel", "2cm", "--set", "prune.0.branch=1",
                            "--set", "prune.0.distance=10cm"});
  EXPECT_LT(cut["triangles"].get<int>(), whole["triangles"].get<int>());
}

TEST_F(Commands, OutputIsTheSameForOneThreadAndTwo) {
  folder_.write("p.csv", "0,0,1.1\n0.1,0,1.2\n");
  const std::map<std::string, std::vector<std::string>> commands = {
      {"a.skel.json", {"grow", at("tiny.tree.toml")}}, {"a.blob.json", {"surface", at("tiny.tree.toml")}},
      {"a.txt", {"derive", at("tiny.tree.toml")}},     {"a.csv", {"eval", at("tiny.tree.toml"), "--points", at("p.csv")}},
      {"a.glb", {"mesh", at("tiny.tree.toml")}},       {"a.ply", {"mesh", at("tiny.tree.toml")}},
      {"a.vdb", {"volume", at("tiny.tree.toml")}},     {"a.png", {"render", at("tiny.tree.toml")}},
      {"a.exr", {"render", at("tiny.tree.toml")}}};
  for (const auto& [name, arguments] : commands) {
    SCOPED_TRACE(name);
    std::string bytes[2];
    for (const int threads : {1, 2}) {
      std::vector<std::string> all = arguments;
      for (const std::string& more : {std::string("-o"), at(name), std::string("--threads"), std::to_string(threads)})
        all.push_back(more);
      figures(all);
      bytes[threads - 1] = folder_.read(name);
    }
    EXPECT_FALSE(bytes[0].empty());
    EXPECT_TRUE(bytes[0] == bytes[1]);
  }
}

TEST_F(Commands, SeedChangesAStochasticString) {
  folder_.write("dice.l", "lsystem: dice\nderivation length: 40\naxiom: A\nA --> FA : 1\nA --> fA : 1\nendlsystem\n");
  const std::string first = run_program({"derive", at("dice.l"), "--seed", "1"}).out;
  EXPECT_GT(first.size(), 40u);
  EXPECT_EQ(run_program({"derive", at("dice.l"), "--seed", "1", "--threads", "1"}).out, first);
  EXPECT_NE(run_program({"derive", at("dice.l"), "--seed", "2"}).out, first);
}

TEST_F(Commands, HelpAndVersionAreNoErrors) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"}, {"--version"}, {"mesh", "--help"}}) {
    const Ran ran = run_program(arguments);
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.err, "");
    EXPECT_NE(ran.out, "");
  }
}

}  // namespace
}  // namespace cambium
