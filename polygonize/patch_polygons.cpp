#include "polygonize/patch_polygons.h"

#include "polygonize/calm_sheet.h"
#include "polygonize/crease_point.h"
#include "polygonize/crowded_leaves.h"
#include "polygonize/groups.h"
#include "polygonize/marks.h"
#include "polygonize/polygon_ring.h"
#include "polygonize/polygon_split.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kSeen = 1e-3;       // of the shorter leaf's edge: how far inside a face two vertices must see each other through it
constexpr double kFaceMargin = 0.02; // face vertices keep this far inside their faces
constexpr double kCreaseFaceMargin = 0.004;   // those on creases, which a margin moves off them
constexpr std::size_t kGrain = 4096;

/// The face between the leaves in two neighbouring quadrants: its axis and plane, and where it reaches.
struct Face {
  int axis = 0;
  Box box;             // flat across axis
  double edge = 0;     // of the smaller leaf
};

Face face_between(const SurfaceOctree& tree, const MinimalEdge& edge, const EdgeFrame& frame, int q, int next) {
  const OctreeLeaf &m = tree.leaves()[edge.leaves[q]], &n = tree.leaves()[edge.leaves[next]];
  const Box p = tree.box(m), r = tree.box(n);
  Face face;
  face.axis = ((q ^ next) & 1) ? frame.b : frame.c;
  face.box = {glm::max(p.lo, r.lo), glm::min(p.hi, r.hi)};
  face.box.lo[face.axis] = face.box.hi[face.axis] = face.axis == frame.b ? frame.at_b : frame.at_c;
  face.edge = std::min(tree.edge(m), tree.edge(n));
  return face;
}

bool see_each_other(const Face& face, const Vec3& p, const Vec3& q) {
  const int a = face.axis;
  const double t = (face.box.lo[a] - p[a]) / (q[a] - p[a]);
  if (!(t > 0 && t < 1)) return false;
  const Vec3 y = p + (q - p) * t;
  const double margin = kSeen * face.edge;
  for (int k = 1; k < 3; ++k) {
    const int b = (a + k) % 3;
    if (!(y[b] > face.box.lo[b] + margin && y[b] < face.box.hi[b] - margin)) return false;
  }
  return true;
}

/// Where two patches that do not see each other meet: one vertex on their face.
struct FaceVertex {
  std::array<std::uint32_t, 2> patches{};   // lower first
  std::uint32_t edge = 0;                   // one of the two minimal edges whose polygons meet there
  std::uint32_t other_edge = 0;
  int q = 0, next = 0;                      // quadrants of that edge
  Vec3 position{0.0};
  glm::vec3 normal{0.0f};
  bool crease = false;
  bool operator<(const FaceVertex& o) const { return std::tie(patches, edge) < std::tie(o.patches, o.edge); }
};

class PolygonBuilder {
 public:
  PolygonBuilder(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const std::vector<Vec3>& positions,
                 const std::vector<std::optional<Split>>& splits, double tolerance)
      : tree_(tree), cover_(cover), contour_(contour), edges_(contour.edges), crossings_(contour.crossings),
        positions_(positions), splits_(splits), tolerance_(tolerance), creases_(crease_edges(contour)),
        crowded_(crowded_patches(contour)) {
    for (std::uint32_t p = 0; p < positions_.size(); ++p) {
      if (crowded_[p]) positions_[p] = crowded_position(tree, contour, p);
    }
    std::erase_if(creases_, [&](const auto& crease) { return crowded_[crease[0]] || crowded_[crease[1]]; });
  }

  std::optional<DualMesh> build(const RunOptions& run) {
    find_faces();
    if (run.cancelled()) return std::nullopt;
    drop_faces();
    if (run.cancelled()) return std::nullopt;
    place_faces();
    if (run.cancelled()) return std::nullopt;
    plan();
    if (run.cancelled()) return std::nullopt;
    DualMesh result = write();
    if (run.cancelled()) return std::nullopt;
    return result;
  }

 private:
  struct Plan {
    std::uint8_t triangles = 0;
    bool fan = false;
    bool other_diagonal = false;
  };

  const Vec3& position(std::uint32_t patch) const { return positions_[patch]; }

