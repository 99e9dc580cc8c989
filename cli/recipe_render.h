// The [render] table of a recipe: picture, camera and light.
#pragma once

#include "cli/recipe.h"
#include "cli/recipe_value.h"

namespace cambium {

/// Errors: InputError with the place, as RecipeValue's.
void read_render(const RecipeValue& table, RenderRecipe& render);

}  // namespace cambium
