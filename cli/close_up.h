// Pictures of a branch by its number.
#pragma once

#include <span>

#include "blobtree/branch_info.h"
#include "blobtree/field.h"
#include "cli/recipe.h"

namespace cambium {

/// Turns the branches that a recipe names into a place: a close-up frames where the branch leaves its parent, some six of its parent's
/// radii across, and a branch to focus on is met there too. Errors: InputError at the number where there is no such branch, or
/// where branches are not known: in a BlobTree file.
void aim_at_branches(RenderRecipe& render, const Field& field, std::span<const BranchInfo> branches);

}  // namespace cambium
