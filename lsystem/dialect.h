// The languages of other programs that L-systems may be written in.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace cambium {

enum class Dialect { kCpfg, kLpy, kHoudini };

/// That of `cpfg`, `lpy` or `houdini`.
std::optional<Dialect> dialect_named(std::string_view name);

/// What a file says of itself: `.lpy` is L-Py's, anything else cpfg's.
Dialect dialect_of(const std::filesystem::path& file);

}  // namespace cambium
