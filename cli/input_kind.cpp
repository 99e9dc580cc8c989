#include "cli/input_kind.h"

#include "cli/output_file.h"

namespace cambium {

InputKind input_kind(const std::filesystem::path& path) {
  const std::string extension = require_extension(path, {".tree.toml", ".l", ".lpy", ".skel.json", ".swc", ".csv", ".blob.json"});
  if (extension == ".tree.toml") return InputKind::kRecipe;
  if (extension == ".l" || extension == ".lpy") return InputKind::kLSystem;
  if (extension == ".blob.json") return InputKind::kBlobTree;
  return InputKind::kSkeleton;
}

}  // namespace cambium
