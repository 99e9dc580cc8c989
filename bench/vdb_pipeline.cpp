#include "bench/vdb_pipeline.h"

#include "blobtree/cell_search.h"
#include "blobtree/progress_meter.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <array>
#include <memory>
#include <mutex>
#include <vector>

namespace cambium::bench {
namespace {

using Grid = openvdb::FloatGrid;
using Leaf = Grid::TreeType::LeafNodeType;
constexpr int kEdge = 8;

Grid::Ptr rasterise(const Field& field, double voxel, int threads) {
  Grid::Ptr grid = Grid::create(0.0f);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  const CellGrid leaves = cell_grid(field.bounds(), voxel * kEdge);
  struct Batch {
    std::array<float, 512> x, y, z, f;
  };
  tbb::enumerable_thread_specific<Batch> batches;
  std::mutex mutex;
  const auto visit = [&](Evaluator& evaluator, const PrunedField& pruned, const CellPlace& place) {
    Batch& batch = batches.local();
    const Vec3 corner = leaves.box(place, 0).lo - pruned.origin();
    for (int i = 0; i < 512; ++i) {
      batch.x[i] = static_cast<float>(corner.x + voxel * (i >> 6));
      batch.y[i] = static_cast<float>(corner.y + voxel * (i >> 3 & 7));
      batch.z[i] = static_cast<float>(corner.z + voxel * (i & 7));
    }
    evaluator.values(pruned, batch.x, batch.y, batch.z, batch.f);
    std::array<int, 3> first{};
    for (int a = 0; a < 3; ++a) first[a] = static_cast<int>((leaves.first[a] + static_cast<std::int64_t>(place[a])) * kEdge);
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(first[0], first[1], first[2]), 0.0f, false);
    bool any = false;
    for (openvdb::Index i = 0; i < 512; ++i) {
      if (!(batch.f[i] > 0)) continue;
      leaf->setValueOn(i, batch.f[i]);
      any = true;
    }
    if (!any) return;
    const std::lock_guard lock(mutex);
    grid->tree().addLeaf(leaf.release());
  };
  RunOptions run;
  run.threads = threads;
  ProgressMeter progress(run, "rasterising");
  tbb::task_arena arena(threads);
  arena.execute([&] { visit_cells(field, leaves, Wanted::kMatter, visit, run, progress); });
  return grid;
}

}  // namespace

Mesh vdb_pipeline(const Field& field, double voxel, int threads, const std::function<void()>& made) {
  openvdb::initialize();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  {
    const Grid::Ptr grid = rasterise(field, voxel, threads);
    openvdb::tools::volumeToMesh(*grid, points, quads, kIso);
  }
  made();
  Mesh mesh;
  mesh.positions.reserve(points.size());
  for (const auto& p : points) mesh.positions.emplace_back(p.x(), p.y(), p.z());
  mesh.triangles.reserve(2 * quads.size());
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

}  // namespace cambium::bench
