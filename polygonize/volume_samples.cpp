#include "polygonize/volume_samples.h"

#include "blobtree/cell_search.h"
#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

namespace cambium {
namespace {

std::array<std::int32_t, 3> first_voxel(const Lattice& lattice, const CellPlace& place) {
  std::array<std::int32_t, 3> first{};
  for (int a = 0; a < 3; ++a) {
    first[a] = static_cast<std::int32_t>(lattice.first(a) + std::int64_t{place[a]} * kBlockCells);
  }
  return first;
}

}  // namespace

Lattice make_indexed_lattice(const Box& bounds, double voxel) {
  const Lattice lattice = make_lattice(bounds, voxel);
  for (int a = 0; a < 3; ++a) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max() - (std::int64_t{2} << kCoordinateBits);
    if (std::abs(lattice.first(a)) > kMost)
      throw InputError({}, "a model too far from the origin for this voxel", "32-bit voxel indices");
  }
  return lattice;
}

std::optional<std::vector<std::unique_ptr<FieldBlock>>> sample_field(const Field& field, double voxel, const RunOptions& run) {
  std::vector<std::unique_ptr<FieldBlock>> blocks;
  if (field.bounds().empty()) return blocks;
  const Lattice lattice = make_indexed_lattice(field.bounds(), voxel);
  struct Batch {
    std::array<float, 512> x, y, z;
  };
  tbb::enumerable_thread_specific<Batch> batches;
  std::vector<std::pair<std::uint64_t, std::unique_ptr<FieldBlock>>> found;
  std::mutex mutex;
  const auto visit = [&](Evaluator& evaluator, const PrunedField& pruned, const CellPlace& place) {
    auto block = std::make_unique<FieldBlock>();
    block->first = first_voxel(lattice, place);
    const Vec3 base = lattice.box(place).lo - pruned.origin();
    Batch& batch = batches.local();
    for (int i = 0; i < 512; ++i) {
      batch.x[i] = static_cast<float>(base.x + voxel * (i >> 6));
      batch.y[i] = static_cast<float>(base.y + voxel * (i >> 3 & 7));
      batch.z[i] = static_cast<float>(base.z + voxel * (i & 7));
    }
    evaluator.values(pruned, batch.x, batch.y, batch.z, block->values);
    const std::lock_guard lock(mutex);
    found.emplace_back(morton_key(place), std::move(block));
  };
  ProgressMeter progress(run, "sampling voxels");
  bool complete = false;
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    complete = visit_cells(field, lattice.blocks, Wanted::kMatter, visit, run, progress);
    tbb::parallel_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  });
  if (!complete) return std::nullopt;
  blocks.reserve(found.size());
  for (auto& [key, block] : found) blocks.push_back(std::move(block));
  return blocks;
}

}  // namespace cambium
