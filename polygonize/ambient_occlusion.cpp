#include "polygonize/ambient_occlusion.h"

#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "polygonize/lattice.h"
#include "polygonize/vertex_clusters.h"

#if CAMBIUM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>

namespace cambium {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr double kSpacing = 0.03;      // of what rays leave from, in reaches
// What two rays say of a place is little; with what the neighbours' say it is enough.
constexpr int kSmoothings = 3;

#if CAMBIUM_EMBREE_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
#else
void intersect(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
#endif

/// The triangles between the clusters in Embree, in floats about the mesh's centre.
class Obstacles {
 public:
  Obstacles(const Mesh& mesh, const VertexClusters& clusters, const Vec3& center, const RunOptions& run) : run_(run) {
    device_ = rtcNewDevice(nullptr);
    if (!device_) throw std::runtime_error("Embree could not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);       // what a ray hits then does not depend on how the hierarchy was built
    rtcSetSceneProgressMonitorFunction(scene_, go_on, this);
    // Few rays then, so a hierarchy that is made three times as fast and passed through a third more slowly.
    const RTCBuildQuality quality = clusters.middle.size() < mesh.positions.size() ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
    rtcSetSceneBuildQuality(scene_, quality);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                       3 * sizeof(float), clusters.middle.size()));
    auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), clusters.triangles.size()));
    rtcSetGeometryBuildQuality(geometry, quality);
    if (vertices && indices) {
      for (std::size_t i = 0; i < clusters.middle.size(); ++i)
        for (int a = 0; a < 3; ++a) vertices[3 * i + a] = static_cast<float>(mesh.positions[clusters.middle[i]][a] - center[a]);
      for (std::size_t i = 0; i < clusters.triangles.size(); ++i) std::copy_n(clusters.triangles[i].data(), 3, indices + 3 * i);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
    }
    rtcReleaseGeometry(geometry);
    if (vertices && indices) rtcCommitScene(scene_);
    const RTCError error = rtcGetDeviceError(device_);
    if (error == RTC_ERROR_NONE || run.cancelled()) return;
    release();
    throw std::runtime_error("Embree could not build its hierarchy (error " + std::to_string(error) + ")");
  }
  ~Obstacles() { release(); }
  Obstacles(const Obstacles&) = delete;
  Obstacles& operator=(const Obstacles&) = delete;

  /// Metres to the nearest obstacle, at most `reach`.
  float distance(const glm::vec3& from, const glm::vec3& direction, float reach) const {
    RTCRayHit query;
    query.ray.org_x = from.x, query.ray.org_y = from.y, query.ray.org_z = from.z;
    query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
    query.ray.tnear = 0;
    query.ray.tfar = reach;
    query.ray.time = 0;
    query.ray.mask = ~0u;
    query.ray.id = query.ray.flags = 0;
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(scene_, query);
    return query.ray.tfar;
  }

 private:
  static bool go_on(void* self, double) { return !static_cast<const Obstacles*>(self)->run_.cancelled(); }
  void release() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
    scene_ = nullptr;
    device_ = nullptr;
  }

  const RunOptions& run_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

/// Cosine-weighted directions over the upper half of the unit sphere: the k-th of a low-discrepancy sequence (Roberts 2018). Neighbours
/// in the mesh mostly have neighbouring numbers and so, between them, well-spread rays: their mean has little noise.
glm::vec3 direction(std::uint64_t k) {
  constexpr std::uint64_t kFirst = 0xc13fa9a902a6328full, kSecond = 0x91e10da5c79e7b1dull;   // 2^64 / g and / g^2, g^3 = g + 1
  const float a = static_cast<float>((k * kFirst) >> 40) * 0x1p-24f, turn = static_cast<float>((k * kSecond) >> 40) * 0x1p-24f;
  const float across = std::sqrt(a), angle = 2 * std::numbers::pi_v<float> * turn;
  return {across * std::cos(angle), across * std::sin(angle), std::sqrt(1 - a)};
}

/// Two unit vectors that with n make a right-handed frame (Duff et al. 2017).
void frame_of(const glm::vec3& n, glm::vec3& t, glm::vec3& b) {
  const float sign = std::copysign(1.0f, n.z), p = -1 / (sign + n.z), q = n.x * n.y * p;
  t = {1 + sign * n.x * n.x * p, sign * q, -sign * n.x};
  b = {q, sign + n.y * n.y * p, -n.y};
}

/// The neighbours of each cluster in the triangles between them, itself first.
class ClusterGraph {
 public:
  explicit ClusterGraph(const VertexClusters& clusters) : first_(clusters.middle.size() + 1, 1) {
    const auto& triangles = clusters.triangles;
    first_[0] = 0;
    for (const auto& t : triangles)
      for (const std::uint32_t c : t) ++first_[c + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    neighbours_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t c = 0; c < next.size(); ++c) neighbours_[next[c]++] = c;
    // In a closed mesh every edge runs once each way, so each neighbour counts once.
    for (const auto& t : triangles)
      for (int c = 0; c < 3; ++c) neighbours_[next[t[c]]++] = t[(c + 1) % 3];
  }
  std::span<const std::uint32_t> around(std::uint32_t cluster) const {
    return {neighbours_.data() + first_[cluster], first_[cluster + 1] - first_[cluster]};
  }

