// The tables of [skeleton.graph], read. Private to the recipe's reading. Errors of all: InputError with the place, as RecipeValue's.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "cli/recipe_graph.h"
#include "cli/recipe_value.h"

namespace cambium {

GraphRecipe read_graph(const RecipeValue& table);

/// Notes the table as `name`, its keys as "name: key", and tables in it likewise; those of arrays by number from 1.
void note_places(const RecipeValue& table, const std::string& name, GraphPlaces& places);

/// [[volume]], and [[shape]] of a level.
std::vector<GraphSolidRecipe> read_solids(const RecipeValue& array);
/// [[obstacle]]: solids and half-spaces.
void read_obstacles(const RecipeValue& array, GraphRecipe& graph);
/// [[level]], in order.
void read_levels(const RecipeValue& array, GraphRecipe& graph);
void read_lifespan(const RecipeValue& table, Lifespan& lifespan);
void read_thickness(const RecipeValue& table, GraphThickness& thickness);
void read_weights(const RecipeValue& table, GraphRecipe& graph);

// For graph_recipe_keys(): taken from the rules that read them.
using KeySet = std::set<std::string>;

void add_solid_keys(const std::string& prefix, KeySet& keys);
/// Those of half-spaces; the others are a solid's.
void add_obstacle_keys(const std::string& prefix, KeySet& keys);
/// But those of its shapes, which are a solid's.
void add_level_keys(const std::string& prefix, KeySet& keys);
void add_lifespan_keys(const std::string& prefix, KeySet& keys);
void add_thickness_keys(const std::string& prefix, KeySet& keys);
void add_weight_keys(const std::string& prefix, KeySet& keys);

template <class Part, std::size_t N>
void add_keys(const std::string& prefix, const KeyRule<Part> (&rules)[N], KeySet& keys) {
  for (const char* key : keys_of(rules)) keys.insert(prefix + key);
}

}  // namespace cambium
