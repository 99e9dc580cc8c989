#include "polygonize/vertex_clusters.h"

#include "polygonize/ordered_chunks.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace cambium {
namespace {

constexpr std::size_t kRun = 64;                 // vertices that may share a cluster
constexpr std::size_t kTask = 64 * kRun;
constexpr float kAlike = 0.79f;                  // least cosine to the first of a cluster: the sides of a six-sided twig stay apart
constexpr double kSteps = 5;                     // widest, in steps between vertices that follow each other

template <class Work>
void for_tasks(std::size_t count, const RunOptions& run, const Work& work) {
  tbb::parallel_for(std::size_t{0}, (count + kTask - 1) / kTask, [&](std::size_t task) {
    if (!run.cancelled()) work(task, task * kTask, std::min(count, (task + 1) * kTask));
  });
}

/// Squared; half of the steps from one vertex of a run to the next are shorter.
double median_step2(const Mesh& mesh, std::size_t begin, std::size_t end) {
  std::array<double, kRun> steps;
  std::size_t count = 0;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Vec3 step = mesh.positions[i] - mesh.positions[i - 1];
    steps[count++] = glm::dot(step, step);
  }
  if (count == 0) return 0;
  const auto median = steps.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(steps.begin(), median, steps.begin() + static_cast<std::ptrdiff_t>(count));
  return *median;
}

/// Appends the middles of a run's clusters, by which they are numbered.
void cluster_run(const Mesh& mesh, double spacing, std::size_t begin, std::size_t end, std::vector<std::uint32_t>& of_vertex,
                 std::vector<std::uint32_t>& middles) {
  struct Cluster {
    std::uint32_t first = 0, count = 0;
    Vec3 sum{0.0};
    double nearest = kInfinity;
  };
  // From the first to any other, so half of the widest.
  const double reach2 = 0.25 * std::min(spacing * spacing, kSteps * kSteps * median_step2(mesh, begin, end));
  std::array<Cluster, kRun> clusters;
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const Vec3& p = mesh.positions[i];
    const auto takes = [&](const Cluster& c) {
      const Vec3 apart = p - mesh.positions[c.first];
      return glm::dot(apart, apart) <= reach2 && glm::dot(mesh.normals[i], mesh.normals[c.first]) >= kAlike;
    };
    std::size_t c = 0;
    while (c < count && !takes(clusters[c])) ++c;
    if (c == count) clusters[count++] = {.first = static_cast<std::uint32_t>(i)};
    ++clusters[c].count;
    clusters[c].sum += p;
    of_vertex[i] = static_cast<std::uint32_t>(middles.size() + c);
  }
  const std::size_t first = middles.size();
  middles.resize(first + count);
  for (std::size_t i = begin; i < end; ++i) {
    Cluster& c = clusters[of_vertex[i] - first];
    const Vec3 apart = mesh.positions[i] - c.sum / static_cast<double>(c.count);
    if (const double d = glm::dot(apart, apart); d < c.nearest) {
      c.nearest = d;
      middles[of_vertex[i]] = static_cast<std::uint32_t>(i);
    }
  }
}

std::vector<std::uint32_t> first_of(const std::vector<std::vector<std::uint32_t>>& parts) {
  std::vector<std::uint32_t> first(parts.size() + 1, 0);
  for (std::size_t i = 0; i < parts.size(); ++i) first[i + 1] = first[i] + static_cast<std::uint32_t>(parts[i].size());
  return first;
}

}  // namespace

VertexClusters cluster_vertices(const Mesh& mesh, double spacing, const RunOptions& run) {
  VertexClusters out;
  const std::size_t vertices = mesh.positions.size(), triangles = mesh.triangles.size();
  out.of_vertex.resize(vertices);
  if (!(spacing > 0)) {
    std::iota(out.of_vertex.begin(), out.of_vertex.end(), 0u);
    out.middle = out.of_vertex;
    out.triangles = mesh.triangles;
    return out;
  }
  std::vector<std::vector<std::uint32_t>> middles((vertices + kTask - 1) / kTask);
  for_tasks(vertices, run, [&](std::size_t task, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; i += kRun)
      cluster_run(mesh, spacing, i, std::min(end, i + kRun), out.of_vertex, middles[task]);
  });
  const auto first = first_of(middles);
  for_tasks(vertices, run, [&](std::size_t task, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out.of_vertex[i] += first[task];
  });
  append_parts(middles, out.middle);

  std::vector<std::vector<std::array<std::uint32_t, 3>>> between((triangles + kTask - 1) / kTask);
  for_tasks(triangles, run, [&](std::size_t task, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& t = mesh.triangles[i];
      const std::array<std::uint32_t, 3> c{out.of_vertex[t[0]], out.of_vertex[t[1]], out.of_vertex[t[2]]};
      if (c[0] != c[1] && c[1] != c[2] && c[2] != c[0]) between[task].push_back(c);
    }
  });
  append_parts(between, out.triangles);
  return run.cancelled() ? VertexClusters{} : out;
}

}  // namespace cambium
