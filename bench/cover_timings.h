// Times the surface cover of one field with one and two threads, and batches over its cells.
#pragma once

#include <cstddef>
#include <utility>

#include "blobtree/field.h"
#include "blobtree/surface_cover.h"

namespace cambium::bench {

/// Cells about one branch diameter across: halving space gives edges between half of the longest and the longest.
CoverOptions diameter_cells();

/// The least of all measurements so far; each call of a measuring member adds one. A field is a handle, so it is kept.
class CoverTimings {
 public:
  explicit CoverTimings(Field field) : field_(std::move(field)) {}

  /// Makes the cover with one thread or with two. Errors: std::logic_error if it has not as many cells as before.
  void measure_cover(int threads);
  /// Values at 729 points in each of up to 2048 cells spread over the last cover, with one thread and with two.
  void measure_batches();
  /// Lets go of the last cover; figures stay.
  void release() { cover_ = {}; }

  double spent() const { return spent_; }  ///< seconds, by all calls of measure_cover
  std::size_t cells() const { return cells_; }
  std::size_t memory_bytes() const { return memory_bytes_; }
  std::size_t tapes() const { return tapes_; }
  /// Over the cells of measure_batches: primitives active in a cell, and its longest edge over the branch's diameter there.
  double mean_active() const { return mean_active_; }
  double mean_edge() const { return mean_edge_; }
  /// Processor time of one thread.
  double ns_per_cell() const { return cpu_seconds_ / static_cast<double>(cells_) * 1e9; }
  double processor_seconds() const { return cpu_seconds_; }
  /// Wall-clock seconds with one thread, and with two.
  double seconds(int threads) const { return cover_seconds_[threads - 1]; }
  /// Processor seconds of the busier of two threads: what a machine with nothing else to do would take at least.
  double busier_thread_seconds() const { return busier_seconds_; }
  /// Whether threads had to wait for other programs for more than a twentieth of the time: wall clocks then say little.
  bool disturbed() const { return disturbed_[0] || disturbed_[1]; }
  /// Processor time of the busier thread over all points: with two threads two points are under way.
  double batch_ns_per_point(int threads) const { return batch_ns_[threads - 1]; }

 private:
  Field field_;
  SurfaceCover cover_;
  double spent_ = 0;
  std::size_t cells_ = 0, memory_bytes_ = 0, tapes_ = 0;
  double mean_active_ = 0, mean_edge_ = 0;
  double cpu_seconds_ = kInfinity, busier_seconds_ = kInfinity;
  double cover_seconds_[2] = {kInfinity, kInfinity};
  bool disturbed_[2] = {false, false};
  double batch_ns_[2] = {kInfinity, kInfinity};
};

}  // namespace cambium::bench
