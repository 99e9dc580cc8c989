// The [render.light] table of a recipe: sky, sun, surroundings, lamps and ground.
#pragma once

#include "cli/recipe.h"
#include "cli/recipe_value.h"

namespace cambium {

/// Errors: InputError with the place, also for keys that do not go together: those of one kind of sky with another's.
void read_light(const RecipeValue& table, RenderRecipe& render);

/// [render] background: "sky", "transparent" or a colour.
void read_backdrop(const RecipeValue& value, Light& light);

}  // namespace cambium
