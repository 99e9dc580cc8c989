// The segments of a cover's chains, made ready for rays. Where nothing is taken away from a chain its solid is inside the surface: a
// ray that meets it has met wood, whatever else may stand before it.
#pragma once

#include "blobtree/lone_chain.h"
#include "blobtree/surface_cover.h"
#include "raytrace/swept_hit.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// A segment, with the ball around its axis by which rays that pass it are told: what of it is read first.
struct ChainSegment {
  Vec3 middle{0.0};
  double half_length = 0, thickest = 0;
  SweptSegment<double> swept;
  bool is_wood = false;         ///< every point of its solid is certainly inside the surface
  std::uint32_t cell = kNoCell; ///< of the cover, one in which it is active

  static constexpr std::uint32_t kNoCell = 0xffffffffu;

  explicit ChainSegment(const SweptSegment<double>& segment)
      : middle(segment.a + 0.5 * segment.end * segment.axis), half_length(0.5 * segment.end), thickest(cambium::thickest(segment)), swept(segment) {}
};

/// The part of a ray that counts, from its middle.
struct RayLook {
  Vec3 middle, direction;
  double half = 0;
  /// Whether it surely stays farther than `reach` from the axis.
  bool passes(const ChainSegment& segment, double reach) const {
    const Vec3 v = middle - segment.middle;
    const double along = glm::dot(v, direction), ball = segment.half_length + reach, to_part = std::max(0.0, std::abs(along) - half);
    return glm::dot(v, v) - along * along + to_part * to_part > ball * ball * (1 + 1e-9);
  }
};

class ChainSegments {
 public:
  /// Where the segments of a chain begin, which are made at the first time that it is seen; blended (ActiveChain::blended) in some cell.
  std::uint32_t add(const ActiveChain& chain);
  void note_cell(std::uint32_t k, std::uint32_t cell) { segments_[k].cell = std::min(segments_[k].cell, cell); }
  /// Tells which are wood: those with a cell, where the cover's field is a blend all over or where the segment's solid is. Parallel.
  /// Cost: as a pruned field for each segment, unless the field is a blend all over.
  void find_wood(const SurfaceCover& cover);

  std::size_t size() const { return segments_.size(); }
  const ChainSegment& operator[](std::uint32_t k) const { return segments_[k]; }
  /// The first place inside the solid on the part of the ray, which is the part's begin where that is inside; error as first_inside().
  std::optional<double> meet(std::uint32_t k, const Ray& ray, const RaySegment& part) const;
  /// Outward, at a point of a segment's surface, and the radius there, metres.
  Vec3 normal(std::uint32_t k, const Vec3& p) const { return swept_normal(segments_[k].swept, p); }
  double radius(std::uint32_t k, const Vec3& p) const;

  /// Boxes around pieces of the segments that are wood, none much longer than it is thick.
  struct Piece {
    std::uint32_t segment = 0;
    float begin = 0, end = 1;   ///< shares of its length
  };
  std::vector<Piece> wood_pieces() const;
  Box box(const Piece& piece) const;
  std::size_t memory_bytes() const;

 private:
  std::vector<std::uint32_t> first_;   // by primitive
  std::vector<ChainSegment> segments_;
};

}  // namespace cambium
