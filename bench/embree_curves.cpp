#include "bench/embree_curves.h"

#if CAMBIUM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <limits>
#include <stdexcept>
#include <vector>

namespace cambium::bench {
namespace {

/// Of each node the child that goes on its axis: the thickest.
std::vector<std::size_t> next_on_axis(const Skeleton& skeleton) {
  std::vector<std::size_t> next(skeleton.nodes.size(), 0);   // 0 is a root: nobody's child
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    if (skeleton.nodes[i].parent < 0) continue;
    std::size_t& best = next[static_cast<std::size_t>(skeleton.nodes[i].parent)];
    if (best == 0 || skeleton.nodes[i].radius > skeleton.nodes[best].radius) best = i;
  }
  return next;
}

RTCRay embree_ray(const Ray& ray) {
  RTCRay out{};
  out.org_x = static_cast<float>(ray.origin.x), out.org_y = static_cast<float>(ray.origin.y), out.org_z = static_cast<float>(ray.origin.z);
  out.dir_x = static_cast<float>(ray.direction.x);
  out.dir_y = static_cast<float>(ray.direction.y);
  out.dir_z = static_cast<float>(ray.direction.z);
  out.tfar = std::numeric_limits<float>::infinity();
  out.mask = ~0u;
  return out;
}

}  // namespace

struct EmbreeCurves::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::atomic<std::ptrdiff_t> bytes{0};

  static bool count_bytes(void* self, ssize_t bytes, bool) {
    static_cast<Scene*>(self)->bytes += bytes;
    return true;
  }
  ~Scene() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

EmbreeCurves::EmbreeCurves(const Skeleton& skeleton) : scene_(std::make_unique<Scene>()) {
  Scene& s = *scene_;
  s.device = rtcNewDevice(nullptr);
  if (!s.device) throw std::runtime_error("Embree could not start");
  rtcSetDeviceMemoryMonitorFunction(s.device, Scene::count_bytes, &s);
  s.scene = rtcNewScene(s.device);
  RTCGeometry geometry = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  const std::size_t segments = skeleton.nodes.size() - 1;
  auto* vertex = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 2 * segments));
  auto* index = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(unsigned), segments));
  const std::vector<std::size_t> next = next_on_axis(skeleton);
  unsigned segment = 0;
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    const SkeletonNode& node = skeleton.nodes[i];
    if (node.parent < 0) continue;
    const SkeletonNode& parent = skeleton.nodes[static_cast<std::size_t>(node.parent)];
    const bool on_axis = next[static_cast<std::size_t>(node.parent)] == i;   // a lateral begins as thick as it goes on
    const auto put = [&](const Vec3& position, double radius) {
      for (int a = 0; a < 3; ++a) *vertex++ = static_cast<float>(position[a]);
      *vertex++ = static_cast<float>(radius);
    };
    put(parent.position, on_axis ? parent.radius : node.radius);
    put(node.position, node.radius);
    *index++ = 2 * segment++;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(s.scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(s.scene);
  if (rtcGetDeviceError(s.device) != RTC_ERROR_NONE) throw std::runtime_error("Embree could not build its hierarchy");
}

EmbreeCurves::~EmbreeCurves() = default;

std::optional<EmbreeCurves::Hit> EmbreeCurves::intersect(const Ray& ray) const {
  RTCRayHit rayhit{};
  rayhit.ray = embree_ray(ray);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if CAMBIUM_EMBREE_MAJOR >= 4
  rtcIntersect1(scene_->scene, &rayhit, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &rayhit);
#endif
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{rayhit.ray.tfar, glm::normalize(Vec3(rayhit.hit.Ng_x, rayhit.hit.Ng_y, rayhit.hit.Ng_z))};
}

bool EmbreeCurves::occluded(const Ray& ray) const {
  RTCRay out = embree_ray(ray);
#if CAMBIUM_EMBREE_MAJOR >= 4
  rtcOccluded1(scene_->scene, &out, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene_->scene, &context, &out);
#endif
  return out.tfar < 0;
}

std::size_t EmbreeCurves::memory_bytes() const { return static_cast<std::size_t>(scene_->bytes.load()); }

}  // namespace cambium::bench
