// What OpenVDB makes of a volume that was written.
#pragma once

#include "polygonize/mesh.h"

#include <filesystem>

namespace cambium::testing {

/// Where the only grid of a file is 0, by OpenVDB's own contouring without adaptivity. No normals.
Mesh zero_set(const std::filesystem::path& path);

}  // namespace cambium::testing
