#include "raytrace/tracer.h"

#include "raytrace/chain_cells.h"

#if CAMBIUM_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace cambium {
namespace {

constexpr std::size_t kMostCells = 4000000;   // beyond, the hierarchy would take more memory than it saves time
constexpr double kCellRadii = 5;              // half of this is as fast, and takes three times the memory
constexpr double kDeep = 1e-3;                // of f: far more than a root may be off
constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::size_t kMostWaiting = 24;
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
  const Ray& ray;
  RayClipper clipper;
  Evaluator& evaluator;
  PlaceWanted wanted;
  double entry = 0;  // Embree's t = 0
  RaySegment segment;
  double t = kInfinity;                  // of the nearest hit
  std::uint32_t cell = kNone;            // the one it is in, unless it is on a segment
  std::uint32_t on_segment = kNone;      // set where that is in closed form
  struct Waiting {                       // plain, so that none is set before it is used
    double begin, end;
    std::uint32_t cell;                  // of ChainCells
  };
  std::array<Waiting, kMostWaiting> waiting;   // the first waiting_count
  std::size_t waiting_count = 0;

  Query(const Ray& of, Evaluator& with, PlaceWanted what) : ray(of), clipper(of), evaluator(with), wanted(what) {
#if CAMBIUM_EMBREE_MAJOR >= 4
    rtcInitRayQueryContext(&context);
#else
    rtcInitIntersectContext(&context);
#endif
  }
  bool found() const { return t < kInfinity; }

  /// Two segments or cells that touch can find the same point; segments win, and the lower one does, so traversal order does not show.
  bool take(double at, std::uint32_t segment_number, std::uint32_t in_cell) {
    if (at > t || (at == t && std::pair(segment_number, in_cell) >= std::pair(on_segment, cell))) return false;
    t = at;
    on_segment = segment_number;
    cell = in_cell;
    return true;
  }
};

void set_bounds(RTCBounds& out, const Box& box) {
  out.lower_x = below(box.lo.x), out.lower_y = below(box.lo.y), out.lower_z = below(box.lo.z);
  out.upper_x = above(box.hi.x), out.upper_y = above(box.hi.y), out.upper_z = above(box.hi.z);
}

}  // namespace

