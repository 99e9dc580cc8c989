// Inputs, told apart by extension.
#pragma once

#include <filesystem>

namespace cambium {

enum class InputKind { kRecipe, kLSystem, kSkeleton, kBlobTree };

/// Case does not matter. Errors: InputError naming the path for any other extension.
InputKind input_kind(const std::filesystem::path& path);

}  // namespace cambium
