#include "polygonize/mesh_border.h"

#include "polygonize/ordered_chunks.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>

namespace cambium {
namespace {

constexpr std::size_t kTrianglesPerTask = 1 << 14;
constexpr std::uint32_t kNoLoop = std::numeric_limits<std::uint32_t>::max();

struct Side {
  std::uint32_t from = 0, to = 0;
  auto operator<=>(const Side&) const = default;
};

/// Sides between two vertices that may be open, ascending.
std::vector<Side> sides_between(const Mesh& mesh, const std::vector<std::uint8_t>& may_be_open) {
  auto parts = in_chunks<std::vector<Side>>(mesh.triangles.size(), kTrianglesPerTask, [&](auto& part, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
        if (may_be_open[from] && may_be_open[to]) part.push_back({from, to});
      }
  });
  std::vector<Side> all;
  append_parts(parts, all);
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

/// A vertex or a triangle that is near a loop.
struct Near {
  std::uint32_t item = 0, loop = 0;
  auto operator<=>(const Near&) const = default;
};

void sort_unique(std::vector<Near>& items) {
  tbb::parallel_sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// The triangles that touch vertices, with these's loops.
std::vector<Near> triangles_at(const Mesh& mesh, const std::vector<Near>& vertices) {
  std::vector<std::uint8_t> listed(mesh.positions.size(), 0);
  for (const Near& vertex : vertices) listed[vertex.item] = 1;
  auto parts = in_chunks<std::vector<Near>>(mesh.triangles.size(), kTrianglesPerTask, [&](auto& part, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (const std::uint32_t v : mesh.triangles[t]) {
        if (!listed[v]) continue;
        for (auto at = std::lower_bound(vertices.begin(), vertices.end(), Near{v, 0}); at != vertices.end() && at->item == v; ++at) {
          part.push_back({static_cast<std::uint32_t>(t), at->loop});
        }
      }
  });
  std::vector<Near> triangles;
  append_parts(parts, triangles);
  sort_unique(triangles);
  return triangles;
}

void list_triangles(const Mesh& mesh, MeshBorder& border) {
  std::vector<Near> vertices, triangles;
  for (std::uint32_t loop = 0; loop < border.loops.size(); ++loop)
    for (const std::uint32_t vertex : border.loops[loop]) vertices.push_back({vertex, loop});
  for (int ring = 0; ring < 2; ++ring) {
    sort_unique(vertices);
    triangles = triangles_at(mesh, vertices);
    for (const Near& triangle : triangles)
      for (const std::uint32_t v : mesh.triangles[triangle.item]) vertices.push_back({v, triangle.loop});
  }
  border.triangles.assign(border.loops.size(), {});
  for (const Near& triangle : triangles) border.triangles[triangle.loop].push_back(triangle.item);
}

}  // namespace

MeshBorder find_border(const Mesh& mesh, const std::vector<std::uint8_t>& may_be_open) {
  const std::vector<Side> sides = sides_between(mesh, may_be_open);
  std::vector<Side> open;   // ascending
  std::copy_if(sides.begin(), sides.end(), std::back_inserter(open), [&](const Side& side) {
    return !std::binary_search(sides.begin(), sides.end(), Side{side.to, side.from});
  });
  const auto leaving = [&](std::uint32_t vertex) {
    return static_cast<std::size_t>(std::lower_bound(open.begin(), open.end(), Side{vertex, 0}) - open.begin());
  };
  MeshBorder border;
  std::vector<std::uint32_t> loop_of(open.size(), kNoLoop);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (loop_of[i] != kNoLoop) continue;
    const auto loop = static_cast<std::uint32_t>(border.loops.size());
    auto& vertices = border.loops.emplace_back();
    for (std::size_t at = i; at < open.size() && loop_of[at] == kNoLoop; at = leaving(open[at].to)) {
      loop_of[at] = loop;
      vertices.push_back(open[at].from);
    }
  }
  list_triangles(mesh, border);
  return border;
}

}  // namespace cambium
