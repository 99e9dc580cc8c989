// Where the surface is sheets that hardly turn: there polygons need no vertices between them to keep from crossing. Private to
// polygonize/.
#pragma once

#include "polygonize/contour.h"
#include "polygonize/polygon_split.h"

#include <array>
#include <optional>
#include <vector>

namespace cambium {

/// Patches and polygons seen from straight above the surface: where all triangles around face up they tile what is below, and do not cross.
class CalmSheet {
 public:
  /// Of a compacted contour. positions: of its patches' vertices; splits: by edge, how its polygon is to be cut where that was measured;
  /// crowded: by patch. All outlive it. In the current arena. Cost: linear, some tenths of a microsecond an edge.
  CalmSheet(const SurfaceOctree& tree, const Contour& contour, const std::vector<Vec3>& positions,
            const std::vector<std::optional<Split>>& splits, const std::vector<bool>& crowded);

  /// How to cut an edge's polygon into triangles that face up, where those around it do as well, away from creases, open ends and sheets
  /// that no plane parts from this one.
  std::optional<Split> split(std::uint32_t edge) const;
  /// Whether the chord between two patches stays in the leaves around two edges.
  bool keeps_among(const std::array<std::uint32_t, 2>& edges, const std::array<std::uint32_t, 2>& patches) const;
  /// Whether a triangle's normal is within 60 degrees of the one at a patch.
  bool faces_up(std::uint32_t patch, const std::array<Vec3, 3>& corners) const;

 private:
  std::vector<Vec3> points_around(std::uint32_t patch) const;
  bool is_apart(std::uint32_t patch) const;
  bool is_apart_from(std::uint32_t patch, std::uint32_t other) const;
  bool is_even(std::uint32_t patch) const;
  std::optional<Split> upward_split(std::uint32_t edge) const;

  const SurfaceOctree& tree_;
  const Contour& contour_;
  const std::vector<Vec3>& positions_;
  const std::vector<std::optional<Split>>& splits_;
  const std::vector<bool>& crowded_;
  std::vector<std::optional<Split>> upward_;   // by edge: a split after which its triangles face up
  std::vector<std::uint8_t> apart_;            // by patch: a plane parts its polygons from those of any other in its leaf
  std::vector<std::uint8_t> calm_;             // by patch: all polygons around it face up
};

}  // namespace cambium
