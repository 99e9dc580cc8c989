// Triangles between two closed lines around a tube, on its unrolled surface. Private to polygonize/.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace cambium {

using ChordExcess = std::function<double(const glm::dvec2&, const glm::dvec2&)>;

struct AnnulusTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;   ///< corners count the lower line's, the upper one's, then what was added
  std::vector<glm::dvec2> added;
};

/// Unrolled coordinates, metres around and along. Each line goes once around, in the direction of growing x, by `girth` to its own first
/// point; `upper` lies above `lower`. Triangles wind counter-clockwise and use every side of both lines once. Chords of which `excess`
/// is above 1 are halved, the one with most first, by points that are added between the lines, unless a side of a line beside them has more. nullopt where the lower line crosses itself, or is not below
/// all of the upper one. Delaunay, but for one chord. Cost: the square of the points.
std::optional<AnnulusTriangles> triangulate_annulus(const std::vector<glm::dvec2>& lower, const std::vector<glm::dvec2>& upper,
                                                    double girth, const ChordExcess& excess);

}  // namespace cambium
