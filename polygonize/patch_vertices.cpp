#include "polygonize/patch_vertices.h"

#include "polygonize/crease_point.h"
#include "polygonize/crowded_leaves.h"
#include "polygonize/field_batch.h"
#include "polygonize/groups.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cambium {
namespace {

constexpr int kSettleRounds = 3;
constexpr float kSettled = 0.003f;          // edges
constexpr float kAlike = 0.985f;            // cosine between a normal and their mean: ten degrees, below which no crease is looked for
constexpr std::size_t kMostSides = 4;

Vec3 clamp_into(const Vec3& p, const Box& box, double margin) {
  return glm::clamp(p, box.lo + margin, box.hi - margin);
}

struct Placed {
  std::uint32_t patch = 0;
  Box box;
  double edge = 0;
  Vec3 at{0.0}, best{0.0};
  float best_distance = 0;                  // metres
  glm::vec3 normal{0.0f}, mean_normal{0.0f};
  float spread = 1;                         // smallest cosine between the mean normal and a crossing's
};

/// Scratch of one thread.
class VertexPlacer {
 public:
  VertexPlacer(const SurfaceOctree& tree, const Contour& contour, const std::vector<std::uint32_t>& wanted,
               std::vector<PatchVertex>& vertices)
      : tree_(tree), contour_(contour), wanted_(wanted), vertices_(vertices) {}

  std::vector<CreaseExit> exits;

  void place(const PrunedField& field, std::span<const std::uint32_t> items) {
    placed_.clear();
    for (const std::uint32_t item : items) begin(wanted_[item]);
    settle(field);
    const bool smooth = ChoiceEvaluator::smooth(field);
    for (Placed& placed : placed_) {
      PatchVertex& vertex = vertices_[placed.patch];
      vertex.position = placed.best;
      vertex.normal = placed.normal != glm::vec3(0.0f) ? placed.normal : placed.mean_normal;
      if (vertex.normal == glm::vec3(0.0f)) vertex.normal = {0, 0, 1};
      if (placed.spread < kAlike && !smooth && !is_crowded(contour_, placed.patch)) place_on_crease(field, placed, vertex);
    }
  }

 private:
  Vec3 crossing_point(std::uint32_t edge) const { return cambium::crossing_point(tree_, contour_, edge); }

  void begin(std::uint32_t id) {
    const Patch& patch = contour_.patches[id];
    const OctreeLeaf& leaf = tree_.leaves()[patch.leaf];
    Placed placed;
    placed.patch = id;
    placed.box = tree_.box(leaf);
    placed.edge = tree_.edge(leaf);
    Vec3 mass(0.0);
    glm::vec3 normals(0.0f);
    for (const std::uint32_t e : contour_.ring(placed.patch)) {
      mass += crossing_point(e) - placed.box.lo;
      normals += contour_.crossings[e].normal;
    }
    placed.at = patch.open ? placed.box.lo + middle_of_crossed(leaf) * placed.edge
                           : placed.box.lo + mass / static_cast<double>(patch.edge_count);
    placed.at = clamp_into(placed.at, placed.box, kVertexMargin * placed.edge);
    const float length = glm::length(normals);
    if (length > 1e-3f) placed.mean_normal = normals / length;
    for (const std::uint32_t e : contour_.ring(placed.patch)) {
      placed.spread = std::min(placed.spread, glm::dot(placed.mean_normal, contour_.crossings[e].normal));
    }
    placed.best = placed.at;
    placed.best_distance = static_cast<float>(kInfinity);
    placed_.push_back(placed);
  }

