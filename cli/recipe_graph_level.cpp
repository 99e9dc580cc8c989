#include "cli/recipe_graph_tables.h"

namespace cambium {
namespace {

constexpr std::int64_t kMostNodes = std::int64_t{1} << 31;
constexpr std::int64_t kMostEndpoints = 100'000'000;
constexpr std::int64_t kMostLevels = 99;

/// A level while it is read.
struct LevelTable {
  GraphLevelRecipe recipe;
  std::int64_t first = 1, last = 1;      ///< the levels that it describes
};

// ---- Its graph -------------------------------------------------------------------------------------------------
void read_orientation(const RecipeValue& v, LevelTable& l) {
  constexpr GraphOrientation kOrientations[] = {GraphOrientation::kOutward, GraphOrientation::kVertical, GraphOrientation::kRandom};
  l.recipe.level.orientation = kOrientations[v.choice({"outward", "vertical", "random"})];
}

const KeyRule<GraphTurn> kTurnKeys[] = {
    {"angle", [](const RecipeValue& v, GraphTurn& t) { t.angle = v.degrees(); }},
    {"axis", [](const RecipeValue& v, GraphTurn& t) { t.axis = v.direction(); }},
};

// ---- Its endpoints ---------------------------------------------------------------------------------------------
int endpoint_count(const RecipeValue& v) { return static_cast<int>(v.integer(0, kMostEndpoints)); }

/// A number, or [least, most].
void read_endpoint_count(const RecipeValue& v, LevelTable& l) {
  std::array<int, 2>& endpoints = l.recipe.level.endpoints;
  if (!v.is_array()) {
    endpoints.fill(endpoint_count(v));
    return;
  }
  const auto range = v.elements(2);
  endpoints = {endpoint_count(range[0]), endpoint_count(range[1])};
  if (endpoints[0] > endpoints[1]) v.refuse("[least, most]");
}

/// Of level 1 a length, of the others a part of r.
void read_shell(const RecipeValue& v, LevelTable& l) {
  GraphLevel& level = l.recipe.level;
  level.shell = l.first == 1 ? v.not_negative_length() : v.number(0, 2);
  level.placement = EndpointPlacement::kShell;
}

void read_placement(const RecipeValue& v, LevelTable& l) {
  constexpr EndpointPlacement kPlacements[] = {EndpointPlacement::kUniform, EndpointPlacement::kShell, EndpointPlacement::kTaproot};
  const bool shell_given = l.recipe.level.placement == EndpointPlacement::kShell;
  l.recipe.level.placement = kPlacements[v.choice({"uniform", "shell", "taproot"})];
  const bool shell_needed = l.recipe.level.placement != EndpointPlacement::kUniform;
  if (shell_needed && !shell_given) v.refuse("d_e beside it");
  if (!shell_needed && shell_given) v.refuse("\"shell\" or \"taproot\": d_e is beside it");
}

void read_given_endpoints(const RecipeValue& v, LevelTable& l) {
  for (const RecipeValue& endpoint : v.elements()) l.recipe.level.given_endpoints.push_back(endpoint.point());
}

// In this order: a placement is checked against d_e.
const KeyRule<LevelTable> kLevelKeys[] = {
    {"levels", [](const RecipeValue&, LevelTable&) {}},   // read before all others
    {"k", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.nodes = static_cast<std::size_t>(v.integer(1, kMostNodes)); }},
    {"d", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.spacing = v.positive_length(); }},
    {"alpha", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.alpha = v.degrees(0.1, 180); }},
    {"r", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.radius = v.positive_length(); }},
    {"a", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.shrink = v.positive(); }},
    {"shape", [](const RecipeValue& v, LevelTable& l) { l.recipe.shape = read_solids(v); }},
    {"v_g", read_orientation},
    {"turn", [](const RecipeValue& v, LevelTable& l) { read_table(v, kTurnKeys, l.recipe.level.turn); }},
    {"around_all", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.around_all = v.flag(); }},
    {"b", read_endpoint_count},
    {"d_e", read_shell},
    {"placement", read_placement},
    {"at", read_given_endpoints},
    {"zeta", [](const RecipeValue& v, LevelTable& l) { l.recipe.level.zeta = v.positive(); }},
};

// ---- Which levels ----------------------------------------------------------------------------------------------
/// The next one, or what `levels` says: a number, or [first, last].
void read_range(const RecipeValue& table, std::int64_t next, LevelTable& l) {
  l.first = l.last = next;
  const toml::node* node = table.table().get("levels");
  if (!node) return;
  const RecipeValue v(table.source(), *node, table.child_path("levels"));
  if (v.is_array()) {
    const auto range = v.elements(2);
    l.first = range[0].integer(1, kMostLevels), l.last = range[1].integer(1, kMostLevels);
  } else {
    l.first = l.last = v.integer(1, kMostLevels);
  }
  const std::string begin = std::to_string(next);
  if (l.first != next || l.last < l.first) v.refuse(begin + ", the next level, or [" + begin + ", last]");
}

/// Level 1 has the graph's own volume; the others' endpoints are in a frame of their own.
void refuse_keys_of_other_levels(const RecipeValue& table, const LevelTable& l) {
  const auto refuse = [&](const char* key, const char* expected) {
    if (const toml::node* node = table.table().get(key)) RecipeValue(table.source(), *node, table.child_path(key)).refuse(expected);
  };
  if (l.last > 1) refuse("at", "endpoints that are given at level 1 alone");
  if (l.first == 1 && l.last > 1) refuse("d_e", "it for level 1 by itself, in metres: that of the others is in parts of r");
  if (l.first > 1) return;
  for (const char* key : {"alpha", "r", "a", "shape", "v_g", "turn", "around_all"})
    refuse(key, "it from level 2 on: the volume of level 1 is [[skeleton.graph.volume]]");
}

}  // namespace

void read_levels(const RecipeValue& array, GraphRecipe& graph) {
  for (const RecipeValue& element : array.elements()) {
    LevelTable table;
    read_range(element, static_cast<std::int64_t>(graph.levels.size()) + 1, table);
    refuse_keys_of_other_levels(element, table);
    read_table(element, kLevelKeys, table);
    for (std::int64_t level = table.first; level <= table.last; ++level) {
      graph.levels.push_back(table.recipe);
      note_places(element, "level " + std::to_string(level), graph.places);
    }
  }
}

void add_level_keys(const std::string& prefix, KeySet& keys) {
  add_keys(prefix, kLevelKeys, keys);
  add_keys(prefix + "turn.", kTurnKeys, keys);
}

}  // namespace cambium
