// The cells of a cover in which nothing but chains is active, made ready for rays. Where a ray meets one chain alone, its hit is
// in closed form; where several blend, the chains' solids bound the root: the field is at least each of them, at most their sum.
#pragma once

#include "blobtree/surface_cover.h"
#include "raytrace/swept_hit.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

/// What the chains of a cell tell of a ray.
struct ChainVerdict {
  enum class How {
    kMiss,     ///< no surface on that part of the ray
    kHit,      ///< at t, on a segment
    kSearch,   ///< the first place inside, if any, is in `part`, or at t
  };
  How how = How::kMiss;
  double t = kInfinity;        ///< a place that is inside, if one is known
  std::uint32_t segment = 0;   ///< for normal() and radius()
  RaySegment part;
};

/// Immutable. Independent of the cover once made.
class ChainCells {
 public:
  ChainCells() = default;
  /// Cost: proportional to the cells; parallel.
  explicit ChainCells(const SurfaceCover& cover);

  /// Those in which there may be surface. Ascending by cell.
  std::size_t size() const { return cells_.size(); }
  std::uint32_t cell(std::size_t k) const { return cells_[k].cell; }   ///< its number in the cover
  Box surface_bounds(std::size_t k) const;                             ///< of what surface there may be in the k-th
  const Box& box(std::size_t k) const { return cells_[k].box; }
  /// Of the part of a ray in the k-th cell: its first place inside, which is the part's begin where that is; or any place inside.
  /// Error of a hit: as first_inside(). Cost: proportional to the segments active in the cell.
  ChainVerdict judge(std::size_t k, const Ray& ray, const RaySegment& part, PlaceWanted wanted) const;

  /// Outward, at a point of a segment's surface, and the radius there, metres.
  Vec3 normal(std::uint32_t segment, const Vec3& p) const { return swept_normal(pieces_[segment].segment, p); }
  double radius(std::uint32_t segment, const Vec3& p) const;

  const std::vector<std::uint32_t>& others() const { return others_; }   ///< cells where anything else is active, ascending
  std::size_t memory_bytes() const;

 private:
  struct Cell {
    Box box;
    std::uint32_t cell = 0;
    std::uint32_t chains = 0;                 ///< active in the cell
    std::uint32_t first = 0, count = 0;       ///< of their segments in entries_, chain after chain
  };
  /// A segment in a cell.
  struct Entry {
    std::uint32_t segment = 0;
    bool starts_chain = false;                ///< the first of its chain in the cell
    bool reaches = true;                      ///< near enough to the cell that it can have part in its surface
  };
  /// A segment, with the ball around its axis by which rays that pass it are told: what of it is read first.
  struct Piece {
    Vec3 middle{0.0};
    double half_length = 0, thickest = 0;
    SweptSegment<double> segment;
  };
  /// The part of a ray in a cell, from its middle.
  struct Look {
    Vec3 middle, direction;
    double half = 0;
    /// Whether it surely stays farther than `reach` from the axis.
    bool passes(const Piece& piece, double reach) const;
  };
  std::span<const Entry> entries_of(const Cell& cell) const { return std::span(entries_).subspan(cell.first, cell.count); }
  ChainVerdict meet_lone(std::span<const Entry> entries, const Ray& ray, const RaySegment& part) const;
  /// The part of it, and a little more, where the cell's chains can reach kIso together; none where begin > end.
  RaySegment near_surface(const Cell& cell, const Ray& ray, const RaySegment& part) const;
  std::vector<Cell> cells_;
  std::vector<Entry> entries_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> others_;
};

}  // namespace cambium
