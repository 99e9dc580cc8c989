// What cell size a field asks for, judged from its primitives alone.
#pragma once

#include "blobtree/field.h"
#include "polygonize/polygonize.h"

namespace cambium {

/// What a mesh without any limit given may grow to.
inline constexpr std::size_t kDefaultMaxTriangles = 6'000'000;  ///< wanted, where that keeps every twig whole
inline constexpr std::size_t kMostTriangles = 150'000'000;      ///< allowed, to keep every twig whole (some 10 GB)

struct AtomSummary {
  double thinnest_radius = kInfinity;   ///< metres
  double area = 0;                      ///< square metres, roughly: every primitive as a tube, overlaps counted twice
};

/// Cost: linear in primitives.
AtomSummary summarise_atoms(const Field& field);

/// Triangles that a surface of this area gives: two per crossed edge, and a surface of average direction crosses 1.5 edges per
/// cell face of area.
double expected_triangles(double area, double voxel);
double voxel_for_triangles(double area, double triangles);

/// options.voxel, else twice options.tolerance, else 0.7 of the thinnest radius; coarser for kDefaultMaxTriangles, but beyond what
/// keeps the thinnest twig whole only for kMostTriangles.
/// Errors: InputError for a voxel or tolerance that is not a length.
double choose_voxel(const Field& field, const AtomSummary& atoms, const PolygonizeOptions& options);

/// Fills in thin_primitives, thin_length and thinnest_radius for report.voxel.
void report_thin_primitives(const Field& field, PolygonizeReport& report);

}  // namespace cambium
