// A file that a recipe names.
#pragma once

#include "blobtree/input_error.h"

#include <filesystem>

namespace cambium {

/// Only commands that need it read it.
struct NamedFile {
  std::filesystem::path file;
  SourceLocation named_at;
};

}  // namespace cambium
