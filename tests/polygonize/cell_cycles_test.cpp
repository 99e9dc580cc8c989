#include "polygonize/cell_cycles.h"

#include <gtest/gtest.h>

#include <set>

namespace cambium {
namespace {

int ambiguous_faces(int mask) {
  int count = 0;
  for (int face = 0; face < 6; ++face) count += face_ambiguous(mask, face);
  return count;
}

TEST(CellCycles, EveryCrossedEdgeLiesOnOneCycleAndNoOtherEdgeDoes) {
  for (int mask = 0; mask < 256; ++mask) {
    for (int face = 0; face <= kNoFace; ++face) {
      const CellCycles& cycles = cell_cycles(mask, face);
      std::set<int> seen;
      for (int e = 0; e < 12; ++e) {
        EXPECT_EQ(cycles.cycle_of_edge[e] != kNoCycle, edge_crossed(mask, e)) << mask;
        if (edge_crossed(mask, e)) seen.insert(cycles.cycle_of_edge[e]);
      }
      EXPECT_EQ(seen.size(), cycles.count) << mask;
      EXPECT_LE(cycles.count, 4);
    }
  }
}

TEST(CellCycles, ACycleHasAtLeastThreeEdges) {
  for (int mask = 1; mask < 255; ++mask) {
    for (int face = 0; face <= kNoFace; ++face) {
      const CellCycles& cycles = cell_cycles(mask, face);
      std::array<int, 4> length{};
      for (int e = 0; e < 12; ++e)
        if (cycles.cycle_of_edge[e] != kNoCycle) ++length[cycles.cycle_of_edge[e]];
      for (int c = 0; c < cycles.count; ++c) EXPECT_GE(length[c], 3) << mask;
    }
  }
}

TEST(CellCycles, IsolatedInsideCornersAreCutOffSeparately) {
  EXPECT_EQ(cell_cycles(0b00000001).count, 1);
  EXPECT_EQ(cell_cycles(0b00001001).count, 2);   // two inside corners across a face diagonal
  EXPECT_EQ(cell_cycles(0b01101001).count, 4);   // four: no two share an edge
  EXPECT_EQ(cell_cycles(0b10000001).count, 2);   // across the space diagonal
  EXPECT_EQ(cell_cycles(0b00001111).count, 1);
}

// The proof behind the flip rule: a face whose segments share a cycle is the cell's only ambiguous face, so no cell is ever
// asked to flip two faces, and flipping it separates the cycles.
TEST(CellCycles, AFlippableFaceIsTheOnlyAmbiguousOneAndFlippingSeparatesItsSegments) {
  int flippable = 0;
  for (int mask = 0; mask < 256; ++mask) {
    const int face = flippable_face(mask);
    if (face == kNoFace) continue;
    ++flippable;
    EXPECT_EQ(ambiguous_faces(mask), 1) << mask;
    EXPECT_EQ(cell_cycles(mask).count, 1) << mask;
    const CellCycles& flipped = cell_cycles(mask, face);
    EXPECT_EQ(flipped.count, 2) << mask;
    // Of the four edges of the face, two lie on each of the new cycles.
    std::array<int, 2> on{};
    for (int e = 0; e < 12; ++e) {
      const int low = edge_low_corner(e), high = edge_high_corner(e), axis = face / 2, side = face & 1;
      if (((low >> axis) & 1) == side && ((high >> axis) & 1) == side && flipped.cycle_of_edge[e] != kNoCycle) {
        ++on[flipped.cycle_of_edge[e]];
      }
    }
    EXPECT_EQ(on[0], 2) << mask;
    EXPECT_EQ(on[1], 2) << mask;
  }
  EXPECT_GT(flippable, 0);
}

}  // namespace
}  // namespace cambium
