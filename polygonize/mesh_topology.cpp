#include "polygonize/exact_orientation.h"
#include "polygonize/verify.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace cambium {
namespace {

// The triangles around each vertex, as the vertices that come next and before in them.
struct Spokes {
  std::uint32_t next, previous;
};
struct Stars {
  std::vector<std::size_t> first;   // of vertex v; one more at the end
  std::vector<Spokes> spokes;
};

Stars stars_of(const Mesh& mesh) {
  Stars stars;
  stars.first.assign(mesh.positions.size() + 1, 0);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) ++stars.first[v + 1];
  std::partial_sum(stars.first.begin(), stars.first.end(), stars.first.begin());
  stars.spokes.resize(3 * mesh.triangles.size());
  std::vector<std::size_t> at(stars.first.begin(), stars.first.end() - 1);
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) stars.spokes[at[t[k]]++] = {t[(k + 1) % 3], t[(k + 2) % 3]};
  return stars;
}

// What one thread counts; scratch for one star.
class StarCounter {
 public:
  void count(std::uint32_t vertex, const Spokes* begin, const Spokes* end) {
    if (begin == end) {
      ++result.unused_vertices;
      return;
    }
    ends_.clear();
    parent_.clear();
    for (const Spokes* s = begin; s != end; ++s) {
      const auto triangle = static_cast<std::uint32_t>(parent_.size());
      ends_.push_back({s->next, triangle, true});
      ends_.push_back({s->previous, triangle, false});
      parent_.push_back(triangle);
    }
    std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.vertex < b.vertex; });
    std::size_t fans = parent_.size();
    for (auto from = ends_.begin(); from != ends_.end();) {
      auto to = from;
      std::size_t leaving = 0, uses = 0;
      for (; to != ends_.end() && to->vertex == from->vertex; ++to) {
        ++uses;
        leaving += to->leaves;
        const std::uint32_t a = root(from->triangle), b = root(to->triangle);
        if (a != b) {
          parent_[b] = a;
          --fans;
        }
      }
      if (from->vertex > vertex) {   // its other end does not count it again
        ++edges;
        if (uses == 1) ++result.boundary_edges;
        else if (uses > 2 || leaving != 1) ++result.nonmanifold_edges;
      }
      from = to;
    }
    if (fans > 1) ++result.nonmanifold_vertices;
  }

  MeshTopology result;
  std::size_t edges = 0;

 private:
  struct End {
    std::uint32_t vertex, triangle;
    bool leaves;
  };
  std::uint32_t root(std::uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }
  std::vector<End> ends_;
  std::vector<std::uint32_t> parent_;
};

std::size_t count_components(const Mesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> used(mesh.positions.size(), false);
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const std::uint32_t a = root(t[0]), b = root(v);
      if (a != b) parent[std::max(a, b)] = std::min(a, b);
      used[v] = true;
    }
  }
  std::size_t components = 0;
  for (std::uint32_t v = 0; v < parent.size(); ++v) components += used[v] && parent[v] == v;
  return components;
}

double volume_of(const Mesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  Box box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  const Vec3 from = box.center();   // near the mesh, so that small volumes keep their digits
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    volume += glm::dot(mesh.positions[t[0]] - from, glm::cross(mesh.positions[t[1]] - from, mesh.positions[t[2]] - from));
  }
  return volume / 6;
}

}  // namespace

std::optional<MeshTopology> check_topology(const Mesh& mesh, const RunOptions& run) {
  const Stars stars = stars_of(mesh);
  if (run.cancelled()) return std::nullopt;
  tbb::enumerable_thread_specific<StarCounter> counters;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), 4096), [&](const auto& range) {
    if (run.cancelled()) return;
    StarCounter& counter = counters.local();
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      counter.count(static_cast<std::uint32_t>(v), stars.spokes.data() + stars.first[v], stars.spokes.data() + stars.first[v + 1]);
    }
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096), [&](const auto& range) {
    if (run.cancelled()) return;
    StarCounter& counter = counters.local();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto& t = mesh.triangles[i];
      const bool repeated = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
      counter.result.degenerate_triangles +=
          repeated || collinear(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    }
  });
  MeshTopology topology;
  std::size_t edges = 0;
  for (const StarCounter& c : counters) {
    topology.boundary_edges += c.result.boundary_edges;
    topology.nonmanifold_edges += c.result.nonmanifold_edges;
    topology.nonmanifold_vertices += c.result.nonmanifold_vertices;
    topology.degenerate_triangles += c.result.degenerate_triangles;
    topology.unused_vertices += c.result.unused_vertices;
    edges += c.edges;
  }
  if (run.cancelled()) return std::nullopt;
  topology.components = count_components(mesh);
  topology.euler = static_cast<std::int64_t>(mesh.positions.size() - topology.unused_vertices) - static_cast<std::int64_t>(edges) +
                   static_cast<std::int64_t>(mesh.triangles.size());
  topology.volume = volume_of(mesh);
  if (run.cancelled()) return std::nullopt;
  return topology;
}

MeshTopology check_topology(const Mesh& mesh) { return *check_topology(mesh, RunOptions{}); }

}  // namespace cambium
