#include "polygonize/vertex_spacing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace cambium {
namespace {

constexpr std::size_t kBlock = 8192;   // of a task

/// Squared lengths of a vertex's edges.
struct EdgeRange {
  float shortest = std::numeric_limits<float>::max(), longest = 0;
};

/// Extremes do not depend on the order in which threads come.
template <class Better>
void keep(float& extreme, float value, const Better& better) {
  const std::atomic_ref kept(extreme);
  float known = kept.load(std::memory_order_relaxed);
  while (better(value, known) && !kept.compare_exchange_weak(known, value, std::memory_order_relaxed)) {}
}

template <class Work>
void for_blocks(std::size_t count, const RunOptions& run, const Work& work) {
  tbb::parallel_for(std::size_t{0}, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
    if (run.cancelled()) return;
    for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) work(i);
  });
}

}  // namespace

std::vector<float> vertex_spacing(const Mesh& mesh, const RunOptions& run) {
  std::vector<EdgeRange> ranges(mesh.positions.size());
  for_blocks(mesh.triangles.size(), run, [&](std::size_t t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t from = mesh.triangles[t][c], to = mesh.triangles[t][(c + 1) % 3];
      const glm::vec3 edge(mesh.positions[to] - mesh.positions[from]);
      const float length2 = glm::dot(edge, edge);
      for (const std::uint32_t v : {from, to}) {
        keep(ranges[v].shortest, length2, std::less{});
        keep(ranges[v].longest, length2, std::greater{});
      }
    }
  });
  std::vector<float> spacing(ranges.size(), 0.0f);
  for_blocks(ranges.size(), run, [&](std::size_t i) {
    if (ranges[i].longest > 0) spacing[i] = std::sqrt(std::sqrt(ranges[i].shortest) * std::sqrt(ranges[i].longest));
  });
  return spacing;
}

}  // namespace cambium
