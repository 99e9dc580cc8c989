// Measures a mesh against the field it stands for: distances both ways, and whether it is a closed manifold that does not
// cross itself.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// Counted on vertices that have the same number, not the same place. All 0 but the last three for a sound mesh.
struct MeshTopology {
  std::size_t boundary_edges = 0;          ///< of one triangle
  std::size_t nonmanifold_edges = 0;       ///< of three or more, or of two that run it the same way
  std::size_t nonmanifold_vertices = 0;    ///< whose triangles are more than one fan
  std::size_t degenerate_triangles = 0;    ///< two equal corners, or no area
  std::size_t unused_vertices = 0;
  std::size_t components = 0;
  std::int64_t euler = 0;                  ///< used vertices - edges + triangles
  double volume = 0;                       ///< cubic metres, signed

  bool closed_manifold() const {
    return boundary_edges + nonmanifold_edges + nonmanifold_vertices + degenerate_triangles == 0;
  }
};
/// An area is 0 where the corners, as they are, lie exactly on one line. Indices must be those of vertices. nullopt if cancelled.
/// Runs in the current arena. Cost: linear in triangles.
std::optional<MeshTopology> check_topology(const Mesh& mesh, const RunOptions& run);
MeshTopology check_topology(const Mesh& mesh);

/// Pairs of triangles that meet anywhere but in the corner or the edge they share, lower first, ascending: crossing, touching,
/// or folded onto each other. Exact: decided by robust predicates on the positions as they are, which must be finite. A triangle
/// without area counts as the segment it is, and if one corner lies between the others, as meeting what it shares that corner
/// with. nullopt if cancelled. Cost: near linear in triangles, whatever their sizes; about a microsecond each on one core.
std::optional<std::vector<std::array<std::uint32_t, 2>>> self_intersections(const Mesh& mesh, const RunOptions& run);

struct DistanceFigures {
  std::size_t samples = 0;
  double max = 0, p999 = 0, p99 = 0, mean = 0;   ///< metres
  Vec3 max_at{0.0};                              ///< the sample that is farthest off
  double within = 1;                             ///< share of samples no farther than VerifyOptions::tolerance
  double within_twice = 1;                       ///< than twice that
};

struct VerifyOptions {
  double tolerance = 0;                    ///< metres; 0: within and within_twice stay 1
  std::size_t surface_samples = 1'000'000; ///< on the implicit surface, about (surface_samples.h)
  /// On the mesh, about: at random places, even over its area, so that meshes of unlike triangles are judged alike. Unset: every
  /// vertex, edge midpoint and centroid.
  std::optional<std::size_t> mesh_samples{};
  bool self_intersections = true;
};

struct Verification {
  MeshTopology topology;
  std::size_t self_intersections = 0;
  DistanceFigures mesh_to_surface;         ///< from samples of the mesh to {f = kIso}; never less than the truth
                                           ///< (surface_distance.h), infinite if there is no surface
  DistanceFigures surface_to_mesh;         ///< from points of {f = kIso}, even over its area, to the nearest triangle
  /// The same without the samples in_cracks: those beyond the tolerance that lie in a gap narrower than the tolerance, along
  /// their normal. Where branches part, gaps start from width 0, so a part of them is finer than any cell.
  DistanceFigures open_surface_to_mesh;
  std::size_t in_cracks = 0;
};

/// nullopt if cancelled. The same at any thread count. Errors: InputError for a tolerance that is not a length, no samples,
/// coordinates that are not finite, a triangle whose vertex does not exist. Cost: a few microseconds a sample.
std::optional<Verification> verify_mesh(const Mesh& mesh, const Field& field, const VerifyOptions& options, const RunOptions& run);

}  // namespace cambium
