// Field to closed 2-manifold mesh within a stated tolerance: adaptive manifold dual contouring (Ju et al. 2002; Schaefer, Ju,
// Warren 2007) with vertices on known creases and polygons that cannot cross each other (Ju & Udeshi 2006).
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace cambium {

struct PolygonizeOptions {
  std::optional<double> tolerance{};        ///< metres, both ways; unset: an eighth of the thinnest radius, or 1/20000 of the whole
  std::optional<double> voxel{};            ///< all cells of this edge, metres, whatever that misses; not with tolerance
  double min_sides = 6;                     ///< around the thinnest twig, at least; 4 to 64
  bool preview = false;                     ///< 16 times the tolerance, at most four sides, and no search for what cells do not show
};

struct PolygonizeReport {
  double tolerance = 0;                     ///< aimed at; 0 with a given voxel
  double smallest_cell = 0, largest_cell = 0;   ///< that hold the surface, metres
  std::size_t cells = 0;                    ///< that hold the surface
  std::size_t rounds = 0;                   ///< of refinement
  std::size_t components = 0;
  std::size_t closed_voids = 0;             ///< cavities thinner than the narrowest gap that is resolved, left out
  std::size_t crumbs = 0;                   ///< of wood in cracks, smaller than the tolerance and the thinnest radius, left out
  std::size_t face_vertices = 0, edge_vertices = 0;   ///< added so that no polygons cross
  std::size_t misfit_tubes = 0;             ///< stretches of branches that were contoured since a tube would not fit the mesh there
  std::size_t relinked_faces = 0;           ///< that join their inside corners so that the mesh is a manifold
  double largest_error = 0;                 ///< of a polygon, metres, where contouring measured it
  /// Where sheets are closer than the smallest cell allowed there, so that the mesh may join what is apart.
  std::vector<Vec3> uncertain;
  /// Where wood thinner than the tolerance is missing, or may be: bounds of the field do not rule it out. One place in a cube of four
  /// tolerances. Not looked for with a given voxel, nor for a preview.
  std::vector<Vec3> unseen;
  /// Where the cavities and crumbs left out were, likewise.
  std::vector<Vec3> left_out;
};

struct Polygonized {
  Mesh mesh;
  PolygonizeReport report;
};

/// nullopt if cancelled. Deterministic at any thread count. Errors: InputError for lengths that are none, both a voxel and a
/// tolerance, or more cells than there is room for. Memory: about 400 bytes a vertex.
std::optional<Polygonized> polygonize(const Field& field, const PolygonizeOptions& options, const RunOptions& run);

}  // namespace cambium
