// The [render] table of a recipe: picture, camera and light.
#pragma once

#include "cli/recipe.h"
#include "cli/recipe_value.h"

namespace cambium {

/// Errors: InputError with the place, as RecipeValue's.
void read_render(const RecipeValue& table, RenderRecipe& render);

/// What parse_samples found. A least number that was not given stays as it is, if it is not more than the most.
void set_samples(const std::pair<std::optional<int>, int>& least_and_most, Sampling& sampling);

/// Errors: InputError at `at` if the crop is not a part of the picture.
void check_crop(const RenderOptions& options, const SourceLocation& at);

}  // namespace cambium
