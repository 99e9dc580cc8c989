#include <algorithm>
#include <cctype>

#include "cli/recipe_graph.h"

namespace cambium {
namespace {

bool goes_on_as_word(std::string_view text, std::size_t at) {
  return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_');
}

/// Of the longest name that the text begins with; the graph's own if there is none.
SourceLocation place_of(std::string_view text, const GraphPlaces& places) {
  std::string_view best;
  SourceLocation place;
  for (const auto& [name, at] : places) {
    if (name.size() < best.size() || !text.starts_with(name) || (!name.empty() && goes_on_as_word(text, name.size()))) continue;
    best = name, place = at;
  }
  return place;
}

}  // namespace

std::optional<GraphPlan> plan_tree(const GraphRecipe& recipe, const RunOptions& run) {
  const GraphOptions options = load_graph(recipe);
  try {
    return plan_tree(options, run);
  } catch (const InputError& error) {
    if (!error.location().file.empty()) throw;
    throw InputError(place_of(error.found(), recipe.places), error.found(), error.expected());
  }
}

}  // namespace cambium