 private:
  std::vector<std::uint32_t> first_, neighbours_;
};

void smooth(const ClusterGraph& graph, std::vector<float>& values) {
  std::vector<float> means(values.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.size(), kBlock), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto around = graph.around(static_cast<std::uint32_t>(i));
      float sum = 0;
      for (const std::uint32_t k : around) sum += values[k];
      means[i] = sum / static_cast<float>(around.size());
    }
  });
  values.swap(means);
}

/// From the clusters' middles to all vertices: of a vertex's cluster and those around it, the near ones that face its way count most.
std::vector<float> spread(const Mesh& mesh, const VertexClusters& clusters, const ClusterGraph& graph, const std::vector<float>& values) {
  std::vector<float> out(mesh.positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), kBlock), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      float total = 0, sum = 0;
      for (const std::uint32_t k : graph.around(clusters.of_vertex[i])) {
        const std::uint32_t m = clusters.middle[k];
        if (m == i) {
          total = 1, sum = values[k];
          break;
        }
        const glm::vec3 apart(mesh.positions[i] - mesh.positions[m]);
        const float facing = std::max(0.0f, glm::dot(mesh.normals[i], mesh.normals[m]));
        const float weight = (1e-3f + facing * facing) / (glm::dot(apart, apart) + 1e-30f);
        total += weight;
        sum += weight * values[k];
      }
      out[i] = sum / total;
    }
  });
  return out;
}

}  // namespace

std::optional<std::vector<float>> ambient_occlusion(const Mesh& mesh, const OcclusionOptions& options, const RunOptions& run) {
  if (options.rays < 1 || options.rays > 4096)
    throw InputError({}, std::to_string(options.rays) + " rays of occlusion", "1 to 4096");
  if (options.reach) require_length(*options.reach, "reach of occlusion");
  if (options.spacing && *options.spacing != 0) require_length(*options.spacing, "spacing of occlusion");
  if (mesh.normals.size() != mesh.positions.size()) throw std::invalid_argument("occlusion of a mesh without normals");
  if (mesh.triangles.empty()) return std::vector<float>(mesh.positions.size(), 1.0f);
  Box bounds;
  for (const Vec3& p : mesh.positions) bounds.extend(p);
  const Vec3 size = bounds.size(), center = bounds.center();
  const double tenth = 0.1 * std::max({size.x, size.y, size.z}), reach = options.reach.value_or(tenth);
  const double spacing = options.spacing.value_or(kSpacing * std::min(reach, tenth));
  const double lift = 1e-3 * reach + 4e-7 * glm::length(size);   // off the surface, beyond what floats lose

  ProgressMeter progress(run, "occlusion");
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  std::vector<float> open;
  arena.execute([&] {
    VertexClusters clusters = cluster_vertices(mesh, spacing, run);
    if (clusters.triangles.empty() && !run.cancelled()) clusters = cluster_vertices(mesh, 0, run);   // as flat as that
    if (run.cancelled()) return;
    const Obstacles obstacles(mesh, clusters, center, run);
    if (run.cancelled()) return;
    const auto length = static_cast<float>(reach);
    std::vector<float> seen(clusters.middle.size());
    const double step = 1.0 / static_cast<double>(seen.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, seen.size(), kBlock), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        if ((i & 63) == 0 && run.cancelled()) return;
        const std::uint32_t vertex = clusters.middle[i];
        const glm::vec3& n = mesh.normals[vertex];
        const glm::vec3 from(mesh.positions[vertex] - center + lift * Vec3(n));
        glm::vec3 t, b;
        frame_of(n, t, b);
        const auto rays = static_cast<std::uint64_t>(options.rays);
        float sum = 0;
        for (std::uint64_t k = 0; k < rays; ++k) {
          const glm::vec3 d = direction(options.seed + i * rays + k);
          sum += obstacles.distance(from, d.x * t + d.y * b + d.z * n, length);
        }
        seen[i] = std::clamp(sum / (length * static_cast<float>(options.rays)), 0.0f, 1.0f);
      }
      progress.add(step * static_cast<double>(range.size()));
    });
    if (run.cancelled()) return;
    const ClusterGraph graph(clusters);
    for (int i = 0; i < kSmoothings && !run.cancelled(); ++i) smooth(graph, seen);
    if (!run.cancelled()) open = spread(mesh, clusters, graph, seen);
  });
  if (run.cancelled()) return std::nullopt;
  progress.finish();
  return open;
}

}  // namespace cambium
