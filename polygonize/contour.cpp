#include "polygonize/contour.h"

#include "polygonize/cube_edges.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace cambium {
namespace {

constexpr std::size_t kGrain = 4096;

template <class T>
void sort_unique(std::vector<T>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

/// The patch on the other side of the face that two edges of a patch bound.
std::uint32_t patch_across(const Contour& contour, const CreaseExit& exit) {
  const auto& a = contour.patch_of_quadrant[exit.edge];
  const auto& b = contour.patch_of_quadrant[exit.next_edge];
  const auto beside = [&](const std::array<std::uint32_t, 4>& around, int k) {
    return around[kRing[(k + 1) % 4]] == exit.patch || around[kRing[(k + 3) % 4]] == exit.patch;
  };
  for (int k = 0; k < 4; ++k) {
    const std::uint32_t other = a[kRing[k]];
    if (other == exit.patch || !beside(a, k)) continue;
    for (int j = 0; j < 4; ++j) {
      if (b[kRing[j]] == other && beside(b, j)) return other;
    }
  }
  return kNoPatch;
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> crease_edges(const Contour& contour) {
  std::vector<std::array<std::uint32_t, 2>> creases;
  for (const CreaseExit& exit : contour.exits) {
    const std::uint32_t other = patch_across(contour, exit);
    if (other == kNoPatch || !contour.vertices[other].crease) continue;
    creases.push_back({std::min(exit.patch, other), std::max(exit.patch, other)});
  }
  sort_unique(creases);
  return creases;
}

Contour compacted(Contour&& contour) {
  Contour result;
  const auto living = [](std::size_t n, const auto& alive, std::vector<std::uint32_t>& now) {
    std::vector<std::uint32_t> list;
    now.assign(n, kNoPatch);
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!alive(i)) continue;
      now[i] = static_cast<std::uint32_t>(list.size());
      list.push_back(i);
    }
    return list;
  };
  std::vector<std::uint32_t> edge_now, patch_now;
  const auto edges = living(contour.edges.size(), [&](std::size_t e) { return contour.edge_alive[e] != 0; }, edge_now);
  const auto patches = living(contour.patches.size(), [&](std::size_t p) { return contour.patches[p].alive(); }, patch_now);
  const auto gather = [](auto& from, const std::vector<std::uint32_t>& list, auto& to, const auto& change) {
    to.resize(list.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, list.size(), kGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) to[i] = change(from[list[i]]);
    });
    from = {};
  };
  const auto same = [](const auto& item) { return item; };
  for (const CreaseExit& exit : contour.exits) {
    if (contour.patches[exit.patch].alive()) result.exits.push_back({patch_now[exit.patch], edge_now[exit.edge], edge_now[exit.next_edge]});
  }
  std::sort(result.exits.begin(), result.exits.end());
  contour.exits = {};
  contour.edge_alive = {};
  result.edge_alive.assign(edges.size(), 1);
  gather(contour.edges, edges, result.edges, same);
  gather(contour.crossings, edges, result.crossings, same);
  gather(contour.patch_of_quadrant, edges, result.patch_of_quadrant, [&](std::array<std::uint32_t, 4> around) {
    for (std::uint32_t& patch : around) patch = patch_now[patch];
    return around;
  });
  gather(contour.vertices, patches, result.vertices, same);
  std::uint32_t at = 0;
  for (const std::uint32_t p : patches) at += contour.patches[p].edge_count;
  result.rings.reserve(at);
  for (const std::uint32_t p : patches)
    for (const std::uint32_t e : contour.ring(p)) result.rings.push_back(edge_now[e]);
  contour.rings = {};
  gather(contour.patches, patches, result.patches, same);
  at = 0;
  for (Patch& patch : result.patches) patch.first_edge = at, at += patch.edge_count;
  return result;
}

}  // namespace cambium
