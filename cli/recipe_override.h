// `--set key=value` on a recipe. Private to the recipe's reading.
#pragma once

#include <toml++/toml.h>

#include <string>

#include "cli/recipe_value.h"

namespace cambium {

/// Applies `text` = "dotted.key=value" to `root` and notes it in `source`. A part of the key that is a number is an index
/// into an array; one past the end appends. The value is TOML; what is not TOML is a string, so that `mesh.voxel=5mm` works.
/// Errors: InputError naming the text.
void apply_override(const std::string& text, toml::table& root, RecipeSource& source);

}  // namespace cambium
