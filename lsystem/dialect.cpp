#include "lsystem/dialect.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace cambium {

std::optional<Dialect> dialect_named(std::string_view name) {
  if (name == "cpfg") return Dialect::kCpfg;
  if (name == "lpy") return Dialect::kLpy;
  if (name == "houdini") return Dialect::kHoudini;
  return std::nullopt;
}

Dialect dialect_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".lpy" ? Dialect::kLpy : Dialect::kCpfg;
}

}  // namespace cambium