  /// In the leaf's own unit cube, as its corners tell: of an open patch not all crossings are known.
  static Vec3 middle_of_crossed(const OctreeLeaf& leaf) {
    Vec3 sum(0.0);
    int count = 0;
    for (int e = 0; e < 12; ++e) {
      if (!edge_crossed(leaf.mask, e)) continue;
      const int corner = edge_low_corner(e);
      Vec3 middle(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      middle[e / 4] += 0.5;
      sum += middle;
      ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : Vec3(0.5);
  }

  // Newton steps along the gradient until each vertex lies on the surface; the best place visited counts.
  void settle(const PrunedField& field) {
    active_.resize(placed_.size());
    for (std::uint32_t i = 0; i < active_.size(); ++i) active_[i] = i;
    for (int round = 0; round < kSettleRounds && !active_.empty(); ++round) {
      batch_.clear();
      for (const std::uint32_t i : active_) batch_.add(field, placed_[i].at);
      batch_.evaluate_samples(evaluator_, field);
      std::size_t kept = 0;
      for (std::size_t k = 0; k < active_.size(); ++k) {
        Placed& placed = placed_[active_[k]];
        const glm::vec3 g = batch_.gradient(k);
        const float f = batch_.value(k), length = glm::length(g), edge = static_cast<float>(placed.edge);
        if (!(length > 0) || !std::isfinite(length) || !std::isfinite(f)) continue;
        const float distance = std::abs(f) / length;
        if (distance < placed.best_distance) {
          placed.best = placed.at;
          placed.best_distance = distance;
          placed.normal = g / -length;
        }
        if (distance <= kSettled * edge) continue;
        const Vec3 step = Vec3(g) * static_cast<double>(std::copysign(std::min(distance, 0.5f * edge), -f) / length);
        const Vec3 next = clamp_into(placed.at + step, placed.box, kVertexMargin * placed.edge);
        if (glm::length(next - placed.at) < 1e-4 * placed.edge) continue;
        placed.at = next;
        active_[kept++] = active_[k];
      }
      active_.resize(kept);
    }
  }

  void place_on_crease(const PrunedField& field, const Placed& placed, PatchVertex& vertex) {
    const auto ring = contour_.ring(placed.patch);
    sides_.clear();
    side_of_.clear();
    for (const std::uint32_t e : ring) {
      choices_.choose(field, crossing_point(e), choice_);
      const auto known = std::find(sides_.begin(), sides_.end(), choice_);
      side_of_.push_back(static_cast<std::size_t>(known - sides_.begin()));
      if (known == sides_.end()) sides_.push_back(choice_);
    }
    if (sides_.size() < 2) return;
    Box within = placed.box;
    within.lo += kCreaseMargin * tree_.grid().cell;
    within.hi -= kCreaseMargin * tree_.grid().cell;
    std::optional<CreasePoint> found;
    if (sides_.size() <= kMostSides) found = find_crease(choices_, field, sides_, placed.best, within);
    if (!found) found = find_from_faces(field, placed, within);
    if (!found || found->kind == CreaseKind::kNone) return;
    vertex.position = found->position;
    vertex.crease = true;
    glm::vec3 normals(0.0f);
    for (const Vec3& normal : found->normals) normals += glm::vec3(normal);
    const float length = glm::length(normals);
    vertex.normal = length > 1e-3f ? normals / length : placed.mean_normal != glm::vec3(0.0f) ? placed.mean_normal : vertex.normal;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t j = (i + 1) % ring.size();
      if (side_of_[i] != side_of_[j]) exits.push_back({placed.patch, ring[i], ring[j]});
    }
  }

  // A crease that the nearest step does not find inside the leaf is looked for on the faces through which it enters and leaves, and
  // from between them. The chord between those is inside, and as near to the crease as polygons are.
  std::optional<CreasePoint> find_from_faces(const PrunedField& field, const Placed& placed, const Box& within) {
    const auto ring = contour_.ring(placed.patch);
    CreasePoint entries;
    std::size_t count = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t j = (i + 1) % ring.size();
      if (side_of_[i] == side_of_[j]) continue;
      const Vec3 p = crossing_point(ring[i]), q = crossing_point(ring[j]);
      const auto axis = face_axis(placed, p, q);
      if (!axis) continue;
      const std::array<Choices, 2> sides{sides_[side_of_[i]], sides_[side_of_[j]]};
      const auto entry = find_crease(choices_, field, sides, (p + q) / 2.0, placed.box, axis);
      if (!entry || entry->kind == CreaseKind::kNone) continue;
      entries.position += entry->position - placed.box.lo;
      entries.normals.insert(entries.normals.end(), entry->normals.begin(), entry->normals.end());
      ++count;
    }
    if (count < 2) return std::nullopt;
    const Vec3 mean = placed.box.lo + entries.position / static_cast<double>(count);
    const Vec3 middle = clamp_into(mean, placed.box, kCreaseMargin * tree_.grid().cell);
    if (sides_.size() <= kMostSides) {
      if (auto found = find_crease(choices_, field, sides_, middle, within)) return found;
    }
    if (sides_.size() > 2) return std::nullopt;   // a corner is not on the chord
    entries.position = middle;
    entries.kind = CreaseKind::kCurve;
    return entries;
  }

  /// The axis across the face of the leaf that two of its crossings lie on.
  static std::optional<int> face_axis(const Placed& placed, const Vec3& p, const Vec3& q) {
    const double near = 1e-6 * placed.edge;
    for (int a = 0; a < 3; ++a) {
      for (const double face : {placed.box.lo[a], placed.box.hi[a]}) {
        if (std::abs(p[a] - face) < near && std::abs(q[a] - face) < near) return a;
      }
    }
    return std::nullopt;
  }

  const SurfaceOctree& tree_;
  const Contour& contour_;
  const std::vector<std::uint32_t>& wanted_;
  std::vector<PatchVertex>& vertices_;
  Evaluator evaluator_;
  ChoiceEvaluator choices_;
  FieldBatch batch_;
  std::vector<Placed> placed_;
  std::vector<std::uint32_t> active_;
  std::vector<Choices> sides_;
  std::vector<std::size_t> side_of_;
  Choices choice_;
};

}  // namespace

bool place_vertices(const SurfaceOctree& tree, const SurfaceCover& cover, const std::vector<std::uint32_t>& patches,
                    Contour& contour, const RunOptions& run) {
  const Groups by_cell(cover.size(), patches.size(),
                       [&](std::size_t i) { return tree.leaves()[contour.patches[patches[i]].leaf].cell; });
  tbb::enumerable_thread_specific<VertexPlacer> placers([&] { return VertexPlacer(tree, contour, patches, contour.vertices); });
  tbb::parallel_for(std::size_t{0}, cover.size(), [&](std::size_t cell) {
    const auto items = by_cell.of(cell);
    if (items.empty() || run.cancelled()) return;
    placers.local().place(cover.cube_field(cell), items);
  });
  const std::size_t before = contour.exits.size();
  for (const VertexPlacer& placer : placers) contour.exits.insert(contour.exits.end(), placer.exits.begin(), placer.exits.end());
  std::sort(contour.exits.begin() + static_cast<std::ptrdiff_t>(before), contour.exits.end());
  return !run.cancelled();
}

}  // namespace cambium