struct Tracer::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const SurfaceCover& cover;
  ChainCells chains;
  std::vector<ChainSegments::Piece> pieces;
  const Box& bounds;  // of the cells
  Vec3 center{0.0};   // float coordinates are relative to this
  double pad = 0;     // covers what a ray loses by being rounded to float

  Scene(const SurfaceCover& cells, const Box& of_cells)
      : cover(cells), chains(cells), pieces(chains.segments().wood_pieces()), bounds(of_cells) {
    center = bounds.center();
    pad = 2e-6 * glm::length(bounds.size());
    device = rtcNewDevice(nullptr);
    if (!device) throw std::runtime_error("Embree could not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    attach<WoodKind>(pieces.size());
    attach<ChainKind>(chains.size());
    attach<OtherKind>(chains.others().size());
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

  bool search(Query& query, const PrunedField& field, const RaySegment& part, std::uint32_t cell) const {
    if (query.wanted == PlaceWanted::kAny) {
      return any_inside(query.evaluator, field, query.ray, part) && query.take(part.begin, kNone, cell);
    }
    const auto t = first_root(query.evaluator, field, query.ray, part);
    return t && query.take(*t, kNone, cell);
  }

  /// Where chains blend, roots of the field.
  bool search_chains(Query& query, const RaySegment& part, std::uint32_t k) const {
    const ChainVerdict verdict = chains.judge(k, query.ray, part, query.wanted);
    if (verdict.how == ChainVerdict::How::kMiss) return false;
    if (verdict.how == ChainVerdict::How::kHit) return query.take(verdict.t, verdict.segment, kNone);
    const std::uint32_t cell = chains.cell(k);
    return (verdict.part.begin <= query.t && search(query, cover.field(cell), verdict.part, cell)) ||
           (verdict.t < kInfinity && query.take(verdict.t, verdict.segment, kNone));
  }

  /// The nearest first, and only what lies before the nearest hit.
  void search_waiting(Query& query) const {
    if (query.wanted == PlaceWanted::kAny && query.found()) return;
    const auto end = query.waiting.begin() + static_cast<std::ptrdiff_t>(query.waiting_count);
    std::sort(query.waiting.begin(), end, [](const auto& a, const auto& b) { return a.begin < b.begin; });
    for (auto it = query.waiting.begin(); it != end && it->begin <= query.t; ++it)
      if (search_chains(query, {it->begin, it->end}, it->cell) && query.wanted == PlaceWanted::kAny) return;
  }

  /// Chains where nothing is taken away from them, in closed form.
  struct WoodKind {
    static Box bounds(const Scene& self, unsigned k) { return self.chains.segments().box(self.pieces[k]); }
    static bool solve(const Scene& self, Query& query, unsigned k) {
      const std::uint32_t segment = self.pieces[k].segment;
      const auto t = self.chains.segments().meet(segment, query.ray, query.segment);
      return t && query.take(*t, segment, kNone);
    }
  };
  /// Cells with chains only. What they may hold before the wood has to be searched for: they wait until the wood is met.
  struct ChainKind {
    static Box bounds(const Scene& self, unsigned k) { return self.chains.box(k); }
    static bool solve(const Scene& self, Query& query, unsigned k) {
      const auto part = query.clipper.clip(self.chains.box(k), query.segment);
      if (!part || part->begin > query.t) return false;
      if (query.waiting_count == kMostWaiting) return self.search_chains(query, *part, k);
      query.waiting[query.waiting_count++] = {part->begin, part->end, k};
      return false;
    }
  };
  /// Cells with anything else: roots of the field.
  struct OtherKind {
    static Box bounds(const Scene& self, unsigned k) { return self.cover.box(self.chains.others()[k]); }
    static bool solve(const Scene& self, Query& query, unsigned k) {
      const std::uint32_t cell = self.chains.others()[k];
      const PrunedField field = self.cover.field(cell);
      const auto part = query.clipper.clip(field.box(), query.segment);
      if (!part || part->begin > query.t) return false;
      return self.search(query, field, *part, cell);
    }
  };

  template <class Kind>
  void attach(std::size_t count) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds_of<Kind>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_one<Kind>);
    rtcSetGeometryOccludedFunction(geometry, occluded_by<Kind>);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  template <class Kind>
  static void bounds_of(const RTCBoundsFunctionArguments* args) {
    const Scene& self = *static_cast<const Scene*>(args->geometryUserPtr);
    const Box box = Kind::bounds(self, args->primID);
    set_bounds(*args->bounds_o, {box.lo - self.center - self.pad, box.hi - self.center + self.pad});
  }

  template <class Kind>
  static void intersect_one(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    Query& query = *reinterpret_cast<Query*>(args->context);
    const Scene& self = *static_cast<const Scene*>(args->geometryUserPtr);
    if (!Kind::solve(self, query, args->primID)) return;
    RTCRayHit& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    rayhit.ray.tfar = std::min(rayhit.ray.tfar, above(query.t - query.entry + self.pad));
    rayhit.hit.primID = args->primID;
    rayhit.hit.geomID = args->geomID;
  }

  template <class Kind>
  static void occluded_by(const RTCOccludedFunctionNArguments* args) {
    if (!args->valid[0]) return;
    Query& query = *reinterpret_cast<Query*>(args->context);
    if (!Kind::solve(*static_cast<const Scene*>(args->geometryUserPtr), query, args->primID)) return;
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -std::numeric_limits<float>::infinity();
  }

  /// Embree's ray from where it enters the padded bounds. False if it passes them.
  bool prepare(double t_end, Query& query, RTCRay& out) const {
    const Ray& ray = query.ray;
    const auto inside = query.clipper.clip(bounds, {0, t_end});
    if (!inside) return false;
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

  /// The cell that holds a point of a segment's surface, which may be off by a rounding. None where that is deep in the wood.
  std::optional<std::uint32_t> cell_at(const Vec3& p, double radius) const {
    if (const auto cell = cover.find(p)) return static_cast<std::uint32_t>(*cell);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 aside{corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1};
      if (const auto cell = cover.find(p + 1e-6 * radius * aside)) return static_cast<std::uint32_t>(*cell);
    }
    return std::nullopt;
  }

  /// Deep inside there are no cells: a ray that begins where none is, and comes first to a place that is deep too, has been inside
  /// from the start.
  bool began_inside(const Query& query, const SurfaceHit& hit) const {
    if (query.t == 0 || !bounds.contains(query.ray.origin) || cover.find(query.ray.origin)) return false;
    const Vec3 p = query.ray.at(query.t);
    const std::optional<std::uint32_t> cell = hit.analytic ? cell_at(p, hit.radius) : hit.found_in;
    if (!cell) return true;
    const PrunedField field = cover.field(*cell);
    return query.evaluator.value(field, glm::clamp(p, field.box().lo, field.box().hi)) > kIso + kDeep;
  }

  SurfaceHit hit_of(const Query& query) const {
    const Vec3 p = query.ray.at(query.t);
    SurfaceHit hit;
    hit.t = query.t;
    hit.analytic = query.on_segment != kNone;
    if (hit.analytic) {
      hit.found_in = query.on_segment;
      hit.normal = chains.segments().normal(query.on_segment, p);
      hit.radius = chains.segments().radius(query.on_segment, p);
    } else {
      const PrunedField field = cover.field(query.cell);
      const Vec3 gradient = query.evaluator.sample(field, glm::clamp(p, field.box().lo, field.box().hi)).gradient;
      const double steepness = glm::length(gradient);
      hit.found_in = query.cell;
      hit.normal = steepness > 0 ? -gradient / steepness : -query.ray.direction;
      hit.radius = radius_in(field);
    }
    if (began_inside(query, hit)) hit.t = 0;
    return hit;
  }
};

