#include "cli/recipe_graph.h"

#include <limits>

#include "cli/recipe_graph_tables.h"

namespace cambium {
namespace {

// ---- [light], [wind] -------------------------------------------------------------------------------------------
const KeyRule<GraphLight> kLightKeys[] = {
    {"direction", [](const RecipeValue& v, GraphLight& l) { l.direction = v.direction(); }},
    {"on_endpoints", [](const RecipeValue& v, GraphLight& l) { l.on_endpoints = v.flag(); }},
    {"on_lifespan", [](const RecipeValue& v, GraphLight& l) { l.on_lifespan = v.flag(); }},
};

const KeyRule<GraphWind> kWindKeys[] = {
    {"direction", [](const RecipeValue& v, GraphWind& w) { w.direction = v.direction(); }},
    {"strength", [](const RecipeValue& v, GraphWind& w) { w.strength = v.number(0, 1000); }},
};

// ---- [edges], [refinement] -------------------------------------------------------------------------------------
const KeyRule<EdgeOptions> kEdgeKeys[] = {
    {"rule",
     [](const RecipeValue& v, EdgeOptions& e) {
       e.rule = v.choice({"yao", "threshold"}) == 0 ? EdgeRule::kYao : EdgeRule::kThreshold;
     }},
    {"sectors", [](const RecipeValue& v, EdgeOptions& e) { e.sectors = static_cast<int>(v.integer(4, 64)); }},
    {"threshold", [](const RecipeValue& v, EdgeOptions& e) { e.threshold = v.number(1.01, 100); }},
};

const KeyRule<GraphRefinement> kRefinementKeys[] = {
    {"spheres", [](const RecipeValue& v, GraphRefinement& r) { r.spheres = static_cast<std::size_t>(v.integer(2, 64)); }},
    {"radius", [](const RecipeValue& v, GraphRefinement& r) { r.radius = v.number(0.01, 10); }},
    {"cone_radius", [](const RecipeValue& v, GraphRefinement& r) { r.cone_radius = v.number(0.01, 1); }},
};

// ---- [skeleton.graph] ------------------------------------------------------------------------------------------
/// Those that a root system has as well.
const KeyRule<GraphRecipe> kGraphKeys[] = {
    {"volume", [](const RecipeValue& v, GraphRecipe& g) { g.volume = read_solids(v); }},
    {"refinement", [](const RecipeValue& v, GraphRecipe& g) { read_table(v, kRefinementKeys, g.options.refinement.emplace()); }},
    {"level", read_levels},
    {"edges", [](const RecipeValue& v, GraphRecipe& g) { read_table(v, kEdgeKeys, g.options.edges); }},
    {"weights", read_weights},
    {"obstacle", read_obstacles},
    {"lifespan", [](const RecipeValue& v, GraphRecipe& g) { read_lifespan(v, g.options.lifespan); }},
    {"light", [](const RecipeValue& v, GraphRecipe& g) { read_table(v, kLightKeys, g.options.light.emplace()); }},
    {"wind", [](const RecipeValue& v, GraphRecipe& g) { read_table(v, kWindKeys, g.options.wind.emplace()); }},
    {"thickness", [](const RecipeValue& v, GraphRecipe& g) { read_thickness(v, g.options.thickness); }},
    {"smoothing", [](const RecipeValue& v, GraphRecipe& g) { g.options.smoothing = static_cast<int>(v.integer(0, 1000)); }},
};

void require_volume_and_levels(const RecipeValue& table, const GraphRecipe& graph) {
  if (graph.volume.empty()) throw InputError(table.location(), "no volume", "[[" + table.path() + ".volume]]");
  if (graph.levels.empty()) throw InputError(table.location(), "no level", "[[" + table.path() + ".level]]");
}

void read_roots(const RecipeValue& v, GraphRecipe& g) {
  GraphRecipe& roots = g.roots.emplace_back();
  read_table(v, kGraphKeys, roots);
  require_volume_and_levels(v, roots);
  for (const auto& [name, place] : roots.places) g.places.emplace("roots: " + name, place);   // of its levels
}

/// Those of the whole tree alone.
const KeyRule<GraphRecipe> kTreeKeys[] = {
    {"seed",
     [](const RecipeValue& v, GraphRecipe& g) {
       g.options.seed = static_cast<std::uint64_t>(v.integer(0, std::numeric_limits<std::int64_t>::max()));
     }},
    {"root", [](const RecipeValue& v, GraphRecipe& g) { g.options.root = v.point(); }},
    {"roots", read_roots},
    {"with_roots", [](const RecipeValue& v, GraphRecipe& g) { g.options.with_roots = v.flag(); }},
};

// ---- Places ----------------------------------------------------------------------------------------------------
std::string name_in(const std::string& table, const std::string& key) { return table.empty() ? key : table + ": " + key; }

void note_places_of(const RecipeValue& v, const std::string& table, const std::string& key, GraphPlaces& places) {
  if (v.is_table()) {
    note_places(v, name_in(table, key), places);
    return;
  }
  places[name_in(table, key)] = v.location();
  if (!v.is_array() || key == "level") return;   // a level's number is not that of its table
  const auto elements = v.elements();
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements[i].is_table()) note_places(elements[i], name_in(table, key + " " + std::to_string(i + 1)), places);
}

}  // namespace

void note_places(const RecipeValue& table, const std::string& name, GraphPlaces& places) {
  places[name] = table.location();
  for (const auto& [key, node] : table.table())
    note_places_of(RecipeValue(table.source(), node, table.child_path(key.str())), name, std::string(key.str()), places);
}

GraphRecipe read_graph(const RecipeValue& table) {
  GraphRecipe graph;
  read_table(table, kTreeKeys, graph, keys_of(kGraphKeys));
  read_table(table, kGraphKeys, graph, keys_of(kTreeKeys));
  require_volume_and_levels(table, graph);
  note_places(table, "", graph.places);
  return graph;
}

std::set<std::string> graph_recipe_keys() {
  KeySet keys;
  add_keys("", kTreeKeys, keys);
  add_keys("", kGraphKeys, keys);
  add_solid_keys("volume.", keys);
  add_keys("refinement.", kRefinementKeys, keys);
  add_level_keys("level.", keys);
  add_keys("edges.", kEdgeKeys, keys);
  add_weight_keys("weights.", keys);
  add_obstacle_keys("obstacle.", keys);
  add_lifespan_keys("lifespan.", keys);
  add_keys("light.", kLightKeys, keys);
  add_keys("wind.", kWindKeys, keys);
  add_thickness_keys("thickness.", keys);
  return keys;
}

}  // namespace cambium
