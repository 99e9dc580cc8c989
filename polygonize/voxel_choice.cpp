#include "polygonize/voxel_choice.h"

#include "polygonize/lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kVoxelsPerThinnest = 0.7;      // a twig is then nearly three cells thick
constexpr double kMostVoxelsPerThinnest = 1.1;  // the coarsest that still keeps it whole (1 / kThinInVoxels is 1.15)
constexpr double kThinInVoxels = 0.87;          // half a cell's diagonal: a thinner twig may pass between all corners
constexpr double kTrianglesPerCellArea = 3;

}  // namespace

AtomSummary summarise_atoms(const Field& field) {
  AtomSummary summary;
  for (std::size_t i = 0; i < field.atom_count(); ++i) {
    const auto atom = static_cast<std::uint32_t>(i);
    const double radius = field.atom_radius(atom);
    const Box& box = field.atom_bounds(atom);
    if (!std::isfinite(radius) || !box.bounded()) continue;
    summary.thinnest_radius = std::min(summary.thinnest_radius, radius);
    const Vec3 core = glm::max(box.size() - 2 * kSupportPerRadius * radius, Vec3(0.0));
    const double length = std::max(glm::length(core), 0.3 * radius);
    summary.area += 2 * std::numbers::pi * radius * length;
  }
  return summary;
}

double expected_triangles(double area, double voxel) { return kTrianglesPerCellArea * area / (voxel * voxel); }

double voxel_for_triangles(double area, double triangles) { return std::sqrt(kTrianglesPerCellArea * area / triangles); }

double choose_voxel(const Field& field, const AtomSummary& atoms, const PolygonizeOptions& options) {
  if (options.voxel) {
    require_length(*options.voxel, "voxel");
    return *options.voxel;
  }
  if (options.tolerance) {
    require_length(*options.tolerance, "tolerance");
    return 2 * *options.tolerance;
  }
  const double across = glm::length(field.bounds().size());
  if (!std::isfinite(atoms.thinnest_radius)) return across / 200;
  const double resolving = kVoxelsPerThinnest * atoms.thinnest_radius;
  const double wanted = std::max(resolving, voxel_for_triangles(atoms.area, static_cast<double>(kDefaultMaxTriangles)));
  const double coarsest = kMostVoxelsPerThinnest * atoms.thinnest_radius;
  return wanted <= coarsest ? wanted : std::max(coarsest, voxel_for_triangles(atoms.area, static_cast<double>(kMostTriangles)));
}

void report_thin_primitives(const Field& field, PolygonizeReport& report) {
  report.thinnest_radius = kInfinity;
  for (std::size_t i = 0; i < field.atom_count(); ++i) {
    const auto atom = static_cast<std::uint32_t>(i);
    const double radius = field.atom_radius(atom);
    report.thinnest_radius = std::min(report.thinnest_radius, radius);
    if (radius >= kThinInVoxels * report.voxel) continue;
    ++report.thin_primitives;
    report.thin_length += glm::length(field.atom_bounds(atom).size());
  }
}

}  // namespace cambium
