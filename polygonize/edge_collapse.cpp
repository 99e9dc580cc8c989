#include "polygonize/edge_collapse.h"

#include "blobtree/input_error.h"
#include "polygonize/crossing_guard.h"
#include "polygonize/vertex_heap.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Geometry/QuadricT.hh>   // needs what that includes
#include <OpenMesh/Tools/Decimater/CollapseInfoT.hh>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cambium {
namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;
using Halfedges = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using CollapseInfo = OpenMesh::Decimater::CollapseInfoT<Halfedges>;
using Quadric = OpenMesh::Geometry::Quadricd;
using Point = Halfedges::Point;

struct Cancelled {};

constexpr std::size_t kPollEvery = 1 << 12;         // faces added: about a millisecond
constexpr std::size_t kPollCollapses = 1 << 10;
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

VertexHandle vertex(std::uint32_t v) { return VertexHandle(static_cast<int>(v)); }
std::uint32_t number(OpenMesh::BaseHandle handle) { return static_cast<std::uint32_t>(handle.idx()); }

// Vertices leave in the order of what that costs, as quadrics put it; that is known from a few numbers for every edge. Whether the
// edge may be collapsed is only asked when its turn has come, since that takes longer and is mostly so.
class Collapser {
 public:
  Collapser(const Mesh& mesh, Halfedges& halfedges, const RunOptions& run)
      : halfedges_(halfedges), normals_(mesh.normals), run_(run), crossings_(mesh.positions, mesh.triangles, run),
        quadrics_(mesh.positions.size()), own_(mesh.positions.size()), targets_(mesh.positions.size()),
        stamps_(mesh.positions.size(), 0), left_(mesh.triangles.size()), first_(mesh.triangles.size()) {
    parallel_vertices([&](std::uint32_t v) {
      quadrics_[v].clear();
      for (const auto f : halfedges_.vf_range(vertex(v))) quadrics_[v] += quadric_of(f);
      set_own(v);
    });
  }

  std::size_t left() const { return left_; }

  /// Until at most so many triangles are left or the rule allows no collapse.
  void collapse_to(std::size_t triangles, const ShapeRule& rule) {
    rule_ = &rule;
    std::vector<float> costs(targets_.size());
    parallel_vertices([&](std::uint32_t v) { costs[v] = aim(v); });
    VertexHeap waiting(std::move(costs));
    for (std::size_t turn = 0; left_ > triangles && !waiting.empty(); ++turn) {
      if (turn % kPollCollapses == 0) report(triangles);
      const std::uint32_t v = waiting.front();
      const HalfedgeHandle h = targets_[v];
      waiting.pop();
      if (allows(h)) {
        collapse(h, waiting);
        continue;
      }
      const auto [next, cost] = best_allowed(vertex(v));
      targets_[v] = next;
      if (cost <= waiting.least() && next.is_valid()) {
        collapse(next, waiting);
      } else {
        waiting.set(v, cost);
      }
    }
  }

