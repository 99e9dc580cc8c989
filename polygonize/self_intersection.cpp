#include "polygonize/box_tree.h"
#include "polygonize/triangle_contact.h"
#include "polygonize/verify.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace cambium {
namespace {

using Corners = std::array<std::uint32_t, 3>;

bool wrongly_meet(const Mesh& mesh, const Corners& s, const Corners& t) {
  const auto place = [&](const Corners& c, std::size_t first) {   // turned so that corner `first` leads
    return TriangleCorners{mesh.positions[c[first]], mesh.positions[c[(first + 1) % 3]], mesh.positions[c[(first + 2) % 3]]};
  };
  std::size_t shared = 0, at_s = 0, at_t = 0;
  std::array<bool, 3> in_t{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (s[i] != t[j]) continue;
      ++shared;
      in_t[i] = true;
      at_s = i, at_t = j;
    }
  }
  if (shared == 0) return triangles_meet(place(s, 0), place(t, 0));
  if (shared == 1) return triangles_meet_beyond_corner(place(s, at_s), place(t, at_t));
  if (shared > 2) return true;   // the same triangle twice, or one with a corner twice
  const std::size_t far_s = !in_t[0] ? 0 : !in_t[1] ? 1 : 2;
  const std::uint32_t u = s[(far_s + 1) % 3], v = s[(far_s + 2) % 3];
  const std::size_t far_t = t[0] != u && t[0] != v ? 0 : t[1] != u && t[1] != v ? 1 : 2;
  return triangles_meet_beyond_edge({mesh.positions[u], mesh.positions[v], mesh.positions[s[far_s]]},
                                    {mesh.positions[u], mesh.positions[v], mesh.positions[t[far_t]]});
}

}  // namespace

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
          if (wrongly_meet(mesh, mesh.triangles[i], mesh.triangles[j])) mine.push_back({std::min(i, j), std::max(i, j)});
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
