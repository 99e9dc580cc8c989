// How a surface crosses one cube cell, known from the signs of its corners alone: the closed cycles of crossed edges, one
// vertex each (manifold dual contouring, Schaefer, Ju & Warren 2007).
#pragma once

#include <array>
#include <cstdint>

namespace cambium {

/// Corner c stands at (c & 1, c >> 1 & 1, c >> 2 & 1). A mask has bit c set where corner c is inside.
/// Edge e = 4 a + b runs along axis a; bit 0 of b is its place on axis a + 1, bit 1 on axis a + 2 (modulo 3).
/// Face 2 a + s is the one across axis a at its low (s = 0) or high (s = 1) end.
inline constexpr int kNoFace = 6;
inline constexpr std::uint8_t kNoCycle = 255;

constexpr int edge_low_corner(int edge) {
  const int a = edge / 4;
  return ((edge & 1) << ((a + 1) % 3)) | ((edge >> 1 & 1) << ((a + 2) % 3));
}
constexpr int edge_high_corner(int edge) { return edge_low_corner(edge) | (1 << (edge / 4)); }
constexpr bool edge_crossed(int mask, int edge) {
  return ((mask >> edge_low_corner(edge)) & 1) != ((mask >> edge_high_corner(edge)) & 1);
}
/// Diagonally opposite signs, so that the corners alone do not say how the surface crosses the face.
bool face_ambiguous(int mask, int face);

struct CellCycles {
  std::uint8_t count = 0;
  std::array<std::uint8_t, 12> cycle_of_edge{};   ///< kNoCycle where the edge is not crossed
};

/// An ambiguous face separates its inside corners, except flipped_face, which separates its outside corners.
/// Cost: a table look-up. Thread safe.
const CellCycles& cell_cycles(int mask, int flipped_face = kNoFace);

/// The one ambiguous face whose two segments lie on the same cycle under the default rule, or kNoFace. If the cell across has
/// the opposite face for its own, four quads would share an edge there unless both cells flip it. There is at most one.
int flippable_face(int mask);

}  // namespace cambium
