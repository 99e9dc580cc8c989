// [skeleton.graph] of a recipe: a tree that is planned through random graphs.
#pragma once

#include "cli/named_file.h"
#include "skeletons/graph/plan.h"
#include "skeletons/graph/svg_path.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace cambium {

/// A solid; which one, is known once its file is read if it has one.
struct GraphSolidRecipe {
  PlacedSolid placed;
  std::optional<NamedFile> svg;                ///< with the stroke of a solid of revolution
  SvgStrokeOptions svg_options;
  std::optional<NamedFile> mesh;               ///< .obj or .ply
};

struct GraphLevelRecipe {
  GraphLevel level;                            ///< without its shape
  std::vector<GraphSolidRecipe> shape;
};

/// Where settings stand, by the names that the planner's errors give them: "level 2", "level 2: alpha", "roots: volume 1: radius".
using GraphPlaces = std::map<std::string, SourceLocation>;

struct GraphRecipe {
  GraphOptions options;                        ///< without what the members below say
  std::vector<GraphSolidRecipe> volume, obstacles;
  std::vector<HalfSpaceObstacle> half_spaces;
  std::vector<GraphLevelRecipe> levels;
  std::vector<WeightBall> weight_balls;
  std::optional<NamedFile> weight_volume;      ///< .vdb
  std::vector<GraphRecipe> roots;              ///< one at most
  GraphPlaces places;
};

/// All keys that [skeleton.graph] may have: "root", "level", "level.alpha". Those of "roots", and of the solids of "level.shape" and
/// "obstacle", are named once, as the graph's and its "volume"'s.
std::set<std::string> graph_recipe_keys();

/// All of it for the planner, with the files read. Errors: InputError in a file, or where the recipe names it.
GraphOptions load_graph(const GraphRecipe& recipe);

/// As plan_tree. Errors: InputError at the place in the recipe that the planner's error speaks of, else at the graph's own.
std::optional<GraphPlan> plan_tree(const GraphRecipe& recipe, const RunOptions& run);

}  // namespace cambium
