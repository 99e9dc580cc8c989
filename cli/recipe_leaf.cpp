#include "cli/recipe_leaf.h"

#include <algorithm>
#include <cctype>

namespace cambium {
namespace {

void read_name(const RecipeValue& v, LeafRecipe& leaf) {
  leaf.name = v.text();
  if (!leaf.name.empty() && leaf.name.front() == '~') leaf.name.erase(0, 1);   // as the L-system writes it
  if (leaf.name.empty()) v.refuse("the name of an organ: that of a ~name, polygon1, polygon, or * for all");
}

void read_mesh(const RecipeValue& v, LeafRecipe& leaf) {
  if (leaf.card) v.refuse("either mesh or size, not both");
  leaf.mesh = {v.file(), v.location()};
  std::string extension = leaf.mesh->file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".obj") v.refuse("an .obj file");
}

void read_card(const RecipeValue& v, LeafRecipe& leaf) {
  const auto sides = v.elements(2);
  leaf.card = {sides[0].positive_length(), sides[1].positive_length()};
}

void read_color(const RecipeValue& v, LeafRecipe& leaf) {
  leaf.color = v.color();
  for (int c = 0; c < 3; ++c)
    if ((*leaf.color)[c] > 1) v.refuse("shares of light from 0 to 1");
}

const KeyRule<LeafRecipe> kLeafKeys[] = {
    {"name", read_name},
    {"size", read_card},
    {"mesh", read_mesh},
    {"scale", [](const RecipeValue& v, LeafRecipe& l) { l.scale = v.positive(); }},
    {"color", read_color},
    {"texture", [](const RecipeValue& v, LeafRecipe& l) { l.texture = {v.file(), v.location()}; }},
    {"translucency", [](const RecipeValue& v, LeafRecipe& l) { l.translucency = v.number(0, 1); }},
    {"roughness", [](const RecipeValue& v, LeafRecipe& l) { l.roughness = v.number(0.05, 1); }},
};

}  // namespace

bool is_outline(std::string_view organ) {
  constexpr std::string_view kDrawn = "polygon";
  return organ.starts_with(kDrawn) && organ.size() > kDrawn.size() &&
         std::all_of(organ.begin() + kDrawn.size(), organ.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool LeafRecipe::matches(std::string_view organ) const {
  return name == "*" || name == organ || (name == "polygon" && is_outline(organ));
}

std::vector<LeafRecipe> read_leaves(const RecipeValue& array) {
  std::vector<LeafRecipe> leaves;
  for (const RecipeValue& element : array.elements()) read_table(element, kLeafKeys, leaves.emplace_back());
  return leaves;
}

}  // namespace cambium
