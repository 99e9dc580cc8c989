#include "polygonize/edge_collapse.h"

#include "blobtree/input_error.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cambium {
namespace {

using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

// The decimater asks its mesh whether an edge may be collapsed: before it asks what that costs, and once more when its turn has
// come. OpenMesh's own answer makes and names a property each time, which takes longer than all the rest together.
class Halfedges : public OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble> {
 public:
  class Judge {
   public:
    virtual ~Judge() = default;
    virtual bool allows(HalfedgeHandle h) = 0;
  };
  void ask(Judge* judge) { judge_ = judge; }
  bool is_collapse_ok(HalfedgeHandle h) { return judge_->allows(h); }

 private:
  Judge* judge_ = nullptr;
};
using Point = Halfedges::Point;

struct Cancelled {};

constexpr std::size_t kPollEvery = 1 << 12;         // collapses looked at, or faces added: about a millisecond
constexpr double kLengthWeight = 1e-6;              // where quadrics say nothing, short edges go first
constexpr int kMostSpokes = 64;                     // of a vertex that may go

// What is asked of the triangles that a collapse makes. Each bound gives way to what was there before, so that a bad place can
// still be left.
struct ShapeRule {
  double across;      // least cosine between neighbours: a twig of three equal sides has -0.5, a sheet of two sides -1
  double turn;        // least cosine between a triangle and itself before
  double facing;      // least cosine between a triangle and the normals at its corners
  double height;      // least height over the longest side
  bool creases;       // collapse along creases only
};
// The cases that bracket them: three-sided twigs pass `across` in all; 6-sided twigs ten times as long as thick pass `height`; the
// flat end of a twig that is cut shorter passes `facing` from the second on; without any `facing` triangles span the crown's air.
constexpr ShapeRule kRules[] = {{-0.6, 0.3, 0.2, 0.02, true}, {-0.7, 0.2, -0.2, 0.01, true}, {-0.75, 0.1, -0.4, 0.004, false}};

// Over the longest side.
double height_of(const Point& a, const Point& b, const Point& c) {
  return ((b - a) % (c - a)).norm() / std::max({(b - a).sqrnorm(), (c - b).sqrnorm(), (a - c).sqrnorm()});
}

// Quadric errors of the collapses that the rule allows.
class GuardedQuadrics final : public OpenMesh::Decimater::ModQuadricT<Halfedges>, public Halfedges::Judge {
 public:
  using Self = GuardedQuadrics;
  using Handle = OpenMesh::Decimater::ModHandleT<Self>;
  using Quadrics = OpenMesh::Decimater::ModQuadricT<Halfedges>;

  explicit GuardedQuadrics(Halfedges& mesh) : Quadrics(mesh) {}

  void prepare(const std::vector<glm::vec3>& normals, const RunOptions& run, std::vector<std::uint32_t>& into) {
    normals_ = &normals;
    run_ = &run;
    into_ = &into;
    ring_.assign(into.size(), 0);
  }
  void set_rule(const ShapeRule& rule) {
    rule_ = &rule;
    candidate_ = VertexHandle();
  }

  // The edges around a vertex come one after the other, and the best is taken: one that is worse need not be looked at.
  bool allows(HalfedgeHandle h) override {
    if (++looked_at_ % kPollEvery == 0 && run_->cancelled()) throw Cancelled{};
    if (mesh().status(mesh().edge_handle(h)).deleted()) return false;
    const CollapseInfo ci(mesh(), h);
    if (mesh().status(ci.v0).deleted() || mesh().status(ci.v1).deleted()) return false;
    if (ci.v0 != candidate_) begin_candidate(ci.v0);
    const double length2 = (ci.p1 - ci.p0).sqrnorm();
    const float error = std::max(Quadrics::collapse_priority(ci), 0.0f) + static_cast<float>(kLengthWeight * length2 * length2);
    if (!(error <= best_) || !keeps_topology(ci) || !keeps_creases(ci) || !keeps_shape(ci)) return false;
    best_ = error;
    return true;
  }

  float collapse_priority(const CollapseInfo&) override { return best_; }   // always after allows()