 private:
  template <class Do>
  void parallel_vertices(Do&& act) const {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, targets_.size(), 1024), [&](const auto& range) {
      for (std::size_t v = range.begin(); v < range.end() && !run_.cancelled(); ++v) act(static_cast<std::uint32_t>(v));
    });
    if (run_.cancelled()) throw Cancelled{};
  }
  void report(std::size_t triangles) const {
    if (run_.cancelled()) throw Cancelled{};
    if (run_.progress) run_.progress("decimating", static_cast<double>(first_ - left_) / static_cast<double>(first_ - triangles));
  }

  bool crease(HalfedgeHandle h) const { return halfedges_.status(halfedges_.edge_handle(h)).feature(); }
  void mark(VertexHandle a, VertexHandle b, bool is_crease) {
    halfedges_.status(halfedges_.edge_handle(halfedges_.find_halfedge(a, b))).set_feature(is_crease);
  }

  // Of the plane of a face, times its area.
  Quadric quadric_of(FaceHandle f) const {
    auto corner = halfedges_.cfv_iter(f);
    const Point a = halfedges_.point(*corner++), b = halfedges_.point(*corner++), c = halfedges_.point(*corner);
    Point n = (b - a) % (c - a);
    const double length = n.norm();
    if (length > 0) n /= length;
    Quadric q(n[0], n[1], n[2], -(a | n));
    q *= 0.5 * length;
    return q;
  }
  void set_own(std::uint32_t v) { own_[v] = quadrics_[v](halfedges_.point(vertex(v))); }
  float cost(std::uint32_t v, HalfedgeHandle h) const {
    const VertexHandle to = halfedges_.to_vertex_handle(h);
    const Point& p = halfedges_.point(to);
    const double length2 = (p - halfedges_.point(vertex(v))).sqrnorm();
    return static_cast<float>(std::max(quadrics_[v](p) + own_[number(to)], 0.0) + kLengthWeight * length2 * length2);
  }

  // The cheapest way to go, allowed or not, becomes v's target.
  float aim(std::uint32_t v) {
    targets_[v] = HalfedgeHandle();
    float best = VertexHeap::kNever;
    const auto& status = halfedges_.status(vertex(v));
    if (status.deleted() || status.locked()) return best;
    for (const HalfedgeHandle h : halfedges_.voh_range(vertex(v))) {
      if (status.feature() && !crease(h)) continue;
      const float c = cost(v, h);
      if (c < best) best = c, targets_[v] = h;
    }
    return best;
  }

  std::pair<HalfedgeHandle, float> best_allowed(VertexHandle v) {
    std::array<std::pair<float, HalfedgeHandle>, kMostSpokes> ways;
    std::size_t count = 0;
    const bool on_crease = halfedges_.status(v).feature();
    for (const HalfedgeHandle h : halfedges_.voh_range(v)) {
      if (on_crease && !crease(h)) continue;
      if (count == ways.size()) break;
      ways[count++] = {cost(number(v), h), h};
    }
    std::stable_sort(ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < count; ++i)
      if (ways[i].second != targets_[number(v)] && allows(ways[i].second)) return {ways[i].second, ways[i].first};
    return {HalfedgeHandle(), VertexHeap::kNever};
  }

  bool allows(HalfedgeHandle h) {
    const CollapseInfo ci(halfedges_, h);
    return keeps_topology(ci) && keeps_creases(ci) && keeps_shape(ci) && !crosses(ci);
  }

  // The link condition of a closed surface: the two ends have no neighbours in common but the corners of the two triangles. What
  // is left may not be two triangles back to back.
  bool keeps_topology(const CollapseInfo& ci) {
    if (ci.vl == ci.vr) return false;
    ++stamp_;
    std::size_t spokes = 0;
    for (const auto v : halfedges_.vv_range(ci.v0)) stamps_[number(v)] = stamp_, ++spokes;
    if (spokes < 3 || spokes > kMostSpokes) return false;
    for (const auto v : halfedges_.vv_range(ci.v1))
      if (stamps_[number(v)] == stamp_ && v != ci.vl && v != ci.vr) return false;
    const auto three_spokes = [&](VertexHandle v) {
      HalfedgeHandle h = halfedges_.halfedge_handle(v);
      for (int i = 0; i < 3; ++i) h = halfedges_.opposite_halfedge_handle(halfedges_.prev_halfedge_handle(h));
      return h == halfedges_.halfedge_handle(v);
    };
    return !(three_spokes(ci.vl) && three_spokes(ci.vr) && halfedges_.find_halfedge(ci.vl, ci.vr).is_valid());
  }

  // A crease that runs around one triangle may not close up.
  bool keeps_creases(const CollapseInfo& ci) const {
    return !rule_->creases || !((crease(ci.vlv1) && crease(ci.v0vl)) || (crease(ci.v1vr) && crease(ci.vrv0)));
  }

  double facing(const Point& normal, VertexHandle v) const {
    const glm::vec3& n = normals_[number(v)];
    return normal[0] * n.x + normal[1] * n.y + normal[2] * n.z;
  }

  // Walks the triangles around v0 from the edge to v1 and back to it, and looks at each as it would be with v1 in v0's place.
  bool keeps_shape(const CollapseInfo& ci) const {
    const Halfedges& m = halfedges_;
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
      if (rule_->facing > -1 && !normals_.empty()) {
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

  bool crosses(const CollapseInfo& ci) {
    star_.clear();
    fan_.clear();
    for (const HalfedgeHandle spoke : halfedges_.voh_range(ci.v0)) {
      const FaceHandle face = halfedges_.face_handle(spoke);
      star_.push_back(number(face));
      if (face == ci.fl || face == ci.fr) continue;
      const HalfedgeHandle outer = halfedges_.next_halfedge_handle(spoke);
      fan_.push_back({number(ci.v1), number(halfedges_.from_vertex_handle(outer)), number(halfedges_.to_vertex_handle(outer))});
    }
    return crossings_.crosses(star_, fan_);
  }

  // After allows(h), which left star_ and fan_.
  void collapse(HalfedgeHandle h, VertexHeap& waiting) {
    const CollapseInfo ci(halfedges_, h);
    // Two edges become one on either side, and OpenMesh keeps the status of one of them.
    const bool crease_left = crease(ci.vlv1) || crease(ci.v0vl), crease_right = crease(ci.v1vr) || crease(ci.vrv0);
    halfedges_.collapse(h);
    mark(ci.v1, ci.vl, crease_left);
    mark(ci.v1, ci.vr, crease_right);
    std::size_t next = 0;
    for (const std::uint32_t i : star_) {
      const FaceHandle face(static_cast<int>(i));
      if (face == ci.fl || face == ci.fr) continue;
      halfedges_.set_normal(face, halfedges_.calc_face_normal(face));
      crossings_.change(i, fan_[next++]);
    }
    crossings_.remove(number(ci.fl));
    crossings_.remove(number(ci.fr));   // builds its tree anew now and then
    if (run_.cancelled()) throw Cancelled{};
    left_ -= 2;
    quadrics_[number(ci.v1)] += quadrics_[number(ci.v0)];
    set_own(number(ci.v1));
    waiting.set(number(ci.v1), aim(number(ci.v1)));
    for (const HalfedgeHandle out : halfedges_.voh_range(ci.v1))
      aim_at_changed(number(halfedges_.to_vertex_handle(out)), halfedges_.opposite_halfedge_handle(out), waiting);
  }

  // Where `h` leads has changed, and nothing else that v might aim at. Who aims elsewhere aims on unless
  // this is better; who had no way to go looks again.
  void aim_at_changed(std::uint32_t v, HalfedgeHandle h, VertexHeap& waiting) {
    const HalfedgeHandle old = targets_[v];
    const bool aims_elsewhere = waiting.cost(v) != VertexHeap::kNever && old != h && !halfedges_.status(old).deleted();
    if (!aims_elsewhere) {
      waiting.set(v, aim(v));
      return;
    }
    if (halfedges_.status(vertex(v)).feature() && !crease(h)) return;
    if (const float c = cost(v, h); c < waiting.cost(v)) {
      targets_[v] = h;
      waiting.set(v, c);
    }
  }

  Halfedges& halfedges_;
  const std::vector<glm::vec3>& normals_;
  const RunOptions& run_;
  CrossingGuard crossings_;
  const ShapeRule* rule_ = nullptr;
  // By vertex:
  std::vector<Quadric> quadrics_;
  std::vector<double> own_;                // its quadric where it is
  std::vector<HalfedgeHandle> targets_;
  std::vector<std::uint32_t> stamps_;      // stamp_ if it is a neighbour of what is being looked at
  std::uint32_t stamp_ = 0;
  std::size_t left_, first_;               // triangles
  std::vector<std::uint32_t> star_;
  std::vector<CrossingGuard::Corners> fan_;
};

// Positions are relative to the middle of the mesh: quadrics lose half their digits far from the origin.
void build_halfedges(const Mesh& mesh, Halfedges& out, const RunOptions& run) {
  Box bounds;
  for (const Vec3& p : mesh.positions) bounds.extend(p);
  const Vec3 middle = mesh.positions.empty() ? Vec3(0.0) : 0.5 * (bounds.lo + bounds.hi);
  out.reserve(mesh.positions.size(), mesh.triangles.size() * 3 / 2, mesh.triangles.size());
  for (const Vec3& p : mesh.positions) out.add_vertex(Point(p.x - middle.x, p.y - middle.y, p.z - middle.z));
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
void mark_creases(const Mesh& mesh, Halfedges& out) {
  std::vector<std::uint8_t> creases(mesh.positions.size(), 0);
  for (const auto& edge : mesh.creases) {
    const HalfedgeHandle h = out.find_halfedge(vertex(edge[0]), vertex(edge[1]));
    if (!h.is_valid()) continue;
    out.status(out.edge_handle(h)).set_feature(true);
    for (const std::uint32_t v : edge) creases[v] = static_cast<std::uint8_t>(std::min(creases[v] + 1, 3));
  }
  for (std::uint32_t v = 0; v < creases.size(); ++v) {
    out.status(vertex(v)).set_feature(creases[v] > 0);
    out.status(vertex(v)).set_locked(creases[v] > 0 && creases[v] != 2);
  }
}

void give_up_creases(Halfedges& out) {
  for (const auto v : out.vertices()) {
    out.status(v).set_feature(false);
    out.status(v).set_locked(false);
  }
}

Mesh take_mesh(const Mesh& mesh, const Halfedges& halfedges) {
  Mesh result;
  constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(mesh.positions.size(), kGone);
  for (std::uint32_t v = 0; v < place.size(); ++v) {
    const VertexHandle handle = vertex(v);
    if (halfedges.status(handle).deleted() || halfedges.is_isolated(handle)) continue;
    place[v] = static_cast<std::uint32_t>(result.positions.size());
    result.positions.push_back(mesh.positions[v]);
    if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[v]);
    if (!mesh.colors.empty()) result.colors.push_back(mesh.colors[v]);
  }
  for (const auto f : halfedges.faces()) {   // leaves out the deleted ones
    std::array<std::uint32_t, 3> t{};
    int corner = 0;
    for (const auto v : halfedges.fv_range(f)) t[static_cast<std::size_t>(corner++)] = place[number(v)];
    result.triangles.push_back(t);
  }
  for (const auto e : halfedges.edges()) {
    if (!halfedges.status(e).feature()) continue;
    const HalfedgeHandle h = halfedges.halfedge_handle(e, 0);
    const auto [low, high] = std::minmax({place[number(halfedges.from_vertex_handle(h))],
                                         place[number(halfedges.to_vertex_handle(h))]});
    result.creases.push_back({low, high});
  }
  std::sort(result.creases.begin(), result.creases.end());
  return result;
}

}  // namespace

std::optional<Mesh> collapse_edges(const Mesh& mesh, std::size_t triangles, const RunOptions& run) {
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  return arena.execute([&]() -> std::optional<Mesh> {
    try {
      Halfedges halfedges;
      halfedges.request_vertex_status();
      halfedges.request_edge_status();
      halfedges.request_halfedge_status();
      halfedges.request_face_status();
      build_halfedges(mesh, halfedges, run);
      halfedges.request_face_normals();
      halfedges.update_face_normals();
      mark_creases(mesh, halfedges);
      Collapser collapser(mesh, halfedges, run);
      for (const ShapeRule& rule : kRules) {
        if (collapser.left() <= triangles) break;
        if (!rule.creases) give_up_creases(halfedges);
        collapser.collapse_to(triangles, rule);
      }
      return take_mesh(mesh, halfedges);
    } catch (const Cancelled&) {
      return std::nullopt;
    }
  });
}

}  // namespace cambium
