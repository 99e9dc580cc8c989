#include "polygonize/contour.h"

#include "polygonize/cube_edges.h"
#include "polygonize/ordered_chunks.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>

namespace cambium {
namespace {

constexpr std::size_t kChunk = 1 << 16;

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

namespace {

template <class IsAlive>
std::vector<std::uint32_t> listed_if(std::size_t n, IsAlive&& is_alive) {
  auto parts = in_chunks<std::vector<std::uint32_t>>(n, kChunk, [&](auto& part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_alive(i)) part.push_back(static_cast<std::uint32_t>(i));
  });
  std::vector<std::uint32_t> all;
  append_parts(parts, all);
  return all;
}

}  // namespace

Living living_part(const Contour& contour) {
  return {listed_if(contour.edges.size(), [&](std::size_t e) { return contour.edge_alive[e] != 0; }),
          listed_if(contour.patches.size(), [&](std::size_t p) { return contour.patches[p].alive(); })};
}

std::vector<std::uint32_t> numbers_among(const std::vector<std::uint32_t>& kept, std::size_t n) {
  std::vector<std::uint32_t> now(n, kNoPatch);
  for (std::uint32_t i = 0; i < kept.size(); ++i) now[kept[i]] = i;
  return now;
}

void compact(Contour& contour, const Living& living) {
  const std::vector<std::uint32_t> edge_now = numbers_among(living.edges, contour.edges.size());
  const std::vector<std::uint32_t> patch_now = numbers_among(living.patches, contour.patches.size());
  std::erase_if(contour.exits, [&](const CreaseExit& exit) { return patch_now[exit.patch] == kNoPatch; });
  for (CreaseExit& exit : contour.exits) exit = {patch_now[exit.patch], edge_now[exit.edge], edge_now[exit.next_edge]};
  std::sort(contour.exits.begin(), contour.exits.end());
  std::uint32_t rings = 0;   // none lies before those of lower patches
  for (const std::uint32_t p : living.patches) {
    Patch& patch = contour.patches[p];
    for (std::uint32_t k = 0; k < patch.edge_count; ++k) contour.rings[rings + k] = edge_now[contour.rings[patch.first_edge + k]];
    patch.first_edge = rings;
    rings += patch.edge_count;
  }
  contour.rings.resize(rings);
  contour.rings.shrink_to_fit();
  for (const std::uint32_t e : living.edges)
    for (std::uint32_t& patch : contour.patch_of_quadrant[e]) patch = patch_now[patch];
  const auto keep = [](auto& items, const std::vector<std::uint32_t>& kept) {
    return [&] { keep_listed(items, kept); };
  };
  tbb::parallel_invoke(keep(contour.edges, living.edges), keep(contour.edge_alive, living.edges), keep(contour.crossings, living.edges),
                       keep(contour.patch_of_quadrant, living.edges), keep(contour.patches, living.patches),
                       keep(contour.vertices, living.patches));
}

}  // namespace cambium