  void preprocess_collapse(const CollapseInfo& ci) override {
    crease_left_ = crease(ci.vlv1) || crease(ci.v0vl);
    crease_right_ = crease(ci.v1vr) || crease(ci.vrv0);
    (*into_)[ci.v0.idx()] = static_cast<std::uint32_t>(ci.v1.idx());
  }

  // Two edges have become one on either side, and OpenMesh keeps the status of one of them.
  void postprocess_collapse(const CollapseInfo& ci) override {
    Quadrics::postprocess_collapse(ci);
    mark(ci.v1, ci.vl, crease_left_);
    mark(ci.v1, ci.vr, crease_right_);
    candidate_ = VertexHandle();
  }

 private:
  bool crease(HalfedgeHandle h) const { return mesh().status(mesh().edge_handle(h)).feature(); }
  void mark(VertexHandle a, VertexHandle b, bool is_crease) {
    mesh().status(mesh().edge_handle(mesh().find_halfedge(a, b))).set_feature(is_crease);
  }
  const Halfedges& mesh() const { return const_cast<GuardedQuadrics*>(this)->Quadrics::mesh(); }
  Halfedges& mesh() { return Quadrics::mesh(); }

  void begin_candidate(VertexHandle v) {
    candidate_ = v;
    best_ = std::numeric_limits<float>::max();
    ++stamp_;
    for (const auto neighbour : mesh().vv_range(v)) ring_[static_cast<std::size_t>(neighbour.idx())] = stamp_;
  }

  // The link condition of a closed surface: the two ends have no neighbours in common but the corners of the two triangles.
  bool keeps_topology(const CollapseInfo& ci) {
    if (ci.vl == ci.vr) return false;
    for (const auto v : mesh().vv_range(ci.v1)) {
      if (ring_[static_cast<std::size_t>(v.idx())] == stamp_ && v != ci.vl && v != ci.vr) return false;
    }
    return true;
  }

  // A crease that runs around one triangle may not close up.
  bool keeps_creases(const CollapseInfo& ci) const {
    return !rule_->creases || !((crease(ci.vlv1) && crease(ci.v0vl)) || (crease(ci.v1vr) && crease(ci.vrv0)));
  }

  double facing(const Point& normal, VertexHandle v) const {
    const glm::vec3& n = (*normals_)[static_cast<std::size_t>(v.idx())];
    return normal[0] * n.x + normal[1] * n.y + normal[2] * n.z;
  }

  // Walks the triangles around v0 from the edge to v1 and back to it, and looks at each as it would be with v1 in v0's place.
  bool keeps_shape(const CollapseInfo& ci) const {
    const Halfedges& m = mesh();
    struct Spoke {
      Point before, after;       // normals of the triangle
      Point beyond;              // of the one across its outer edge
      double facing_before, facing_after;
    };
    std::array<Spoke, kMostSpokes> spokes;
    int count = 0;
    // The triangle between this spoke and the next, counter-clockwise; the two at v0v1 vanish.
    HalfedgeHandle spoke = m.opposite_halfedge_handle(m.prev_halfedge_handle(ci.v0v1));   // v0 to vl
    const auto normal_beyond = [&](HalfedgeHandle inner) { return m.normal(m.face_handle(m.opposite_halfedge_handle(inner))); };
    for (; m.to_vertex_handle(spoke) != ci.vr; spoke = m.opposite_halfedge_handle(m.prev_halfedge_handle(spoke))) {
      if (count == kMostSpokes) return false;
      const HalfedgeHandle outer = m.next_halfedge_handle(spoke);
      const VertexHandle a = m.to_vertex_handle(spoke), b = m.to_vertex_handle(outer);
      const Point to_a = m.point(a) - ci.p1, to_b = m.point(b) - ci.p1;
      Point normal = to_a % to_b;
      Spoke& s = spokes[static_cast<std::size_t>(count)];
      s.before = m.normal(m.face_handle(spoke));
      const double height = height_of(ci.p1, m.point(a), m.point(b));
      if (!(height > rule_->height) && !(height > height_of(ci.p0, m.point(a), m.point(b)))) return false;
      normal.normalize();
      if ((normal | s.before) < rule_->turn) return false;
      s.after = normal;
      if (rule_->facing > -1 && !normals_->empty()) {
        s.facing_after = std::min({facing(normal, a), facing(normal, b), facing(normal, ci.v1)});
        s.facing_before = std::min({facing(s.before, a), facing(s.before, b), facing(s.before, ci.v0)});
        if (s.facing_after < std::min(rule_->facing, s.facing_before)) return false;
      }
      s.beyond = normal_beyond(outer);
      ++count;
    }
    if (count == 0) return false;
    // Neighbours: along the fan, across its outer edges, and the two that the vanishing triangles leave beside each other.
    const Point left = normal_beyond(m.next_halfedge_handle(ci.v0v1)), right = normal_beyond(m.prev_halfedge_handle(ci.v1v0));
    const Point gone_left = m.normal(ci.fl), gone_right = m.normal(ci.fr);
    double before = std::min({gone_left | left, gone_right | right, gone_left | gone_right, gone_left | spokes[0].before,
                              gone_right | spokes[static_cast<std::size_t>(count - 1)].before});
    double after = std::min(left | spokes[0].after, right | spokes[static_cast<std::size_t>(count - 1)].after);
    for (int i = 0; i < count; ++i) {
      const Spoke& s = spokes[static_cast<std::size_t>(i)];
      before = std::min(before, s.before | s.beyond);
      after = std::min(after, s.after | s.beyond);
      if (i == 0) continue;
      const Spoke& last = spokes[static_cast<std::size_t>(i - 1)];
      before = std::min(before, last.before | s.before);
      after = std::min(after, last.after | s.after);
    }
    return after >= std::min(rule_->across, before);
  }

