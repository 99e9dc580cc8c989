// A whole input file at once.
#pragma once

#include <filesystem>
#include <string>

#include "blobtree/input_error.h"

namespace cambium {

/// Errors: InputError at `named_at` (or at the path itself) if there is no such readable regular file.
void require_readable(const std::filesystem::path& path, const SourceLocation* named_at = nullptr);

/// Errors: as require_readable.
std::string read_text(const std::filesystem::path& path);

}  // namespace cambium
