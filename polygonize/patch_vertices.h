// A vertex for each patch: on the surface inside its leaf, and on the crease or in the corner where sheets meet there.
#pragma once

#include "polygonize/hermite.h"
#include "polygonize/surface_patches.h"

#include <array>
#include <optional>
#include <vector>

namespace cambium {

inline constexpr double kVertexMargin = 0.02;   ///< vertices keep this far inside their leaves, in edges, so that no two can meet

struct PatchVertex {
  Vec3 position{0.0};          ///< strictly inside its leaf
  glm::vec3 normal{0.0f};      ///< unit, outward; the mean of the sides' on a crease
  bool crease = false;
};

/// A crease leaves a patch's leaf through the face that two neighbouring edges of the patch bound.
struct CreaseExit {
  std::uint32_t patch = 0, edge = 0, next_edge = 0;
  auto operator<=>(const CreaseExit&) const = default;
};

struct PatchVertices {
  std::vector<PatchVertex> vertices;        ///< by patch
  std::vector<CreaseExit> exits;            ///< ascending
};

/// Edges, patches and vertices of one round, so that the next can take over what did not change.
struct Contour {
  std::vector<MinimalEdge> edges;
  SurfacePatches patches;
  std::vector<Crossing> crossings;
  PatchVertices placed;
};

/// Places the vertices of now.patches. earlier: of now's edges in `before` (earlier_edges). nullopt if cancelled. Cost: two samples
/// a new patch, and a few dozen point evaluations where sheets meet.
std::optional<PatchVertices> place_vertices(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& now,
                                            const std::vector<std::uint32_t>& earlier, const Contour& before, const RunOptions& run);

/// Pairs of patches that a crease runs between, lower first, ascending.
std::vector<std::array<std::uint32_t, 2>> crease_edges(const Contour& contour);

}  // namespace cambium
