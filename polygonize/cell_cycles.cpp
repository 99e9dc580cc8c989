#include "polygonize/cell_cycles.h"

#include <vector>

namespace cambium {
namespace {

struct FaceEdges {
  std::array<int, 4> corners;   // in order around the face
  std::array<int, 4> edges;     // edges[i] joins corners[i] and corners[i + 1]
};

int edge_between(int corner_a, int corner_b) {
  for (int e = 0; e < 12; ++e) {
    const int lo = edge_low_corner(e), hi = edge_high_corner(e);
    if ((lo == corner_a && hi == corner_b) || (lo == corner_b && hi == corner_a)) return e;
  }
  return -1;
}

std::array<FaceEdges, 6> make_faces() {
  std::array<FaceEdges, 6> faces{};
  for (int face = 0; face < 6; ++face) {
    const int a = face / 2, u = 1 << ((a + 1) % 3), v = 1 << ((a + 2) % 3);
    const int base = (face & 1) << a;
    faces[face].corners = {base, base | u, base | u | v, base | v};
    for (int i = 0; i < 4; ++i) faces[face].edges[i] = edge_between(faces[face].corners[i], faces[face].corners[(i + 1) % 4]);
  }
  return faces;
}

const std::array<FaceEdges, 6>& faces() {
  static const std::array<FaceEdges, 6> made = make_faces();
  return made;
}

// The pairs of crossed edges that the surface joins on a face: none, one or two.
std::vector<std::array<int, 2>> face_segments(int mask, int face, bool flipped) {
  const FaceEdges& f = faces()[face];
  std::vector<std::array<int, 2>> segments;
  if (face_ambiguous(mask, face)) {
    for (int i = 0; i < 4; ++i) {
      const bool inside = (mask >> f.corners[i]) & 1;
      if (inside != flipped) segments.push_back({f.edges[(i + 3) % 4], f.edges[i]});   // cut this corner off
    }
    return segments;
  }
  std::vector<int> crossed;
  for (int e : f.edges)
    if (edge_crossed(mask, e)) crossed.push_back(e);
  if (crossed.size() == 2) segments.push_back({crossed[0], crossed[1]});
  return segments;
}

CellCycles trace_cycles(int mask, int flipped_face) {
  std::array<std::array<int, 2>, 12> partner{};
  std::array<int, 12> partners{};
  for (int face = 0; face < 6; ++face) {
    for (const auto& [a, b] : face_segments(mask, face, face == flipped_face)) {
      partner[a][partners[a]++] = b;
      partner[b][partners[b]++] = a;
    }
  }
  CellCycles cycles;
  cycles.cycle_of_edge.fill(kNoCycle);
  for (int e = 0; e < 12; ++e) {
    if (!edge_crossed(mask, e) || cycles.cycle_of_edge[e] != kNoCycle) continue;
    const std::uint8_t id = cycles.count++;
    for (int at = e, from = -1; cycles.cycle_of_edge[at] == kNoCycle;) {
      cycles.cycle_of_edge[at] = id;
      const int next = partner[at][0] != from ? partner[at][0] : partner[at][1];
      from = at;
      at = next;
    }
  }
  return cycles;
}

struct Table {
  std::array<std::array<CellCycles, 7>, 256> cycles;
  std::array<std::uint8_t, 256> flippable;

  Table() {
    for (int mask = 0; mask < 256; ++mask) {
      for (int face = 0; face <= kNoFace; ++face) cycles[mask][face] = trace_cycles(mask, face);
      flippable[mask] = kNoFace;
      for (int face = 0; face < 6; ++face) {
        if (!face_ambiguous(mask, face)) continue;
        const auto segments = face_segments(mask, face, false);
        const auto& of_edge = cycles[mask][kNoFace].cycle_of_edge;
        if (of_edge[segments[0][0]] == of_edge[segments[1][0]]) flippable[mask] = static_cast<std::uint8_t>(face);
      }
    }
  }
};

const Table& table() {
  static const Table made;
  return made;
}

}  // namespace

bool face_ambiguous(int mask, int face) {
  const auto& c = faces()[face].corners;
  const int s0 = (mask >> c[0]) & 1, s1 = (mask >> c[1]) & 1, s2 = (mask >> c[2]) & 1, s3 = (mask >> c[3]) & 1;
  return s0 == s2 && s1 == s3 && s0 != s1;
}

const CellCycles& cell_cycles(int mask, int flipped_face) { return table().cycles[mask][flipped_face]; }

int flippable_face(int mask) { return table().flippable[mask]; }

}  // namespace cambium
