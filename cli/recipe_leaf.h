// The [[leaf]] tables of a recipe.
#pragma once

#include "cli/recipe.h"
#include "cli/recipe_value.h"

namespace cambium {

/// Errors: InputError with the place, as RecipeValue's.
std::vector<LeafRecipe> read_leaves(const RecipeValue& array);

}  // namespace cambium
