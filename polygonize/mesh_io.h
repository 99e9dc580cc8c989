// Meshes to files, chosen by extension: .glb, .obj, .ply, .stl, .off.
#pragma once

#include "blobtree/sheet.h"
#include "polygonize/mesh.h"
#include "polygonize/mesh_attributes.h"

#include <array>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

enum class UpAxis { kZ, kY };

/// What one order of branches is covered with.
struct MeshMaterial {
  std::string name = "bark";
  std::array<float, 3> color{1, 1, 1};           ///< linear; multiplies the texture and the vertex colours
  float roughness = 0.9f;
  std::shared_ptr<const std::string> texture;    ///< as image_type has it; null: none. Shared ones are stored once
  std::shared_ptr<const std::string> normal_map = nullptr;      ///< likewise; y upwards in the image
  std::shared_ptr<const std::string> roughness_map = nullptr;   ///< likewise; roughness in green, times the number above
  bool leaf = false;                             ///< seen from both sides, and cut out where the texture's alpha is below a half
};

/// Leaves of one material, each where it is. Open, so they are no part of any level's closed mesh.
struct MeshLeaves {
  Sheet sheet;                                   ///< metres, z up
  std::vector<std::uint32_t> branch;             ///< by vertex: which branch bears its leaf
  std::vector<glm::vec3> pivot;                  ///< by vertex: where its leaf is held
  MeshMaterial material;
};

/// "image/png" or "image/jpeg", by a file's first bytes; "" for anything else, which no .glb can take along.
std::string image_type(std::string_view bytes);

struct MeshLevel {
  const Mesh* mesh = nullptr;
  const MeshAttributes* attributes = nullptr;    ///< of this mesh; null: none
  double screen_coverage = 0;                    ///< share of the screen's height down to which this level is meant to be used
};

/// What goes into one file; the pointers must outlive the writing.
struct MeshFile {
  std::vector<MeshLevel> levels;                 ///< finest first; only .glb takes more than one (MSFT_lod)
  std::vector<MeshMaterial> materials;           ///< by branch order, the last one goes on; empty: a default
  std::span<const MeshLeaves> leaves = {};       ///< beside every level; formats without a place for them leave them out
};

/// Whether files of that extension (with its dot) hold leaves: .glb and .obj.
bool holds_leaves(std::string_view format);

/// Writes to exactly `path` (the caller writes beside and renames); `format` is the extension with its dot (".obj"), since the
/// path may be a temporary name. glTF is always y-up.
///   .glb  everything: normals split at creases, tangents, a primitive for each bark, custom attributes (_BRANCH ...), levels;
///         leaves are a mesh of their own with a primitive for each material
///   .obj  positions, uv, normals split at creases, smoothing groups; no materials, which would take a second file; leaves are an
///         object of their own that names one
///   .ply  every vertex attribute as a property, uv by corner, creases as an element `edge`
///   .off  positions, normals, colours;  .stl  facets
/// Errors: InputError for an unknown extension, no level, several where the format has one, or a texture that is neither PNG nor
/// JPEG; std::runtime_error naming the path
/// when the disk or the writer fails. Cost: about a second for five million triangles as .glb. Memory: about the file's size.
void write_mesh(const MeshFile& file, const std::filesystem::path& path, const std::string& format, UpAxis up);

/// One mesh without attributes.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const std::string& format, UpAxis up);

}  // namespace cambium
