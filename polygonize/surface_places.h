// Where the vertices of a mesh lie on the primitives that make the surface there, and what they blend to.
#pragma once

#include "polygonize/mesh_attributes.h"

#include <span>

namespace cambium {

/// A vertex in the coordinates of one primitive (Contribution).
struct SurfacePlace {
  std::uint32_t primitive = 0, branch = 0;
  float weight = 0;          ///< share of the vertex, (0, 1]; of all its places it adds up to 1
  float turns = 0;           ///< [0, 1)
  float v = 0;               ///< metres
  float radius = 0;          ///< metres
  float from_axis = 0;       ///< metres
  std::uint32_t order = 0;
};

/// The places of every vertex, in an order that the threads do not change.
struct SurfacePlaces {
  std::vector<SurfacePlace> places;
  std::vector<std::uint32_t> first;        ///< by vertex
  std::vector<std::uint8_t> count;         ///< by vertex; 0 where the field is nothing
  std::span<const SurfacePlace> operator[](std::uint32_t vertex) const { return {places.data() + first[vertex], count[vertex]}; }
  /// Of the branch that weighs most, its heaviest; null if the vertex has none.
  const SurfacePlace* heaviest(std::uint32_t vertex) const { return count[vertex] ? &places[first[vertex]] : nullptr; }
};

/// Finds the places and fills in what `out` has per vertex, but for occlusion. Runs in the current arena.
/// nullopt if cancelled. Cost: about a microsecond a vertex without colours.
std::optional<SurfacePlaces> surface_places(const Field& field, const Mesh& mesh, const SurfaceColor& color, MeshAttributes& out,
                                            const RunOptions& run);

}  // namespace cambium
