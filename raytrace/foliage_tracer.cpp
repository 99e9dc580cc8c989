#include "raytrace/foliage_tracer.h"

#include "blobtree/input_error.h"

#if CAMBIUM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace cambium {
namespace {

#if CAMBIUM_EMBREE_MAJOR >= 4
using Context = RTCRayQueryContext;
#else
using Context = RTCIntersectContext;
#endif

constexpr std::size_t kBetweenPolls = 1024;   // instances
constexpr double kFloatLoss = 1e-6;   // of the foliage's extent: what a place may be off once it has been through Embree

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// Carries the best hit so far, for places where several triangles lie at the same distance.
struct Query {
  Context context;  // first, so that Embree's pointer to it is a pointer to this
  float t = std::numeric_limits<float>::infinity();
  std::pair<unsigned, unsigned> best{~0u, ~0u};

  Query() {
#if CAMBIUM_EMBREE_MAJOR >= 4
    rtcInitRayQueryContext(&context);
#else
    rtcInitIntersectContext(&context);
#endif
  }
};

void require(bool good, const std::string& found, const std::string& expected) {
  if (!good) throw InputError({}, found, expected);
}

void check(const FoliageMaterial& material) {
  const auto share = [](double value) { return value >= 0 && value <= 1; };
  require(share(material.color.x) && share(material.color.y) && share(material.color.z), "a leaf's colour out of range", "0 to 1");
  require(share(material.translucency), "a translucency of " + std::to_string(material.translucency), "0 to 1");
  require(share(material.roughness), "a roughness of " + std::to_string(material.roughness), "0 to 1");
}

void check(const Sheet& sheet) {
  const std::size_t vertices = sheet.positions.size();
  require(sheet.normals.size() == vertices && sheet.uvs.size() == vertices, "a leaf whose vertices are incomplete",
          "a normal and texture coordinates for each");
  for (const auto& triangle : sheet.triangles)
    for (const std::uint32_t corner : triangle)
      require(corner < vertices, "a triangle of vertex " + std::to_string(corner), "one of " + std::to_string(vertices));
}

void check(const FoliageScene& scene) {
  const auto require_item = [](std::uint32_t index, std::size_t count, const char* what) {
    require(index < count, what + (" " + std::to_string(index)), "one of " + std::to_string(count));
  };
  for (const FoliageMaterial& material : scene.materials) check(material);
  for (const FoliageShape& shape : scene.shapes) {
    require_item(shape.material, scene.materials.size(), "a leaf of material");
    check(shape.sheet);
  }
  for (const FoliageInstance& instance : scene.instances) require_item(instance.shape, scene.shapes.size(), "a leaf of shape");
}

using Corners = std::array<Vec3, 3>;

Corners corners_of(const FoliageScene& scene, std::uint32_t instance, std::uint32_t triangle) {
  const FoliageInstance& placed = scene.instances[instance];
  const Sheet& sheet = scene.shapes[placed.shape].sheet;
  Corners corners;
  for (int c = 0; c < 3; ++c) corners[c] = placed.position + placed.axes * Vec3(sheet.positions[sheet.triangles[triangle][c]]);
  return corners;
}

glm::dvec2 uv_at(const Sheet& sheet, std::uint32_t triangle, double u, double v) {
  const auto& [a, b, c] = sheet.triangles[triangle];
  return (1 - u - v) * glm::dvec2(sheet.uvs[a]) + u * glm::dvec2(sheet.uvs[b]) + v * glm::dvec2(sheet.uvs[c]);
}

}  // namespace

struct FoliageTracer::Embree {
  struct Shape {
    const FoliageShape* shape;
    const FoliageTexture* cut_out;   ///< null: nothing is cut away
    Owned<RTCScene> scene;
  };

  const Box& bounds;
  Vec3 center;        // float coordinates are relative to this
  double pad;
  Owned<RTCDevice> device;
  std::vector<Shape> shapes;
  Owned<RTCScene> top;

