#include "polygonize/cell_blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace cambium {
namespace {

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

struct CellReference {
  std::size_t block = kAbsent;
  int cell = -1;
};

bool owns_crossing(int mask, int axis) { return edge_crossed(mask, 4 * axis); }

}  // namespace

// A block and the 26 around it, looked up when first asked for.
class CellConnectivity::Neighbourhood {
 public:
  Neighbourhood(const CellConnectivity& owner, std::size_t block) : owner_(owner) {
    found_.fill(kUnknown);
    found_[13] = block;
    place_ = owner.cells_[block]->place;
  }

  // Cell at local coordinates from -1 to 8 of the central block. Errors: std::logic_error if absent.
  CellReference at(int x, int y, int z) {
    const int bx = x < 0 ? 0 : x > 7 ? 2 : 1, by = y < 0 ? 0 : y > 7 ? 2 : 1, bz = z < 0 ? 0 : z > 7 ? 2 : 1;
    std::size_t& block = found_[bx + 3 * by + 9 * bz];
    if (block == kUnknown) block = look_up(bx - 1, by - 1, bz - 1);
    CellReference reference{block, -1};
    if (block != kAbsent) reference.cell = owner_.cells_[block]->find(x & 7, y & 7, z & 7);
    if (reference.cell < 0) throw std::logic_error("polygonize: a crossed edge lacks one of its four cells");
    return reference;
  }

 private:
  static constexpr std::size_t kUnknown = kAbsent - 1;

  std::size_t look_up(int dx, int dy, int dz) const {
    const std::array<int, 3> step{dx, dy, dz};
    CellPlace place = place_;
    for (int a = 0; a < 3; ++a) {
      if (step[a] < 0 && place[a] == 0) return kAbsent;
      place[a] += static_cast<std::uint32_t>(step[a]);
    }
    const std::uint64_t key = morton_key(place);
    const auto it = std::lower_bound(owner_.keys_.begin(), owner_.keys_.end(), key);
    if (it == owner_.keys_.end() || *it != key) return kAbsent;
    return static_cast<std::size_t>(it - owner_.keys_.begin());
  }

  const CellConnectivity& owner_;
  CellPlace place_{};
  std::array<std::size_t, 27> found_;
};

CellConnectivity::CellConnectivity(const std::vector<const CellBlock*>& blocks) : cells_(blocks) {
  keys_.reserve(blocks.size());
  for (const CellBlock* block : blocks) keys_.push_back(morton_key(block->place));
  blocks_.resize(blocks.size());

  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    const CellBlock& block = *cells_[b];
    Numbering& numbering = blocks_[b];
    numbering.flipped_face.assign(block.masks.size(), kNoFace);
    numbering.first_vertex.resize(block.masks.size());
    Neighbourhood around(*this, b);
    block.for_each([&](int index, int x, int y, int z) {
      const int face = flippable_face(block.masks[index]);
      if (face == kNoFace) return;
      const int step = (face & 1) ? 1 : -1, axis = face / 2;
      const CellReference across = around.at(x + (axis == 0) * step, y + (axis == 1) * step, z + (axis == 2) * step);
      if (flippable_face(cells_[across.block]->masks[across.cell]) == (face ^ 1)) {
        numbering.flipped_face[index] = static_cast<std::uint8_t>(face);
      }
    });
  });

  std::uint64_t vertices = 0;
  std::size_t flips = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t i = 0; i < blocks[b]->masks.size(); ++i) {
      const int flipped = blocks_[b].flipped_face[i];
      blocks_[b].first_vertex[i] = static_cast<std::uint32_t>(vertices);
      vertices += cell_cycles(blocks[b]->masks[i], flipped).count;
      flips += flipped != kNoFace;
    }
    cell_count_ += blocks[b]->masks.size();
  }
  if (vertices > std::numeric_limits<std::uint32_t>::max()) throw std::length_error("polygonize: more than 2^32 vertices");
  vertex_count_ = static_cast<std::uint32_t>(vertices);
  flipped_faces_ = flips / 2;   // each was counted from both sides
}

std::size_t CellConnectivity::quad_count(std::size_t block) const {
  std::size_t count = 0;
  for (const std::uint8_t mask : cells_[block]->masks)
    for (int axis = 0; axis < 3; ++axis) count += owns_crossing(mask, axis);
  return count;
}

void CellConnectivity::quads(std::size_t block_index, std::vector<Quad>& out) const {
  // The cells around an edge, counter-clockwise about its axis, as steps down on the two other axes.
  constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  out.clear();
  const CellBlock& block = *cells_[block_index];
  Neighbourhood around(*this, block_index);
  block.for_each([&](int index, int x, int y, int z) {
    const int mask = block.masks[index];
    for (int axis = 0; axis < 3; ++axis) {
      if (!owns_crossing(mask, axis)) continue;
      Quad quad;
      for (int i = 0; i < 4; ++i) {
        std::array<int, 3> at{x, y, z};
        at[(axis + 1) % 3] -= kAround[i][0];
        at[(axis + 2) % 3] -= kAround[i][1];
        const CellReference cell = around.at(at[0], at[1], at[2]);
        const Numbering& numbering = blocks_[cell.block];
        const CellCycles& cycles = cell_cycles(cells_[cell.block]->masks[cell.cell], numbering.flipped_face[cell.cell]);
        const int edge = 4 * axis + kAround[i][0] + 2 * kAround[i][1];
        quad[i] = numbering.first_vertex[cell.cell] + cycles.cycle_of_edge[edge];
      }
      if (!(mask & 1)) std::swap(quad[1], quad[3]);   // the low end is outside: it faces down the axis
      out.push_back(quad);
    }
  });
}

}  // namespace cambium
