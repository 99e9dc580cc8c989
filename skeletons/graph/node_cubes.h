// The nodes of a volume by the cubes of space that they are in, filled cube by cube with as many as fit.
#pragma once

#include "blobtree/run_options.h"
#include "skeletons/graph/dart_block.h"
#include "skeletons/graph/volume_probe.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace cambium {

/// Places for nodes, handed out a few at a time and freed together. Used by threads at once.
class NodePool {
 public:
  std::span<Vec3> take(std::size_t count);

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Vec3[]>> pieces_;
  Vec3* piece_end_ = nullptr;          // of the last piece
  std::size_t piece_size_ = 256, left_ = 0;
};

/// Keeps references to all that it is made with but `there`. Memory: that of the nodes, and 4 bytes for each cube of the bounds.
class NodeCubes {
 public:
  /// `there`: nodes to keep clear of. Cancelled, it fills nothing any more. Errors: InputError (no location) where the bounds are too
  /// many cubes.
  NodeCubes(const GraphVolume& volume, const VolumeProbe& probe, const DartLattice& lattice, std::span<const Vec3> there, const RunOptions& run);

  /// Adds what fits in. The same at any thread count. False if cancelled.
  bool fill(std::uint64_t seed, int halvings);
  /// Those that were not there before, neighbours near each other.
  std::vector<Vec3> added() const;

 private:
  using Cube = std::array<int, 3>;
  static constexpr std::uint32_t kNone = 0xffffffff;

  struct Filled {
    Cube at;
    bool is_open;                      // may hold some of the volume
    std::span<const Vec3> there{}, added{};
    GroupBits groups = 0;              // that hold some of the volume, as far as is known
    int hits = 0;                      // of one look at each of them
  };

  void find_cubes();
  void put_in(std::span<const Vec3> there);
  bool find_groups();
  std::vector<std::uint32_t> of_phase(std::size_t phase) const;
  std::array<const Filled*, 27> around(const Cube& cube) const;
  DartTargets targets(const std::array<const Filled*, 27>& cubes) const;
  void fill(Filled& cube, DartBlock& block, std::vector<Vec3>& found, std::uint64_t seed);

  std::size_t index(const Cube& c) const {
    return (std::size_t(c[2]) * std::size_t(size_[1]) + std::size_t(c[1])) * std::size_t(size_[0]) + std::size_t(c[0]);
  }
  Cube cube_of(const Vec3& p) const;
  std::uint32_t number_of(const Cube& cube);
  std::size_t grain() const;

  const GraphVolume& volume_;
  const VolumeProbe& probe_;
  const DartLattice& lattice_;
  const RunOptions& run_;
  Cube size_{1, 1, 1};
  std::vector<std::uint32_t> number_;  // of each cube of the bounds, in cubes_
  std::vector<Filled> cubes_;          // those that may hold some of the volume, in Morton's order; then others that have nodes
  NodePool pool_;
};

}  // namespace cambium