  void find_faces() {
    std::vector<std::vector<FaceVertex>> parts((edges_.size() + kGrain - 1) / kGrain);
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t task) {
      for (std::size_t i = task * kGrain; i < std::min(edges_.size(), (task + 1) * kGrain); ++i) {
        const MinimalEdge& edge = edges_[i];
        const EdgeFrame frame(tree_, edge);
        const Ring ring = ring_of(edge, contour_.patch_of_quadrant[i]);
        for (int k = 0; k < ring.count; ++k) {
          const std::uint32_t p = ring.patches[k], r = ring.patches[(k + 1) % ring.count];
          const auto [q, next] = ring.across[k];
          if (!crowded_[p] && !crowded_[r] && see_each_other(face_between(tree_, edge, frame, q, next), position(p), position(r))) continue;
          FaceVertex face;
          face.patches = {std::min(p, r), std::max(p, r)};
          face.edge = static_cast<std::uint32_t>(i);
          face.q = q, face.next = next;
          parts[task].push_back(face);
        }
      }
    });
    for (auto& part : parts) faces_.insert(faces_.end(), part.begin(), part.end());
    tbb::parallel_sort(faces_.begin(), faces_.end());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {   // each was found from both of its edges
      if (kept > 0 && faces_[kept - 1].patches == faces_[i].patches) {
        faces_[kept - 1].other_edge = faces_[i].edge;
      } else {
        faces_[kept] = faces_[i];
        faces_[kept].other_edge = faces_[i].edge;
        ++kept;
      }
    }
    faces_.resize(kept);
  }

  // On a calm sheet polygons do without, unless a triangle about the middle of one that keeps others would be folded.
  void drop_faces() {
    calm_.emplace(tree_, contour_, positions_, splits_, crowded_);
    std::vector<std::uint8_t> kept(faces_.size());
    tbb::parallel_for(std::size_t{0}, faces_.size(), [&](std::size_t i) { kept[i] = !may_drop(faces_[i]); });
    for (bool more = true; more;) {
      more = false;
      Marks fans(edges_.size());
      for (std::size_t i = 0; i < faces_.size(); ++i)
        if (kept[i]) fans.add(faces_[i].edge), fans.add(faces_[i].other_edge);
      for (std::size_t i = 0; i < faces_.size(); ++i) {
        if (kept[i]) continue;
        const auto& [patches, edge, other_edge] = std::tie(faces_[i].patches, faces_[i].edge, faces_[i].other_edge);
        kept[i] = (fans.has(edge) && folds(edge, patches)) || (fans.has(other_edge) && folds(other_edge, patches));
        more = more || kept[i];
      }
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i)
      if (kept[i]) faces_[count++] = faces_[i];
    faces_.resize(count);
  }

  bool may_drop(const FaceVertex& face) const {
    const bool open = face.edge == face.other_edge;
    return !open && calm_->split(face.edge) && calm_->split(face.other_edge) &&
           calm_->keeps_among({face.edge, face.other_edge}, face.patches);
  }

  /// Whether the triangle between a polygon's middle and two of its patches faces down.
  bool folds(std::uint32_t edge, const std::array<std::uint32_t, 2>& patches) const {
    const Ring ring = ring_of(edges_[edge], contour_.patch_of_quadrant[edge]);
    for (int k = 0; k < ring.count; ++k) {
      const std::uint32_t p = ring.patches[k], r = ring.patches[(k + 1) % ring.count];
      if (std::minmax(p, r) == std::minmax(patches[0], patches[1])) return !calm_->faces_up(p, {crossing_point(edge), position(p), position(r)});
    }
    return false;
  }

  void place_faces() {
    struct Scratch {
      Evaluator evaluator;
      ChoiceEvaluator choices;
    };
    const auto cell_of = [&](std::size_t i) {
      const MinimalEdge& edge = edges_[faces_[i].edge];
      const OctreeLeaf &m = tree_.leaves()[edge.leaves[faces_[i].q]], &n = tree_.leaves()[edge.leaves[faces_[i].next]];
      return (m.level <= n.level ? m : n).cell;
    };
    const Groups by_cell(cover_.size(), faces_.size(), cell_of);
    tbb::enumerable_thread_specific<Scratch> scratches;
    tbb::parallel_for(std::size_t{0}, cover_.size(), [&](std::size_t cell) {
      if (by_cell.of(cell).empty()) return;
      const PrunedField field = cover_.cube_field(cell);
      Scratch& scratch = scratches.local();
      for (const std::uint32_t i : by_cell.of(cell)) place_face(field, scratch.evaluator, scratch.choices, faces_[i]);
    });
  }

  void place_face(const PrunedField& field, Evaluator& evaluator, ChoiceEvaluator& choices, FaceVertex& vertex) const {
    const MinimalEdge& edge = edges_[vertex.edge];
    const Face face = face_between(tree_, edge, EdgeFrame(tree_, edge), vertex.q, vertex.next);
    const Vec3 p = crossing_point(vertex.edge);
    const bool open = vertex.other_edge == vertex.edge;
    const Vec3 r = open ? other_crossing(field, evaluator, face, p) : crossing_point(vertex.other_edge);
    const auto inside = [&](double margin) {
      Box within = face.box;
      for (int k = 1; k < 3; ++k) {
        const int b = (face.axis + k) % 3;
        within.lo[b] += margin * face.edge;
        within.hi[b] -= margin * face.edge;
      }
      return within;
    };
    const Box within = inside(kFaceMargin);
    vertex.position = glm::clamp((p + r) / 2.0, within.lo, within.hi);
    vertex.normal = crossings_[vertex.edge].normal + crossings_[vertex.other_edge].normal;
    if (std::binary_search(creases_.begin(), creases_.end(), vertex.patches)) {
      std::array<Choices, 2> sides;
      choices.choose(field, p, sides[0]);
      choices.choose(field, r, sides[1]);
      if (const auto found = find_crease(choices, field, sides, vertex.position, inside(kCreaseFaceMargin), face.axis);
          found && found->kind != CreaseKind::kNone) {
        vertex.position = found->position;
        vertex.crease = true;
        return;
      }
    }
    if (crowded_[vertex.patches[0]] || crowded_[vertex.patches[1]]) return;
    for (int round = 0; round < 3; ++round) {
      Sample sample = evaluator.sample(field, vertex.position);
      sample.gradient[face.axis] = 0;
      const double squared = glm::dot(sample.gradient, sample.gradient);
      if (!(squared > 0) || !std::isfinite(squared)) return;
      const Vec3 step = sample.gradient * ((kIso - sample.value) / squared);
      if (!(glm::length(step) < face.edge)) return;
      vertex.position = glm::clamp(vertex.position + step, within.lo, within.hi);
    }
  }

  /// Where the surface, which enters a face at p, leaves it through another side, beside nothing; p if there is no such place or several.
  Vec3 other_crossing(const PrunedField& field, Evaluator& evaluator, const Face& face, const Vec3& p) const {
    constexpr int kHalvings = 12;
    const int b = (face.axis + 1) % 3, c = (face.axis + 2) % 3;
    const auto inside = [&](const Vec3& at) { return evaluator.value(field, at) >= kIso; };
    const auto corner = [&](int k) {   // around the face
      Vec3 at = face.box.lo;
      if (k % 4 == 1 || k % 4 == 2) at[b] = face.box.hi[b];
      if (k % 4 >= 2) at[c] = face.box.hi[c];
      return at;
    };
    std::optional<Vec3> found;
    for (int k = 0; k < 4; ++k) {
      Vec3 in = corner(k), out = corner(k + 1);
      const int across = k % 2 == 0 ? c : b;   // of this side
      if (inside(in) == inside(out) || std::abs(p[across] - in[across]) < 1e-6 * face.edge) continue;
      if (found) return p;
      if (!inside(in)) std::swap(in, out);
      for (int step = 0; step < kHalvings; ++step) {
        const Vec3 middle = (in + out) / 2.0;
        (inside(middle) ? in : out) = middle;
      }
      found = (in + out) / 2.0;
    }
    return found.value_or(p);
  }

  Vec3 crossing_point(std::uint32_t edge) const { return cambium::crossing_point(tree_, contour_, edge); }

  const FaceVertex* face_of(std::uint32_t p, std::uint32_t r) const {
    const std::array<std::uint32_t, 2> key{std::min(p, r), std::max(p, r)};
    const auto at = std::lower_bound(faces_.begin(), faces_.end(), key,
                                     [](const FaceVertex& face, const auto& wanted) { return face.patches < wanted; });
    return at != faces_.end() && at->patches == key ? &*at : nullptr;
  }

  void plan() {
    plans_.resize(edges_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, edges_.size(), kGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) plans_[i] = plan_of(i);
    });
  }

  Plan plan_of(std::size_t i) const {
    const Ring ring = ring_of(edges_[i], contour_.patch_of_quadrant[i]);
    int faces = 0;
    for (int k = 0; k < ring.count; ++k) faces += face_of(ring.patches[k], ring.patches[(k + 1) % ring.count]) != nullptr;
    Plan plan;
    plan.fan = true;
    plan.triangles = static_cast<std::uint8_t>(ring.count + faces);
    if (faces > 0) return plan;
    const auto edge = static_cast<std::uint32_t>(i);
    const Split split = split_at(edge, ring);
    if (split == Split::kFan) return plan;
    plan.fan = false;
    plan.triangles = static_cast<std::uint8_t>(ring.count - 2);
    plan.other_diagonal = split == Split::kSecond;
    return plan;
  }

  Split split_at(std::uint32_t edge, const Ring& ring) const {
    if (const auto calm = calm_->split(edge)) return *calm;
    return splits_[edge] ? *splits_[edge] : split_of(tree_, contour_, edge, ring, positions_, tolerance_);
  }

  DualMesh write() const {
    DualMesh result;
    Mesh& mesh = result.mesh;
    const std::size_t patch_count = contour_.vertices.size();
    std::vector<std::size_t> first_triangle(edges_.size() + 1, 0), edge_vertex(edges_.size() + 1, patch_count + faces_.size());
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      first_triangle[i + 1] = first_triangle[i] + plans_[i].triangles;
      edge_vertex[i + 1] = edge_vertex[i] + plans_[i].fan;
    }
    result.face_vertices = faces_.size();
    result.edge_vertices = edge_vertex.back() - patch_count - faces_.size();
    mesh.positions.resize(edge_vertex.back());
    mesh.normals.resize(edge_vertex.back());
    mesh.triangles.resize(first_triangle.back());
    for (std::size_t i = 0; i < patch_count; ++i) {
      mesh.positions[i] = positions_[i];
      mesh.normals[i] = contour_.vertices[i].normal;
    }
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      mesh.positions[patch_count + i] = faces_[i].position;
      mesh.normals[patch_count + i] = unit(faces_[i].normal);
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, edges_.size(), kGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        write_polygon(i, static_cast<std::uint32_t>(edge_vertex[i]), &mesh.triangles[first_triangle[i]], mesh);
      }
    });
    write_creases(mesh);
    return result;
  }

  static glm::vec3 unit(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 1e-6f ? v / length : glm::vec3(0, 0, 1);
  }

  void write_polygon(std::size_t i, std::uint32_t center, std::array<std::uint32_t, 3>* out, Mesh& mesh) const {
    const Ring ring = ring_of(edges_[i], contour_.patch_of_quadrant[i]);
    const auto& v = ring.patches;
    if (!plans_[i].fan) {
      if (ring.count == 3) {
        out[0] = {v[0], v[1], v[2]};
      } else if (plans_[i].other_diagonal) {
        out[0] = {v[1], v[2], v[3]};
        out[1] = {v[1], v[3], v[0]};
      } else {
        out[0] = {v[0], v[1], v[2]};
        out[1] = {v[0], v[2], v[3]};
      }
      return;
    }
    mesh.positions[center] = crossing_point(static_cast<std::uint32_t>(i));
    mesh.normals[center] = unit(crossings_[i].normal);
    for (int k = 0; k < ring.count; ++k) {
      const std::uint32_t next = v[(k + 1) % ring.count];
      if (const FaceVertex* face = face_of(v[k], next)) {
        const auto between = static_cast<std::uint32_t>(contour_.vertices.size() + static_cast<std::size_t>(face - faces_.data()));
        *out++ = {center, v[k], between};
        *out++ = {center, between, next};
      } else {
        *out++ = {center, v[k], next};
      }
    }
  }

  // Between patches on a crease that passes their face by there is none: the way over the face leaves it.
  void write_creases(Mesh& mesh) const {
    for (const auto& crease : creases_) {
      if (const FaceVertex* face = face_of(crease[0], crease[1])) {
        if (!face->crease) continue;
        const auto between = static_cast<std::uint32_t>(contour_.vertices.size() + static_cast<std::size_t>(face - faces_.data()));
        mesh.creases.push_back({crease[0], between});
        mesh.creases.push_back({crease[1], between});
      } else {
        mesh.creases.push_back(crease);
      }
    }
    std::sort(mesh.creases.begin(), mesh.creases.end());
  }

  const SurfaceOctree& tree_;
  const SurfaceCover& cover_;
  const Contour& contour_;
  const std::vector<MinimalEdge>& edges_;
  const std::vector<Crossing>& crossings_;
  std::vector<Vec3> positions_;
  const std::vector<std::optional<Split>>& splits_;
  const double tolerance_;
  std::vector<std::array<std::uint32_t, 2>> creases_;
  const std::vector<bool> crowded_;
  std::vector<FaceVertex> faces_;
  std::optional<CalmSheet> calm_;
  std::vector<Plan> plans_;
};

}  // namespace

std::optional<DualMesh> build_polygons(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour,
                                       const std::vector<Vec3>& positions, const std::vector<std::optional<Split>>& splits,
                                       double tolerance, const RunOptions& run) {
  return PolygonBuilder(tree, cover, contour, positions, splits, tolerance).build(run);
}

}  // namespace cambium
