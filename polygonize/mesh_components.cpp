#include "polygonize/mesh_components.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace cambium {
namespace {

constexpr std::size_t kPollEvery = 1 << 18;   // triangles: a few milliseconds

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
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
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kPollEvery == 0 && run.cancelled()) return std::nullopt;
    sets.join(mesh.triangles[i][0], mesh.triangles[i][1]);
    sets.join(mesh.triangles[i][0], mesh.triangles[i][2]);
  }
  std::vector<double> volume(mesh.positions.size(), 0.0), area(mesh.positions.size(), 0.0);   // at roots
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kPollEvery == 0 && run.cancelled()) return std::nullopt;
    const auto& t = mesh.triangles[i];
    const std::uint32_t root = sets.root(t[0]);
    const Vec3& from = mesh.positions[root];   // near the component, so that small volumes keep their digits
    volume[root] += glm::dot(mesh.positions[t[0]] - from,
                             glm::cross(mesh.positions[t[1]] - from, mesh.positions[t[2]] - from)) / 6;
    area[root] += glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]])) / 2;
  }
  ComponentReport report;
  std::vector<bool> gone(mesh.positions.size(), false);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const std::uint32_t root = sets.root(v);
    const bool is_void = volume[root] < 0;
    gone[v] = is_void ? -2 * volume[root] < thickness * area[root] : area[root] < std::numbers::pi * crumb * crumb;
    if (root == v) ++(!gone[v] ? report.components : is_void ? report.closed_voids : report.crumbs);
  }
  if (report.closed_voids + report.crumbs > 0) remove_vertices(mesh, gone);
  return report;
}

}  // namespace cambium
