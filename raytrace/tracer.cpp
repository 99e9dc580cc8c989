#include "raytrace/tracer.h"

#if CAMBIUM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace cambium {
namespace {

constexpr float kFloatMax = std::numeric_limits<float>::max();

float below(double v) { return std::nextafter(static_cast<float>(v), -kFloatMax); }
float above(double v) { return std::nextafter(static_cast<float>(v), kFloatMax); }

#if CAMBIUM_EMBREE_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

/// What one ray carries through Embree: itself in double, the scratch of its thread, and the best hit so far.
struct Query {
  Context context;  // first, so that Embree's pointer to it is a pointer to this
  const Ray* ray = nullptr;
  Evaluator* evaluator = nullptr;
  double entry = 0;  // Embree's t = 0
  RaySegment segment;
  SurfaceHit hit;
  bool found = false;
};

void init(Query& query) {
#if CAMBIUM_EMBREE_MAJOR >= 4
  rtcInitRayQueryContext(&query.context);
#else
  rtcInitIntersectContext(&query.context);
#endif
}

}  // namespace

struct Tracer::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const SurfaceCover& cells;
  Vec3 center{0.0};   // float coordinates are relative to this
  double pad = 0;     // covers what a ray loses by being rounded to float

  Scene(const SurfaceCover& cover, const Box& bounds) : cells(cover) {
    center = bounds.center();
    pad = 2e-6 * glm::length(bounds.size());
    device = rtcNewDevice(nullptr);
    if (!device) throw std::runtime_error("Embree could not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(cells.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds_of_cell, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_cell);
    rtcSetGeometryOccludedFunction(geometry, occluded_cell);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE) {
      release();
      throw std::runtime_error("Embree could not build its hierarchy (error " + std::to_string(error) + ")");
    }
  }
  ~Scene() { release(); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void release() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
    scene = nullptr;
    device = nullptr;
  }

  static void bounds_of_cell(const RTCBoundsFunctionArguments* args) {
    const Scene& self = *static_cast<const Scene*>(args->geometryUserPtr);
    const Box box = self.cells.box(args->primID);
    const Vec3 lo = box.lo - self.center - self.pad, hi = box.hi - self.center + self.pad;
    RTCBounds& out = *args->bounds_o;
    out.lower_x = below(lo.x), out.lower_y = below(lo.y), out.lower_z = below(lo.z);
    out.upper_x = above(hi.x), out.upper_y = above(hi.y), out.upper_z = above(hi.z);
  }

  /// Improves query.hit by one cell.
  static bool solve(const Scene& self, Query& query, unsigned cell) {
    const PrunedField field = self.cells.field(cell);
    const auto part = clip(*query.ray, field.box(), query.segment);
    if (!part) return false;
    const auto t = first_root(*query.evaluator, field, *query.ray, *part);
    if (!t) return false;
    // Two cells that touch can find the same point; the lower index wins, so traversal order does not show.
    if (query.found && *t == query.hit.t && cell > query.hit.cell) return false;
    query.hit = {*t, cell};
    query.found = true;
    query.segment.end = *t;
    return true;
  }

  static void intersect_cell(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    Query& query = *reinterpret_cast<Query*>(args->context);
    if (!solve(*static_cast<const Scene*>(args->geometryUserPtr), query, args->primID)) return;
    RTCRayHit& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    const Scene& self = *static_cast<const Scene*>(args->geometryUserPtr);
    rayhit.ray.tfar = std::min(rayhit.ray.tfar, above(query.hit.t - query.entry + self.pad));
    rayhit.hit.primID = args->primID;
    rayhit.hit.geomID = args->geomID;
  }

  static void occluded_cell(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    Query& query = *reinterpret_cast<Query*>(args->context);
    if (!solve(*static_cast<const Scene*>(args->geometryUserPtr), query, args->primID)) return;
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -std::numeric_limits<float>::infinity();
  }

  /// Embree's ray from where it enters the padded bounds. False if it passes them.
  bool prepare(const Ray& ray, const Box& bounds, double t_end, Evaluator& evaluator, Query& query, RTCRay& out) const {
    const auto inside = clip(ray, bounds, {0, t_end});
    if (!inside) return false;
    init(query);
    query.ray = &ray;
    query.evaluator = &evaluator;
    query.entry = std::max(0.0, inside->begin - pad);
    query.segment = *inside;
    const Vec3 origin = ray.at(query.entry) - center;
    out.org_x = static_cast<float>(origin.x), out.org_y = static_cast<float>(origin.y), out.org_z = static_cast<float>(origin.z);
    out.dir_x = static_cast<float>(ray.direction.x);
    out.dir_y = static_cast<float>(ray.direction.y);
    out.dir_z = static_cast<float>(ray.direction.z);
    out.tnear = 0;
    out.tfar = above(inside->end - query.entry + pad);
    out.mask = ~0u;
    out.flags = 0;
    out.time = 0;
    out.id = 0;
    return true;
  }
};

Tracer::Tracer(SurfaceCover cover) : cover_(std::move(cover)) {
  for (std::size_t cell = 0; cell < cover_.size(); ++cell) bounds_.extend(cover_.box(cell));
  if (!cover_.empty()) scene_ = std::make_unique<Scene>(cover_, bounds_);
}

Tracer::~Tracer() = default;

std::optional<SurfaceHit> Tracer::intersect(Evaluator& evaluator, const Ray& ray) const {
  Query query;
  RTCRayHit rayhit;
  if (!scene_ || !scene_->prepare(ray, bounds_, kInfinity, evaluator, query, rayhit.ray)) return std::nullopt;
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.primID = RTC_INVALID_GEOMETRY_ID;
#if CAMBIUM_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  rtcIntersect1(scene_->scene, &rayhit, &arguments);
#else
  rtcIntersect1(scene_->scene, &query.context, &rayhit);
#endif
  if (!query.found) return std::nullopt;
  return query.hit;
}

bool Tracer::occluded(Evaluator& evaluator, const Ray& ray, double t_end) const {
  Query query;
  RTCRay embree_ray;
  if (!scene_ || !scene_->prepare(ray, bounds_, t_end, evaluator, query, embree_ray)) return false;
#if CAMBIUM_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  rtcOccluded1(scene_->scene, &embree_ray, &arguments);
#else
  rtcOccluded1(scene_->scene, &query.context, &embree_ray);
#endif
  return query.found;
}

}  // namespace cambium
