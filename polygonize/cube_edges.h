// The corners and edges of a cube by number.
#pragma once

namespace cambium {

/// Corner c stands at (c & 1, c >> 1 & 1, c >> 2 & 1). A mask has bit c set where corner c is inside.
/// Edge e = 4 a + b runs along axis a; bit 0 of b is its place on axis a + 1, bit 1 on axis a + 2 (modulo 3).
constexpr int edge_low_corner(int edge) {
  const int a = edge / 4;
  return ((edge & 1) << ((a + 1) % 3)) | ((edge >> 1 & 1) << ((a + 2) % 3));
}
constexpr int edge_high_corner(int edge) { return edge_low_corner(edge) | (1 << (edge / 4)); }
constexpr bool edge_crossed(int mask, int edge) {
  return ((mask >> edge_low_corner(edge)) & 1) != ((mask >> edge_high_corner(edge)) & 1);
}

}  // namespace cambium
