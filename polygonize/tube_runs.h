// Where a field's surface is nothing but a stretch of one chain, so that a tube of rings can stand for it instead of an octree's
// polygons. Private to polygonize/.
#pragma once

#include "blobtree/lone_chain.h"
#include "blobtree/surface_cover.h"
#include "polygonize/surface_octree.h"
#include "polygonize/tube_rings.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

/// Between the ends of `stretch` no leaves in cells of the chain alone hold surface, and no others are there; the rings begin and end some way inside of it.
struct TubeRun {
  std::uint32_t path = 0;
  Stretch stretch;
  std::vector<TubeRing> rings;
};

/// Immutable but for remove(); the cover outlives it.
class TubeRuns {
 public:
  TubeRuns() = default;
  /// Stretches around which all cells that hold surface are cells of one lone chain, and which pay. Leaves on them are to be no larger
  /// than `leaves` says. nullopt if cancelled. Deterministic. In the current arena. Cost: some tens of nanoseconds a cell.
  static std::optional<TubeRuns> find(const SurfaceCover& cover, const LeafRule& leaves, const TubeRule& rule, const RunOptions& run);

  std::size_t size() const { return runs_.size(); }
  const TubeRun& operator[](std::size_t i) const { return runs_[i]; }
  const ChainPath& path(const TubeRun& run) const { return paths_[run.path]; }
  /// Runs listed, ascending, are none any more; the others are renumbered.
  void remove(const std::vector<std::uint32_t>& listed);

  enum class Share { kNone, kPart, kAll };
  /// The runs in one cell of the cover. A view.
  class InCell {
   public:
    bool none() const { return runs_.empty(); }
    /// Whether the surface about p belongs to a run: the leaf in whose middle it is, is nothing then. A question of geometry only, so
    /// that it does not matter what the leaf was cut from.
    bool holds(const Vec3& p) const;
    /// How much of the surface in a box inside the cell belongs to runs; kAll also where there is none.
    Share share(const Box& box) const;
    /// Of the chain, where its axis is nearest.
    double place(const Vec3& p) const { return path_->nearest(p, first_, last_); }

   private:
    friend class TubeRuns;
    const ChainPath* path_ = nullptr;
    std::size_t first_ = 0, last_ = 0;         // segments active in the cell
    std::span<const TubeRun> runs_;            // that reach into it, in order
  };
  InCell in(const PrunedField& cell) const;

  struct End {
    std::uint32_t run = 0;
    int end = 0;                               ///< 0: where it begins
  };
  /// Of the runs of a cell's chains, the end that is nearest to p, along its chain and off its surface; p lies in the cell.
  std::optional<End> nearest_end(const PrunedField& cell, const Vec3& p) const;

 private:
  friend class TubeSearch;
  std::optional<std::uint32_t> path_of(const ActiveChain& chain) const;
  std::span<const TubeRun> of_path(std::uint32_t path) const;
  std::vector<std::uint32_t> primitives_;      // ascending, of paths
  std::vector<ChainPath> paths_;
  std::vector<std::uint32_t> first_run_;       // by path, and one more
  std::vector<TubeRun> runs_;                  // by path, along it
};

}  // namespace cambium
