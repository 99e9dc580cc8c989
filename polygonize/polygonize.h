// Field to closed 2-manifold mesh: manifold dual contouring (Ju et al. 2002; Schaefer, Ju, Warren 2007) on uniform cells.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <array>
#include <functional>
#include <optional>

namespace cambium {

struct PolygonizeOptions {
  std::optional<double> voxel;              ///< cell edge in metres; unset: chosen from the thinnest twig
  std::optional<double> tolerance;          ///< metres; a vertex is within half a cell, so cells are twice this
  std::optional<std::size_t> max_triangles; ///< coarsens until it holds
  /// Colour of a surface point (sRGB); unset: no vertex colours. Called from many threads.
  std::function<std::array<std::uint8_t, 4>(Evaluator&, const PrunedField&, const Vec3& p, const Vec3& normal)> color;
};

struct PolygonizeReport {
  double voxel = 0;
  std::size_t cells = 0;                    ///< that hold the surface
  std::size_t components = 0;
  std::size_t closed_voids = 0;             ///< cavities of less than a cell's volume, left out
  std::size_t thin_primitives = 0;          ///< primitives thinner than a cell: their twigs may be broken or missing
  double thin_length = 0;                   ///< metres of them (by support box diagonal)
  double thinnest_radius = 0;
  std::size_t ambiguous_faces = 0;          ///< resolved to keep the mesh manifold
  double largest_distance = 0;              ///< of a vertex from the surface, metres, by |f - c|/|grad f|
};

struct Polygonized {
  Mesh mesh;
  PolygonizeReport report;
};

/// nullopt if cancelled. Deterministic at any thread count. Errors: InputError for voxel/tolerance <= 0 or a grid that is too
/// fine to index. Memory: proportional to the surface.
std::optional<Polygonized> polygonize(const Field& field, const PolygonizeOptions& options, const RunOptions& run);

}  // namespace cambium
