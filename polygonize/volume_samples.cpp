#include "polygonize/volume_samples.h"

#include "blobtree/cell_search.h"
#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "polygonize/block_contour.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

namespace cambium {
namespace {

Lattice make_indexed_lattice(const Field& field, double voxel) {
  const Lattice lattice = make_lattice(field.bounds(), voxel);
  for (int a = 0; a < 3; ++a) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max() - (std::int64_t{2} << kCoordinateBits);
    if (std::abs(lattice.first(a)) > kMost)
      throw InputError({}, "a model too far from the origin for this voxel", "32-bit voxel indices");
  }
  return lattice;
}

std::array<std::int32_t, 3> first_voxel(const Lattice& lattice, const CellPlace& place) {
  std::array<std::int32_t, 3> first{};
  for (int a = 0; a < 3; ++a) {
    first[a] = static_cast<std::int32_t>(lattice.first(a) + std::int64_t{place[a]} * kBlockCells);
  }
  return first;
}

// Runs a search whose visitor makes one Result per block, and returns them in Morton order.
template <class Result, class Make>
std::optional<std::vector<std::pair<std::uint64_t, Result>>> gather(const Field& field, const Lattice& lattice, Wanted wanted,
                                                                    const Make& make, const RunOptions& run) {
  std::vector<std::pair<std::uint64_t, Result>> results;
  std::mutex mutex;
  ProgressMeter progress(run, "sampling voxels");
  bool complete = false;
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    const auto visit = [&](Evaluator& evaluator, const PrunedField& pruned, const CellPlace& place) {
      Result result = make(evaluator, pruned, place);
      const std::lock_guard lock(mutex);
      results.emplace_back(morton_key(place), std::move(result));
    };
    complete = visit_cells(field, lattice.blocks, wanted, visit, run, progress);
    tbb::parallel_sort(results.begin(), results.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  });
  if (!complete) return std::nullopt;
  return results;
}

float distance_from(const Sample& sample, double voxel) {
  const double slope = glm::length(sample.gradient);
  const double most = 2 * voxel;
  if (!(slope > 0)) return static_cast<float>(sample.value >= kIso ? -voxel : voxel);
  return static_cast<float>(std::clamp((kIso - sample.value) / slope, -most, most));
}

}  // namespace

std::optional<std::vector<FieldBlock>> sample_field(const Field& field, double voxel, const RunOptions& run) {
  std::vector<FieldBlock> blocks;
  if (field.bounds().empty()) return blocks;
  const Lattice lattice = make_indexed_lattice(field, voxel);
  struct Batch {
    std::array<float, 512> x, y, z;
  };
  tbb::enumerable_thread_specific<Batch> batches;
  const auto make = [&](Evaluator& evaluator, const PrunedField& pruned, const CellPlace& place) {
    FieldBlock block;
    block.first = first_voxel(lattice, place);
    const Vec3 base = lattice.box(place).lo - pruned.origin();
    Batch& batch = batches.local();
    for (int i = 0; i < 512; ++i) {
      batch.x[i] = static_cast<float>(base.x + voxel * (i >> 6));
      batch.y[i] = static_cast<float>(base.y + voxel * (i >> 3 & 7));
      batch.z[i] = static_cast<float>(base.z + voxel * (i & 7));
    }
    evaluator.values(pruned, batch.x, batch.y, batch.z, block.values);
    return block;
  };
  auto gathered = gather<FieldBlock>(field, lattice, Wanted::kMatter, make, run);
  if (!gathered) return std::nullopt;
  blocks.reserve(gathered->size());
  for (auto& [key, block] : *gathered) blocks.push_back(block);
  return blocks;
}

std::optional<std::vector<NearVoxel>> sample_near_surface(const Field& field, double voxel, const RunOptions& run) {
  std::vector<NearVoxel> voxels;
  if (field.bounds().empty()) return voxels;
  const Lattice lattice = make_indexed_lattice(field, voxel);
  tbb::enumerable_thread_specific<BlockContourer> contourers([&] { return BlockContourer(lattice); });
  const auto make = [&](Evaluator& evaluator, const PrunedField& pruned, const CellPlace& place) {
    BlockContour block;
    contourers.local().find_cells(evaluator, pruned, place, block);
    std::array<bool, 729> wanted{};
    block.cells.for_each([&](int, int x, int y, int z) {
      for (int c = 0; c < 8; ++c) wanted[x + (c & 1) + 9 * (y + (c >> 1 & 1) + 9 * (z + (c >> 2)))] = true;
    });
    std::vector<NearVoxel> near;
    const auto first = first_voxel(lattice, place);
    for (int i = 0; i < 729; ++i) {
      if (!wanted[i]) continue;
      const std::array<int, 3> at{i % 9, i / 9 % 9, i / 81};
      NearVoxel sample;
      for (int a = 0; a < 3; ++a) sample.index[a] = first[a] + at[a];
      const Vec3 p(voxel * sample.index[0], voxel * sample.index[1], voxel * sample.index[2]);
      sample.distance = distance_from(evaluator.sample(pruned, p), voxel);
      near.push_back(sample);
    }
    return near;
  };
  auto gathered = gather<std::vector<NearVoxel>>(field, lattice, Wanted::kSurface, make, run);
  if (!gathered) return std::nullopt;
  for (auto& [key, near] : *gathered) {
    voxels.insert(voxels.end(), near.begin(), near.end());
    near = {};
  }
  return voxels;
}

}  // namespace cambium