  const std::vector<glm::vec3>* normals_ = nullptr;
  const RunOptions* run_ = nullptr;
  std::vector<std::uint32_t>* into_ = nullptr;
  const ShapeRule* rule_ = nullptr;
  std::size_t looked_at_ = 0;
  VertexHandle candidate_;                 // whose edges are being looked at,
  float best_ = 0;                         // the least error of them so far,
  std::vector<std::uint32_t> ring_;        // and by vertex: stamp_ if it is a neighbour of it
  std::uint32_t stamp_ = 0;
  bool crease_left_ = false, crease_right_ = false;
};


// Stops the decimater when asked to, and says how far it is.
class Watch final : public OpenMesh::Decimater::Observer {
 public:
  Watch(const RunOptions& run, std::size_t collapses) : Observer(kPollEvery / 8), run_(run), collapses_(collapses) {}
  void notify(std::size_t step) override {
    if (run_.cancelled()) throw Cancelled{};
    if (run_.progress) run_.progress("decimating", std::min(1.0, static_cast<double>(step) / static_cast<double>(collapses_)));
  }

 private:
  const RunOptions& run_;
  std::size_t collapses_;
};

// Positions are relative to the middle of the mesh: quadrics lose half their digits far from the origin.
void build_halfedges(const Mesh& mesh, Halfedges& out, const RunOptions& run) {
  Box bounds;
  for (const Vec3& p : mesh.positions) bounds.extend(p);
  const Vec3 middle = mesh.positions.empty() ? Vec3(0.0) : 0.5 * (bounds.lo + bounds.hi);
  out.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
  for (const Vec3& p : mesh.positions) out.add_vertex(Point(p.x - middle.x, p.y - middle.y, p.z - middle.z));
  const auto vertex = [](std::uint32_t v) { return VertexHandle(static_cast<int>(v)); };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kPollEvery == 0 && run.cancelled()) throw Cancelled{};
    const auto& t = mesh.triangles[i];
    if (!out.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2])).is_valid())
      throw InputError({}, "a mesh that is no manifold", "a closed one to decimate");
  }
  for (const auto h : out.halfedges())
    if (out.is_boundary(h)) throw InputError({}, "a mesh that is not closed", "a closed one to decimate");
}