  Embree(const FoliageScene& foliage, const Box& of, const RunOptions& run)
      : bounds(of), center(of.center()), pad(kFloatLoss * glm::length(of.size())), device(rtcNewDevice(nullptr)) {
    if (!device) throw std::runtime_error("Embree could not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    shapes.reserve(foliage.shapes.size());   // Embree keeps pointers to them
    for (const FoliageShape& shape : foliage.shapes) {
      const FoliageTexture* texture = foliage.materials[shape.material].texture.get();
      shapes.push_back({&shape, texture && texture->cut_out() ? texture : nullptr, nullptr});
      build(shapes.back());
    }
    top.reset(rtcNewScene(device.get()));
    for (std::size_t i = 0; i < foliage.instances.size(); ++i) {
      if (i % kBetweenPolls == 0 && run.cancelled()) return;
      attach(foliage.instances[i], static_cast<unsigned>(i));
    }
    const auto go_on = [](void* options, double) { return !static_cast<const RunOptions*>(options)->cancelled(); };
    rtcSetSceneProgressMonitorFunction(top.get(), go_on, const_cast<RunOptions*>(&run));
    rtcCommitScene(top.get());
    rtcSetSceneProgressMonitorFunction(top.get(), nullptr, nullptr);
    if (run.cancelled()) return;
    if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree could not build its hierarchy of leaves (error " + std::to_string(error) + ")");
  }

  void build(Shape& shape) {
    const Sheet& sheet = shape.shape->sheet;
    shape.scene.reset(rtcNewScene(device.get()));
    rtcSetSceneFlags(shape.scene.get(), RTC_SCENE_FLAG_ROBUST);
    if (!sheet.triangles.empty()) add_triangles(shape, sheet);
    rtcCommitScene(shape.scene.get());
  }

  void add_triangles(Shape& shape, const Sheet& sheet) {
    const Owned<RTCGeometry> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    const auto buffer = [&](RTCBufferType type, RTCFormat format, std::size_t stride, std::size_t count) {
      return rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, stride, count);
    };
    // Copied, since Embree reads four bytes beyond the last position.
    void* const positions = buffer(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), sheet.positions.size());
    void* const triangles = buffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), sheet.triangles.size());
    if (!positions || !triangles) throw std::bad_alloc();
    std::copy(sheet.positions.begin(), sheet.positions.end(), static_cast<glm::vec3*>(positions));
    std::copy(sheet.triangles.begin(), sheet.triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(triangles));
    rtcSetGeometryUserData(geometry.get(), &shape);
    rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_nearest);
    if (shape.cut_out) rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_cut_out);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(shape.scene.get(), geometry.get());
  }

  void attach(const FoliageInstance& instance, unsigned id) {
    const Owned<RTCGeometry> geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), shapes[instance.shape].scene.get());
    const Vec3 position = instance.position - center;
    const glm::mat4x3 transform(glm::vec3(instance.axes[0]), glm::vec3(instance.axes[1]), glm::vec3(instance.axes[2]),
                                glm::vec3(position));
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &transform[0][0]);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(top.get(), geometry.get(), id);
  }

  static bool is_leaf(const Shape& shape, const RTCHit& hit) {
    if (!shape.cut_out) return true;
    const glm::dvec2 uv = uv_at(shape.shape->sheet, hit.primID, hit.u, hit.v);
    return shape.cut_out->leaf_at(uv.x, uv.y);
  }

  static void filter_cut_out(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const Shape& shape = *static_cast<const Shape*>(args->geometryUserPtr);
    if (!is_leaf(shape, *reinterpret_cast<const RTCHit*>(args->hit))) args->valid[0] = 0;
  }

  /// Also decides between triangles at one distance, so that it does not show in which order Embree comes to them.
  static void filter_nearest(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    Query& query = *reinterpret_cast<Query*>(args->context);
    const Shape& shape = *static_cast<const Shape*>(args->geometryUserPtr);
    const RTCHit& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const float t = reinterpret_cast<const RTCRay*>(args->ray)->tfar;
    const std::pair<unsigned, unsigned> found{hit.instID[0], hit.primID};
    if ((t == query.t && found >= query.best) || !is_leaf(shape, hit)) {
      args->valid[0] = 0;
      return;
    }
    query.t = t;
    query.best = found;
  }

  /// Embree's ray from where it enters the bounds, and how far along that is. nullopt if it passes them.
  std::optional<double> prepare(const Ray& ray, double t_end, RTCRay& out) const {
    const auto inside = clip(ray, bounds.padded(pad), {0, t_end});
    if (!inside) return std::nullopt;
    const double entry = inside->begin;
    const Vec3 origin = ray.at(entry) - center;
    out.org_x = static_cast<float>(origin.x), out.org_y = static_cast<float>(origin.y), out.org_z = static_cast<float>(origin.z);
    out.dir_x = static_cast<float>(ray.direction.x);
    out.dir_y = static_cast<float>(ray.direction.y);
    out.dir_z = static_cast<float>(ray.direction.z);
    out.tnear = 0;
    out.tfar = static_cast<float>(inside->end - entry);
    out.mask = ~0u;
    out.flags = 0;
    out.time = 0;
    out.id = 0;
    return entry;
  }
};

FoliageTracer::FoliageTracer(FoliageScene scene, const RunOptions& run) : scene_(std::move(scene)) {
  check(scene_);
  for (const Box& box : boxes()) bounds_.extend(box);
  lift_ = 2 * kFloatLoss * glm::length(bounds_.empty() ? Vec3(0.0) : bounds_.size());
  if (bounds_.empty()) return;
  embree_ = std::make_unique<Embree>(scene_, bounds_, run);
  if (run.cancelled()) embree_.reset();
}