CoverOptions tracing_cells() {
  CoverOptions cells;
  cells.max_cells = kMostCells;
  cells.cell_radii = kCellRadii;
  return cells;
}

Tracer::Tracer(SurfaceCover cover) : cover_(std::move(cover)) {
  for (std::size_t cell = 0; cell < cover_.size(); ++cell) bounds_.extend(cover_.box(cell));
  if (!cover_.empty()) scene_ = std::make_unique<Scene>(cover_, bounds_);
}

Tracer::~Tracer() = default;

std::optional<SurfaceHit> Tracer::intersect(Evaluator& evaluator, const Ray& ray) const {
  Query query(ray, evaluator, PlaceWanted::kFirst);
  RTCRayHit rayhit;
  if (!scene_ || !scene_->prepare(kInfinity, query, rayhit.ray)) return std::nullopt;
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
  scene_->search_waiting(query);
  if (!query.found()) return std::nullopt;
  return scene_->hit_of(query);
}

std::uint32_t Tracer::cell(const Ray& ray, const SurfaceHit& hit) const {
  if (!hit.analytic) return hit.found_in;
  return scene_->cell_at(ray.at(hit.t), hit.radius).value_or(scene_->chains.segments()[hit.found_in].cell);
}

bool Tracer::occluded(Evaluator& evaluator, const Ray& ray, double t_end) const {
  Query query(ray, evaluator, PlaceWanted::kAny);
  RTCRay embree_ray;
  if (!scene_ || !scene_->prepare(t_end, query, embree_ray)) return false;
#if CAMBIUM_EMBREE_MAJOR >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  rtcOccluded1(scene_->scene, &embree_ray, &arguments);
#else
  rtcOccluded1(scene_->scene, &query.context, &embree_ray);
#endif
  scene_->search_waiting(query);
  return query.found();
}

}  // namespace cambium
