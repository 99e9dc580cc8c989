#include "polygonize/mesh_components.h"

#include "polygonize/ordered_chunks.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace cambium {
namespace {

constexpr std::size_t kPerTask = 1 << 16;   // triangles: about a millisecond

/// Sets that several threads may join at once (Anderson & Woll 1991). A set's root is its least member, whoever was first.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t v) {
    for (std::uint32_t above = parent(v).load(); above != v;) {
      const std::uint32_t next = parent(above).load();
      if (next != above) parent(v).compare_exchange_weak(above, next);   // halves the way for those who come after
      v = next;
      above = parent(v).load();
    }
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = root(a), b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t still_root = a;
      if (parent(a).compare_exchange_strong(still_root, b)) return;
    }
  }

 private:
  std::atomic_ref<std::uint32_t> parent(std::uint32_t v) { return std::atomic_ref(parent_[v]); }
  std::vector<std::uint32_t> parent_;
};

struct Size {
  double volume = 0, area = 0;
};

/// Of some triangles, by the root of their component.
class Sizes {
 public:
  Size& of(std::uint32_t root) {   // neighbours in the list mostly are of one
    if (!last_ || last_root_ != root) last_ = &by_root_[root], last_root_ = root;
    return *last_;
  }
  const std::unordered_map<std::uint32_t, Size>& by_root() const { return by_root_; }

 private:
  std::unordered_map<std::uint32_t, Size> by_root_;
  Size* last_ = nullptr;
  std::uint32_t last_root_ = 0;
};

// Drops the vertices marked, and the triangles on them.
void remove_vertices(Mesh& mesh, const std::vector<bool>& gone) {
  constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(gone.size(), kGone);
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < gone.size(); ++v) {
    if (gone[v]) continue;
    place[v] = kept;
    mesh.positions[kept] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
    if (!mesh.colors.empty()) mesh.colors[kept] = mesh.colors[v];
    ++kept;
  }
  mesh.positions.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.colors.empty()) mesh.colors.resize(kept);
  std::size_t triangles = 0;
  for (const auto& t : mesh.triangles) {
    if (!gone[t[0]]) mesh.triangles[triangles++] = {place[t[0]], place[t[1]], place[t[2]]};
  }
  mesh.triangles.resize(triangles);
  std::size_t creases = 0;
  for (const auto& c : mesh.creases) {
    if (!gone[c[0]]) mesh.creases[creases++] = {place[c[0]], place[c[1]]};
  }
  mesh.creases.resize(creases);
}

}  // namespace

std::optional<ComponentReport> drop_small_components(Mesh& mesh, double thickness, double crumb, const RunOptions& run) {
  DisjointSets sets(mesh.positions.size());
  const auto for_triangles = [&](auto&& body) {
    return in_chunks<Sizes>(mesh.triangles.size(), kPerTask, [&](Sizes& part, std::size_t begin, std::size_t end) {
      if (run.cancelled()) return;
      for (std::size_t i = begin; i < end; ++i) body(mesh.triangles[i], part);
    });
  };
  for_triangles([&](const auto& t, Sizes&) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  });
  const auto sizes = for_triangles([&](const auto& t, Sizes& part) {
    const std::uint32_t root = sets.root(t[0]);
    const Vec3& from = mesh.positions[root];   // near the component, so that small volumes keep their digits
    Size& size = part.of(root);
    size.volume += glm::dot(mesh.positions[t[0]] - from,
                            glm::cross(mesh.positions[t[1]] - from, mesh.positions[t[2]] - from)) / 6;
    size.area += glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])) / 2;
  });
  if (run.cancelled()) return std::nullopt;
  std::vector<double> volume(mesh.positions.size(), 0.0), area(mesh.positions.size(), 0.0);   // at roots
  for (const Sizes& part : sizes)
    for (const auto& [root, size] : part.by_root()) volume[root] += size.volume, area[root] += size.area;
  ComponentReport report;
  std::vector<bool> gone(mesh.positions.size(), false);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const std::uint32_t root = sets.root(v);
    const bool is_void = volume[root] < 0;
    gone[v] = is_void ? -2 * volume[root] < thickness * area[root] : area[root] < std::numbers::pi * crumb * crumb;
    if (gone[v]) report.removed.push_back(mesh.positions[v]);
    if (root == v) ++(!gone[v] ? report.components : is_void ? report.closed_voids : report.crumbs);
  }
  if (report.closed_voids + report.crumbs > 0) remove_vertices(mesh, gone);
  return report;
}

}  // namespace cambium