// Crease edges, the vertices that they pass through, and those where they end or meet, which stay.
void mark_creases(const Mesh& mesh, const std::vector<bool>& locked, Halfedges& out) {
  std::vector<std::uint8_t> creases(mesh.positions.size(), 0);
  for (const auto& edge : mesh.creases) {
    const HalfedgeHandle h = out.find_halfedge(VertexHandle(static_cast<int>(edge[0])), VertexHandle(static_cast<int>(edge[1])));
    if (!h.is_valid()) continue;
    out.status(out.edge_handle(h)).set_feature(true);
    for (const std::uint32_t v : edge) creases[v] = static_cast<std::uint8_t>(std::min(creases[v] + 1, 3));
  }
  for (std::size_t v = 0; v < creases.size(); ++v) {
    auto& status = out.status(VertexHandle(static_cast<int>(v)));
    status.set_feature(creases[v] > 0);
    status.set_locked(locked[v] || (creases[v] > 0 && creases[v] != 2));
  }
}

void give_up_creases(const std::vector<bool>& locked, Halfedges& out) {
  for (const auto v : out.vertices()) {
    out.status(v).set_feature(false);
    out.status(v).set_locked(locked[static_cast<std::size_t>(v.idx())]);
  }
}

Collapsed take_mesh(const Mesh& mesh, const Halfedges& halfedges, const std::vector<std::uint32_t>& into) {
  Collapsed result;
  constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(mesh.positions.size(), kGone);
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    const VertexHandle handle(static_cast<int>(v));
    if (halfedges.status(handle).deleted() || halfedges.is_isolated(handle)) continue;
    place[v] = static_cast<std::uint32_t>(result.source.size());
    result.source.push_back(v);
    result.mesh.positions.push_back(mesh.positions[v]);
    if (!mesh.normals.empty()) result.mesh.normals.push_back(mesh.normals[v]);
    if (!mesh.colors.empty()) result.mesh.colors.push_back(mesh.colors[v]);
  }
  for (const auto f : halfedges.faces()) {   // leaves out the deleted ones
    std::array<std::uint32_t, 3> t{};
    int corner = 0;
    for (const auto v : halfedges.fv_range(f)) t[static_cast<std::size_t>(corner++)] = place[static_cast<std::size_t>(v.idx())];
    result.mesh.triangles.push_back(t);
  }
  for (const auto e : halfedges.edges()) {
    if (!halfedges.status(e).feature()) continue;
    const HalfedgeHandle h = halfedges.halfedge_handle(e, 0);
    const auto [low, high] = std::minmax(place[static_cast<std::size_t>(halfedges.from_vertex_handle(h).idx())],
                                         place[static_cast<std::size_t>(halfedges.to_vertex_handle(h).idx())]);
    result.mesh.creases.push_back({low, high});
  }
  std::sort(result.mesh.creases.begin(), result.mesh.creases.end());
  result.survivor.resize(place.size());
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    std::uint32_t at = v;
    while (into[at] != at) at = into[at];
    result.survivor[v] = place[at];
  }
  return result;
}

}  // namespace

std::optional<Collapsed> collapse_edges(const Mesh& mesh, std::size_t triangles, const std::vector<bool>& locked,
                                        const RunOptions& run) {
  try {
    Halfedges halfedges;
    build_halfedges(mesh, halfedges, run);
    halfedges.request_face_normals();
    halfedges.update_face_normals();
    std::vector<std::uint32_t> into(mesh.positions.size());
    for (std::uint32_t v = 0; v < into.size(); ++v) into[v] = v;
    OpenMesh::Decimater::DecimaterT<Halfedges> decimater(halfedges);
    GuardedQuadrics::Handle quadrics;
    decimater.add(quadrics);
    decimater.module(quadrics).prepare(mesh.normals, run, into);
    decimater.initialize();
    halfedges.ask(&decimater.module(quadrics));
    mark_creases(mesh, locked, halfedges);
    Watch watch(run, (mesh.triangles.size() - std::min(triangles, mesh.triangles.size())) / 2 + 1);
    decimater.set_observer(&watch);
    std::size_t left = mesh.triangles.size();
    for (const ShapeRule& rule : kRules) {
      if (left <= triangles) break;
      if (!rule.creases) give_up_creases(locked, halfedges);
      decimater.module(quadrics).set_rule(rule);
      // The decimater stops at either number, and counts deleted ones among those that it begins with.
      left -= 2 * decimater.decimate((left - triangles + 1) / 2);
      if (run.cancelled()) return std::nullopt;
    }
    return take_mesh(mesh, halfedges, into);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

}  // namespace cambium
