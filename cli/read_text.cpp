#include "cli/read_text.h"

#include <unistd.h>

#include <fstream>
#include <iterator>

namespace cambium {

void require_readable(const std::filesystem::path& path, const SourceLocation* named_at) {
  const SourceLocation at = named_at ? *named_at : SourceLocation{path.string()};
  const std::string name = named_at ? " '" + path.string() + "'" : "";
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(at, "no file" + name, "an existing file");
  if (std::filesystem::is_directory(status)) throw InputError(at, "a directory" + name, "a file");
  if (::access(path.c_str(), R_OK) != 0) throw InputError(at, "an unreadable file" + name, "a readable file");
}

std::string read_text(const std::filesystem::path& path) {
  require_readable(path);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace cambium
