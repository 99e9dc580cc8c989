// The [base] table of a recipe: the trunk's flare, its surface roots, the ground.
#pragma once

#include "cli/recipe_value.h"
#include "skeletons/trunk_base.h"

namespace cambium {

/// Errors: InputError with the place, as RecipeValue's.
TrunkBase read_trunk_base(const RecipeValue& table);

}  // namespace cambium