FoliageTracer::~FoliageTracer() = default;

std::vector<Box> FoliageTracer::boxes() const {
  std::vector<Box> own(scene_.shapes.size()), placed(scene_.instances.size());
  for (std::size_t i = 0; i < own.size(); ++i)
    for (const glm::vec3& p : scene_.shapes[i].sheet.positions) own[i].extend(Vec3(p));
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const FoliageInstance& instance = scene_.instances[i];
    const Box& box = own[instance.shape];
    if (box.empty()) continue;
    const Vec3 middle = instance.position + instance.axes * box.center(), half = 0.5 * box.size();
    const Vec3 reach = glm::abs(instance.axes[0]) * half.x + glm::abs(instance.axes[1]) * half.y + glm::abs(instance.axes[2]) * half.z;
    placed[i] = {middle - reach, middle + reach};
  }
  return placed;
}

std::optional<FoliageHit> FoliageTracer::intersect(const Ray& ray, double t_end) const {
  RTCRayHit rayhit;
  const auto entry = embree_ ? embree_->prepare(ray, t_end, rayhit.ray) : std::nullopt;
  if (!entry) return std::nullopt;
  rayhit.ray.tfar += static_cast<float>(embree_->pad);   // what is found is held against t_end in double
  Query query;
  rayhit.hit.geomID = rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if CAMBIUM_EMBREE_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  rtcIntersect1(embree_->top.get(), &rayhit, &arguments);
#else
  rtcIntersect1(embree_->top.get(), &query.context, &rayhit);
#endif
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  FoliageHit hit{*entry + rayhit.ray.tfar, rayhit.hit.instID[0], rayhit.hit.primID, rayhit.hit.u, rayhit.hit.v};
  // The plane's own place in double; edge on, Embree's has to do.
  const Corners p = corners_of(scene_, hit.instance, hit.triangle);
  const Vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double t = glm::dot(p[0] - ray.origin, across) / glm::dot(ray.direction, across);
  if (std::abs(t - hit.t) <= lift_) hit.t = std::max(0.0, t);
  if (!(hit.t < t_end)) return std::nullopt;
  return hit;
}

bool FoliageTracer::occluded(const Ray& ray, double t_end) const {
  RTCRay embree_ray;
  if (!embree_ || !embree_->prepare(ray, t_end, embree_ray)) return false;
  Query query;
#if CAMBIUM_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  rtcOccluded1(embree_->top.get(), &embree_ray, &arguments);
#else
  rtcOccluded1(embree_->top.get(), &query.context, &embree_ray);
#endif
  return embree_ray.tfar < 0;
}

FoliageLook FoliageTracer::look(const Ray& ray, const FoliageHit& hit, double footprint) const {
  const FoliageInstance& instance = scene_.instances[hit.instance];
  const FoliageShape& shape = scene_.shapes[instance.shape];
  const Sheet& sheet = shape.sheet;
  const auto& [a, b, c] = sheet.triangles[hit.triangle];
  const Corners p = corners_of(scene_, hit.instance, hit.triangle);
  const Vec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double area = glm::length(across);

  FoliageLook look;
  look.position = ray.at(hit.t);
  look.normal = area > 0 ? across / area : -ray.direction;
  // Normals turn with the inverse's transpose; the instances' axes are square to each other, so the axes will do.
  const Vec3 smooth = instance.axes * ((1 - hit.u - hit.v) * Vec3(sheet.normals[a]) + hit.u * Vec3(sheet.normals[b]) + hit.v * Vec3(sheet.normals[c]));
  look.shading_normal = glm::dot(smooth, smooth) > 0 ? glm::normalize(smooth) : look.normal;
  if (glm::dot(look.normal, ray.direction) > 0) look.normal = -look.normal;
  if (glm::dot(look.shading_normal, look.normal) < 0) look.shading_normal = -look.shading_normal;
  look.uv = uv_at(sheet, hit.triangle, hit.u, hit.v);
  look.material = &scene_.materials[shape.material];
  look.branch = instance.branch;
  look.color = look.material->color;
  if (look.material->texture) {
    const glm::dvec2 s = sheet.uvs[b] - sheet.uvs[a], t = sheet.uvs[c] - sheet.uvs[a];
    const double repeats = area > 0 ? std::sqrt(std::abs(s.x * t.y - s.y * t.x) / area) : 0;   // to the metre
    look.color *= look.material->texture->color(look.uv.x, look.uv.y, repeats * footprint);
  }
  look.color = glm::clamp(look.color, 0.0, 1.0);
  return look;
}

}  // namespace cambium
