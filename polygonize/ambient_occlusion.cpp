#include "polygonize/ambient_occlusion.h"

#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "polygonize/lattice.h"

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
#include <stdexcept>
#include <string>

namespace cambium {
namespace {

#if CAMBIUM_EMBREE_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray); }
#else
void intersect(RTCScene scene, RTCRayHit& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}
#endif

/// The mesh in Embree, in floats about its centre.
class Obstacles {
 public:
  Obstacles(const Mesh& mesh, const Vec3& center, const RunOptions& run) : run_(run) {
    device_ = rtcNewDevice(nullptr);
    if (!device_) throw std::runtime_error("Embree could not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);       // what a ray hits then does not depend on how the hierarchy was built
    rtcSetSceneProgressMonitorFunction(scene_, go_on, this);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                       3 * sizeof(float), mesh.positions.size()));
    auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (vertices && indices) {
      for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int a = 0; a < 3; ++a) vertices[3 * i + a] = static_cast<float>(mesh.positions[i][a] - center[a]);
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) std::copy_n(mesh.triangles[i].data(), 3, indices + 3 * i);
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

/// The mean over each vertex and its neighbours. In a closed mesh every edge runs once each way, so each neighbour counts once.
void smooth_over_edges(const Mesh& mesh, std::vector<float>& values) {
  std::vector<float> sums = values;
  std::vector<std::uint32_t> counts(values.size(), 1);
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      sums[t[c]] += values[t[(c + 1) % 3]];
      ++counts[t[c]];
    }
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = sums[i] / static_cast<float>(counts[i]);
}

}  // namespace

std::optional<std::vector<float>> ambient_occlusion(const Mesh& mesh, const OcclusionOptions& options, const RunOptions& run) {
  if (options.rays < 1 || options.rays > 4096)
    throw InputError({}, std::to_string(options.rays) + " rays of occlusion", "1 to 4096");
  if (options.reach) require_length(*options.reach, "reach of occlusion");
  if (mesh.normals.size() != mesh.positions.size()) throw std::invalid_argument("occlusion of a mesh without normals");
  std::vector<float> open(mesh.positions.size(), 1.0f);
  if (mesh.triangles.empty()) return open;
  Box bounds;
  for (const Vec3& p : mesh.positions) bounds.extend(p);
  const Vec3 size = bounds.size(), center = bounds.center();
  const double reach = options.reach.value_or(0.1 * std::max({size.x, size.y, size.z}));
  const double lift = 1e-3 * reach + 4e-7 * glm::length(size);   // off the surface, beyond what floats lose

  ProgressMeter progress(run, "occlusion");
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    const Obstacles obstacles(mesh, center, run);
    if (run.cancelled()) return;
    const auto length = static_cast<float>(reach);
    const double step = 1.0 / static_cast<double>(open.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, open.size(), 1024), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        if ((i & 63) == 0 && run.cancelled()) return;
        const glm::vec3& n = mesh.normals[i];
        const glm::vec3 from(mesh.positions[i] - center + lift * Vec3(n));
        glm::vec3 t, b;
        frame_of(n, t, b);
        const auto rays = static_cast<std::uint64_t>(options.rays);
        float seen = 0;
        for (std::uint64_t k = 0; k < rays; ++k) {
          const glm::vec3 d = direction(options.seed + i * rays + k);
          seen += obstacles.distance(from, d.x * t + d.y * b + d.z * n, length);
        }
        open[i] = std::clamp(seen / (length * static_cast<float>(options.rays)), 0.0f, 1.0f);
      }
      progress.add(step * static_cast<double>(range.size()));
    });
  });
  if (run.cancelled()) return std::nullopt;
  constexpr int kSmoothings = 2;
  for (int i = 0; i < kSmoothings; ++i) smooth_over_edges(mesh, open);
  progress.finish();
  return open;
}

}  // namespace cambium
