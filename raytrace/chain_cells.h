// The cells of a cover in which nothing but chains is active, made ready for rays. Chains' solids bound the surface there: the field
// is at least each of them, at most their sum. So what is not yet known once the wood is met (chain_segments.h) is where several
// chains blend, and chains that are no wood all over.
#pragma once

#include "raytrace/chain_segments.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// What the chains of a cell tell of a ray.
struct ChainVerdict {
  enum class How {
    kMiss,     ///< no surface on that part of the ray but, perhaps, wood
    kHit,      ///< at t, on a segment
    kSearch,   ///< the first place inside, if any, is in `part`, or at t, or it is wood
  };
  How how = How::kMiss;
  double t = kInfinity;        ///< a place that is inside, if one is known
  std::uint32_t segment = 0;   ///< of ChainSegments
  RaySegment part;
};

/// Immutable. Independent of the cover once made.
class ChainCells {
 public:
  ChainCells() = default;
  /// Cost: proportional to the cells; parallel.
  explicit ChainCells(const SurfaceCover& cover);

  const ChainSegments& segments() const { return segments_; }
  /// Those in which there may be surface that is not of wood alone. Ascending by cell.
  std::size_t size() const { return cells_.size(); }
  std::uint32_t cell(std::size_t k) const { return cells_[k].cell; }   ///< its number in the cover
  const Box& box(std::size_t k) const { return cells_[k].box; }        ///< of that surface, in the cell
  /// Of the part of a ray in box(k): its first place inside, which is the part's begin where that is; or any place inside.
  /// Error of a hit: as first_inside(). Cost: proportional to the segments active in the cell.
  ChainVerdict judge(std::size_t k, const Ray& ray, const RaySegment& part, PlaceWanted wanted) const;

  const std::vector<std::uint32_t>& others() const { return others_; }   ///< cells where anything else is active, ascending
  std::size_t memory_bytes() const;

 private:
  struct Cell {
    Box box;
    std::uint32_t cell = 0;
    std::uint32_t chains = 0;                 ///< active in the cell
    std::uint32_t first = 0, count = 0;       ///< of their segments in entries_, chain after chain
    bool all_wood = false;                    ///< all of these
  };
  /// A segment in a cell.
  struct Entry {
    std::uint32_t segment = 0;
    bool starts_chain = false;                ///< the first of its chain in the cell
    bool reaches = true;                      ///< near enough to the cell that it can have part in its surface
  };
  std::span<const Entry> entries_of(const Cell& cell) const { return std::span(entries_).subspan(cell.first, cell.count); }
  void add_cells(const SurfaceCover& cover);
  void narrow(Cell& cell);
  void keep_active(Cell& cell);
  ChainVerdict meet_lone(std::span<const Entry> entries, const Ray& ray, const RaySegment& part) const;
  ChainSegments segments_;
  std::vector<Cell> cells_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> others_;
};

}  // namespace cambium
