// Contours one block of cells: signs, edge crossings with normals (Hermite data) and a vertex per surface patch.
#pragma once

#include "blobtree/field.h"
#include "polygonize/cell_blocks.h"
#include "polygonize/lattice.h"
#include "polygonize/polygonize.h"

#include <vector>

namespace cambium {

struct PatchVertex {
  Vec3 position{0.0};                       ///< metres, strictly inside its cell
  glm::vec3 normal{0.0f};                   ///< unit, outward
  std::array<std::uint8_t, 4> color{};
  float distance = 0;                       ///< from the surface, metres, at most
};

struct BlockContour {
  CellBlock cells;
  std::size_t owned_crossings = 0;          ///< quads that start in this block
  std::vector<PatchVertex> vertices;        ///< by cell, then by cycle, under the default rule
  std::vector<PatchVertex> flipped;         ///< for each cell that has a flippable face, its two vertices if that is flipped
};

/// Scratch for one thread. The signs of corners come from the field in double wherever a float batch could be mistaken, and a
/// pruned field equals the whole one exactly, so neighbouring blocks never disagree about a corner that they share.
class BlockContourer {
 public:
  explicit BlockContourer(const Lattice& lattice) : lattice_(lattice) {}

  /// Signs only: cells and owned_crossings.
  void find_cells(Evaluator& evaluator, const PrunedField& field, const CellPlace& place, BlockContour& out);
  /// After find_cells on the same block: the vertices.
  void place_vertices(Evaluator& evaluator, const PrunedField& field, const PolygonizeOptions& options, BlockContour& out);

 private:
  static constexpr int kCorners = kBlockCells + 1;
  static constexpr int corner(int x, int y, int z) { return x + kCorners * (y + kCorners * z); }

  struct Crossing {
    std::uint8_t axis = 0;
    glm::vec3 low{0.0f};                    // corner, in voxels from the block's corner
    float t_in = 0, t_out = 1;              // bracket, as the low corner's and the high corner's end
    float f_low = 0, f_high = 0;            // f - kIso at the bracket's ends
    float t = 0;
    glm::vec3 normal{0.0f};                 // zero where the field has no gradient
    glm::vec3 point() const {
      glm::vec3 p = low;
      p[axis] += t;
      return p;
    }
  };
  struct Patch {
    glm::ivec3 cell{0};
    glm::vec3 at{0.0f};                     // in voxels from the cell's centre
    glm::vec3 best{0.0f};
    float best_distance = 0;                // voxels
    glm::vec3 best_normal{0.0f};
    glm::vec3 mean_normal{0.0f};
    float spread = 1;                       // smallest cosine between mean normal and a crossing's
    float tolerance = 0;                    // voxels
    std::array<std::uint16_t, 12> crossings{};
    int crossing_count = 0;
  };

  void collect_crossings();
  void locate_crossings(Evaluator& evaluator, const PrunedField& field);
  void add_patches(const glm::ivec3& cell, int mask, int flipped_face);
  void settle_patches(Evaluator& evaluator, const PrunedField& field);
  void rescue_patch(Evaluator& evaluator, const PrunedField& field, Patch& patch) const;
  PatchVertex finish_patch(Evaluator& evaluator, const PrunedField& field, const PolygonizeOptions& options,
                           const Patch& patch) const;
  Vec3 world(const Patch& patch, const glm::vec3& at) const;
  void resize_batch(std::size_t n);

  const Lattice& lattice_;
  CellPlace place_{};
  Vec3 corner_from_origin_{0.0};            // block corner relative to the pruned field's origin, metres
  std::array<float, kCorners * kCorners * kCorners> values_{};              // f - kIso
  std::array<bool, kCorners * kCorners * kCorners> inside_{};
  std::array<std::array<std::uint16_t, kCorners * kCorners * kCorners>, 3> crossing_at_{};
  std::vector<Crossing> crossings_;
  std::vector<Patch> patches_;
  std::vector<std::uint32_t> active_;
  std::vector<float> x_, y_, z_, f_, gx_, gy_, gz_;
};

}  // namespace cambium
