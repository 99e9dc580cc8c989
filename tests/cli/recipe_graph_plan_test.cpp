// From a recipe's graph to a tree: the files that it names, the planner's errors, the program.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/recipe.h"
#include "program.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

constexpr const char* kLeast = "[skeleton.graph]\n[[skeleton.graph.volume]]\nshape = \"ball\"\n[[skeleton.graph.level]]\nk = 30\n";

GraphRecipe read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  TemporaryFolder folder;
  return *read_recipe(folder.write("a.tree.toml", text), overrides).skeleton.graph;
}

TEST(RecipeGraphPlan, WhatThePlannerRefusesIsToldAtItsPlace) {
  const struct { const char* text; int line, column; const char* in_message; } table[] = {
      {"b = 30\n", 6, 5, "level 1: b"},                                                    // as many endpoints as nodes
      {"b = 3\n[[skeleton.graph.level]]\nb = 300\n", 8, 5, "level 2: b"},
      {"b = 3\n[[skeleton.graph.roots.volume]]\nshape = \"ball\"\n[[skeleton.graph.roots.level]]\nk = 4\nb = 9\n", 11, 5, "roots: level 1: b"},
      {"b = 3\n[skeleton.graph.thickness]\ntip_radius = 2\n", 8, 14, "tip_radius"},
      {"b = 3\n[skeleton.graph.edges]\nrule = \"threshold\"\nthreshold = 90\n", 9, 13, "threshold"},
  };
  for (const auto& bad : table) {
    SCOPED_TRACE(bad.text);
    const GraphRecipe graph = read(std::string(kLeast) + bad.text);
    try {
      plan_tree(graph, {});
      FAIL() << "was planned";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, bad.line) << error.what();
      EXPECT_EQ(error.location().column, bad.column) << error.what();
      EXPECT_NE(error.found().find(bad.in_message), std::string::npos) << error.what();
    }
  }
}

/// [[volume]] of `keys` beside `file`, planned.
std::optional<GraphPlan> planned_in(const std::string& keys, const char* file, const char* text) {
  TemporaryFolder folder;
  folder.write(file, text);
  const std::string recipe = "[skeleton.graph]\nroot = [0, 0, 0.1]\n[[skeleton.graph.volume]]\n" + keys + "[[skeleton.graph.level]]\nk = 200\nb = 20\n";
  return plan_tree(*read_recipe(folder.write("a.tree.toml", recipe), {}).skeleton.graph, {});
}

constexpr const char* kTetrahedron = "v 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST(RecipeGraphPlan, GrowsInAMeshAndInADrawingsStroke) {
  const auto in_mesh = planned_in("shape = \"mesh\"\nmesh = \"crown.obj\"\norigin = [-0.1, -0.1, 0]\n", "crown.obj", kTetrahedron);
  for (const SkeletonNode& node : in_mesh->skeleton.nodes) {
    const Vec3 p = node.position + Vec3(0.1, 0.1, 0);
    EXPECT_LE(p.x + p.y + p.z, 3 + 1e-9);
    EXPECT_GE(std::min({p.x, p.y, p.z}), -1e-9);
  }
  const auto in_stroke = planned_in("shape = \"revolution\"\nsvg = \"cone.svg\"\nheight = 2\n", "cone.svg",
                                    "<svg><path d=\"M 0 10 L 5 10 L 0 0\"/></svg>");   // a cone as wide as high
  for (const SkeletonNode& node : in_stroke->skeleton.nodes)
    EXPECT_LE(std::hypot(node.position.x, node.position.y), 0.5 * (2 - node.position.z) + 1e-9);
  EXPECT_EQ(in_stroke->endpoints.size(), 20u);
}

TEST(RecipeGraphPlan, FilesThatAreNoSolidAreRefused) {
  const struct { const char* keys; const char* file; const char* text; const char* named; int line; const char* in_message; } table[] = {
      {"shape = \"mesh\"\nmesh = \"a.obj\"\n", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n", "a.tree.toml", 5, "open mesh"},
      {"shape = \"mesh\"\nmesh = \"a.obj\"\n", "a.obj", "v 0 0 0\nv 1 0 x\n", "a.obj", 2, "x"},
      {"shape = \"mesh\"\nmesh = \"none.obj\"\n", "a.obj", "", "a.tree.toml", 5, "no file"},
      {"shape = \"revolution\"\nsvg = \"a.svg\"\n", "a.svg", "<svg/>", "a.svg", 0, "path"},
      {"shape = \"revolution\"\nsvg = \"a.svg\"\nsvg_axis = 2\n", "a.svg", "<svg><path d=\"M 0 0 L 5 5 L 1 9\"/></svg>", "a.svg", 1, "axis"},
  };
  for (const auto& bad : table) {
    SCOPED_TRACE(bad.text);
    try {
      planned_in(bad.keys, bad.file, bad.text);
      FAIL() << "was planned";
    } catch (const InputError& error) {
      const std::filesystem::path named = error.location().file == "none.obj" ? bad.named : error.location().file;
      EXPECT_EQ(named.filename(), bad.named) << error.what();
      EXPECT_TRUE(bad.line == 0 || error.location().line == bad.line) << error.what();
      EXPECT_NE(std::string(error.what()).find(bad.in_message), std::string::npos) << error.what();
    }
  }
}

TEST(RecipeGraphPlan, TheProgramGrowsItByTheSeedAtAnyThreadCount) {
  TemporaryFolder folder;
  const std::string recipe = folder.write("a.tree.toml", std::string(kLeast) + "b = 6\n[[skeleton.graph.level]]\nk = 40\nb = 4\n");
  const auto grown = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"grow", recipe, "-o", folder.path("a.skel.json"), "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run_program(arguments).status, 0);
    return folder.read("a.skel.json");
  };
  const std::string one = grown({"--threads", "1"});
  EXPECT_EQ(one, grown({"--threads", "4"}));
  EXPECT_NE(one, grown({"--seed", "2"}));
  EXPECT_EQ(grown({"--seed", "2"}), grown({"--set", "skeleton.graph.seed=2"}));
}

TEST(RecipeGraphPlan, TheProgramTellsWhatWasPlanned) {
  TemporaryFolder folder;
  const std::string recipe = folder.write("a.tree.toml", std::string(kLeast) + "b = 6\n[[skeleton.graph.level]]\nk = 40\nb = 4\n");
  const auto figures = nlohmann::json::parse(run_program({"info", recipe, "--json"}).out);
  const auto& graph = figures["graph"];
  EXPECT_EQ(graph["endpoints"], 6 + 6 * 4);
  EXPECT_EQ(graph["nodes"], 30 + 6 * 40);
  ASSERT_EQ(graph["levels"].size(), 2u);
  EXPECT_EQ(graph["levels"][1]["graphs"], 6);
  EXPECT_GT(graph["levels"][0]["edges"], 29);
  EXPECT_TRUE(graph.contains("repaired"));
  EXPECT_EQ(figures["roots"], 1);
}

}  // namespace
}  // namespace cambium
