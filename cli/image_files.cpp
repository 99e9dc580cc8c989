#include "cli/image_files.h"

#include <algorithm>

#include "cli/read_text.h"
#include "polygonize/mesh_io.h"

namespace cambium {

std::shared_ptr<const std::string> ImageFiles::read(const std::filesystem::path& path, const std::string& otherwise) {
  const auto known = std::find_if(read_.begin(), read_.end(), [&](const auto& entry) { return entry.first == path; });
  if (known != read_.end()) return known->second;
  auto bytes = std::make_shared<const std::string>(read_text(path));
  if (image_type(*bytes).empty()) {
    warnings_.push_back(path.string() + " is neither PNG nor JPEG, as a .glb's textures are: " + otherwise);
    bytes = nullptr;
  }
  return read_.emplace_back(path, std::move(bytes)).second;
}

}  // namespace cambium
