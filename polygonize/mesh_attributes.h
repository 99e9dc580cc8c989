// What a mesh carries besides its shape: texture coordinates, the branch that each vertex belongs to, data for wind and shading.
// All of it is read off the field, so any mesh of its surface will do: every level of detail gets its own.
#pragma once

#include "blobtree/branch_info.h"
#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/ambient_occlusion.h"
#include "polygonize/mesh.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

struct VertexSite {
  Vec3 position, normal;
  double spacing = 0;                          ///< metres to the vertices around it (vertex_spacing()): colours show nothing finer
};

/// sRGB and alpha of a vertex, from what contributes there (Evaluator::contributions) and how it came about. Called from many threads.
using SurfaceColor = std::function<std::array<std::uint8_t, 4>(std::span<const Contribution>, const SurfaceTraits&, const VertexSite&)>;

struct MeshAttributeOptions {
  /// By branch id; a branch beyond it (a field without a table) has BranchInfo's defaults.
  std::vector<BranchInfo> branches;
  /// Metres of bark per repeat of the texture, around and along. Unset: the longest that goes round the branches a whole
  /// number of times without stretching more than a little of them. Levels of detail should all be given the first one's
  /// (MeshAttributes::tile): their textures then lie alike.
  std::optional<double> tile;
  double aspect = 1;                           ///< width over height of the texture
  Vec3 hidden_side{-0.29, -0.20, -0.94};       ///< seams go where the surface faces this way: below, and behind for the trunk
  SurfaceColor color;                          ///< unset: no colours
  std::optional<OcclusionOptions> occlusion;   ///< unset: none
};

/// Empty vectors where there is nothing to tell.
struct MeshAttributes {
  // One per vertex. Ids are those of the primitive whose own surface is nearest; lengths change over from one to the next within the
  // thinner one's radius, so that a twig has its own from where it leaves the trunk.
  std::vector<std::uint32_t> branch;
  std::vector<std::uint32_t> order;
  std::vector<float> radius;                   ///< metres, of the wood where the vertex lies
  std::vector<float> arc_length;               ///< metres along the axes from the root
  std::vector<float> ridge;                    ///< [0, 1], SurfaceTraits::ridge
  std::vector<float> occlusion;                ///< [0, 1], 1 in the open
  std::vector<std::array<std::uint8_t, 4>> colors;   ///< sRGB

  /// Texture coordinates in repeats, u around and v along (upwards), and for each corner of each triangle which of them it has:
  /// as OBJ's vt. An entry belongs to one vertex. u runs a whole number of repeats around each branch, so that a repeating
  /// texture meets itself; no triangle spans the seam. Where the surface faces along a branch (cuts, tips) they are plane.
  std::vector<glm::vec2> uvs;
  std::vector<std::array<std::uint32_t, 3>> uv_triangles;
  std::vector<glm::vec2> unrolled;             ///< beside uvs: turns around the branch and metres along it
  std::vector<std::uint16_t> triangle_order;   ///< branch order whose coordinates the triangle has: picks its bark

  std::vector<BranchInfo> branches;            ///< as in the options
  double tile = 0;                             ///< metres of v per repeat

  const BranchInfo& branch_info(std::uint32_t id) const {
    static const BranchInfo none;
    return id < branches.size() ? branches[id] : none;
  }
};

/// Vertices should lie on the surface (within a cell of it); the mesh needs normals. nullopt if cancelled. The same at any
/// thread count. Errors: std::invalid_argument for a mesh without normals, InputError for a tile or an aspect that is not above
/// 0, and those of ambient_occlusion. Cost: about a microsecond a vertex without colours and occlusion.
std::optional<MeshAttributes> mesh_attributes(const Field& field, const Mesh& mesh, const MeshAttributeOptions& options,
                                              const RunOptions& run);

}  // namespace cambium
