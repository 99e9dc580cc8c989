// Meshes to files, chosen by extension: .obj .ply .stl .off (OpenMesh), .glb (tinygltf).
#pragma once

#include "polygonize/mesh.h"

#include <filesystem>
#include <string>

namespace cambium {

enum class UpAxis { kZ, kY };

/// Writes to exactly `path` (the caller writes beside and renames); `format` is the extension with its dot (".obj"), since the
/// path may be a temporary name. glTF is always y-up. Errors: InputError for an unknown extension, std::runtime_error naming
/// the path when the disk or the writer fails.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const std::string& format, UpAxis up);

}  // namespace cambium
