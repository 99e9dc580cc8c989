// Images as a .glb takes them along: the file's own bytes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cambium {

/// Each is read once: orders and leaves often share one. `warnings` must outlive it.
class ImageFiles {
 public:
  explicit ImageFiles(std::vector<std::string>& warnings) : warnings_(warnings) {}

  /// Null, with a warning that ends in `otherwise`, where the file is no PNG or JPEG. Errors: InputError if it cannot be read.
  std::shared_ptr<const std::string> read(const std::filesystem::path& path, const std::string& otherwise);

 private:
  std::vector<std::pair<std::filesystem::path, std::shared_ptr<const std::string>>> read_;
  std::vector<std::string>& warnings_;
};

}  // namespace cambium
