#include "blobtree/box_tree.h"
#include "polygonize/triangle_contact.h"
#include "polygonize/verify.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace cambium {

std::optional<std::vector<std::array<std::uint32_t, 2>>> self_intersections(const Mesh& mesh, const RunOptions& run) {
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  Pairs pairs;
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    const BoxTree tree(mesh.triangles.size(), [&](std::uint32_t i) {
      Box box;
      for (const std::uint32_t v : mesh.triangles[i]) box.extend(mesh.positions[v]);
      return box;
    });
    if (run.cancelled()) return;
    tbb::enumerable_thread_specific<Pairs> found;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tree.leaf_count(), 64), [&](const auto& range) {
      Pairs& mine = found.local();
      for (std::size_t leaf = range.begin(); leaf < range.end() && !run.cancelled(); ++leaf) {
        tree.overlaps(leaf, [&](std::uint32_t i, std::uint32_t j) {
          if (triangles_meet_wrongly(mesh.positions, mesh.triangles[i], mesh.triangles[j]))
            mine.push_back({std::min(i, j), std::max(i, j)});
        });
      }
    });
    for (const Pairs& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
    tbb::parallel_sort(pairs.begin(), pairs.end());
  });
  if (run.cancelled()) return std::nullopt;
  return pairs;
}

}  // namespace cambium
