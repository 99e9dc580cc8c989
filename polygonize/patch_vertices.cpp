#include "polygonize/patch_vertices.h"

#include "polygonize/crease_point.h"
#include "polygonize/field_batch.h"
#include "polygonize/groups.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

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
      : tree_(tree), edges_(contour.edges), crossings_(contour.crossings), patches_(contour.patches), wanted_(wanted),
        vertices_(vertices) {}

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
      if (placed.spread < kAlike && !smooth) place_on_crease(field, placed, vertex);
    }
  }

 private:
  Vec3 crossing_point(std::uint32_t edge) const { return edge_point(tree_, edges_[edge], static_cast<double>(crossings_[edge].t)); }

  void begin(std::uint32_t id) {
    const Patch& patch = patches_.patches[id];
    const OctreeLeaf& leaf = tree_.leaves()[patch.leaf];
    Placed placed;
    placed.patch = id;
    placed.box = tree_.box(leaf);
    placed.edge = tree_.edge(leaf);
    Vec3 mass(0.0);
    glm::vec3 normals(0.0f);
    for (const std::uint32_t e : patches_.edges_of(patch)) {
      mass += crossing_point(e) - placed.box.lo;
      normals += crossings_[e].normal;
    }
    placed.at = clamp_into(placed.box.lo + mass / static_cast<double>(patch.edge_count), placed.box, kVertexMargin * placed.edge);
    const float length = glm::length(normals);
    if (length > 1e-3f) placed.mean_normal = normals / length;
    for (const std::uint32_t e : patches_.edges_of(patch)) {
      placed.spread = std::min(placed.spread, glm::dot(placed.mean_normal, crossings_[e].normal));
    }
    placed.best = placed.at;
    placed.best_distance = static_cast<float>(kInfinity);
    placed_.push_back(placed);
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
    const Patch& patch = patches_.patches[placed.patch];
    const auto ring = patches_.edges_of(patch);
    sides_.clear();
    side_of_.clear();
    for (const std::uint32_t e : ring) {
      choices_.choose(field, crossing_point(e), choice_);
      const auto known = std::find(sides_.begin(), sides_.end(), choice_);
      side_of_.push_back(static_cast<std::size_t>(known - sides_.begin()));
      if (known == sides_.end()) sides_.push_back(choice_);
    }
    if (sides_.size() < 2 || sides_.size() > kMostSides) return;
    Box within = placed.box;
    within.lo += kVertexMargin * placed.edge;
    within.hi -= kVertexMargin * placed.edge;
    const auto found = find_crease(choices_, field, sides_, placed.best, within);
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

  const SurfaceOctree& tree_;
  const std::vector<MinimalEdge>& edges_;
  const std::vector<Crossing>& crossings_;
  const SurfacePatches& patches_;
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

/// The patch of `before` that is the same as a patch of now, because all of its crossings are, or kNoPatch.
std::uint32_t earlier_patch(const Contour& now, const Patch& patch, const std::vector<std::uint32_t>& earlier, const Contour& before) {
  std::uint32_t found = kNoPatch;
  for (const std::uint32_t e : now.patches.edges_of(patch)) {
    const std::uint32_t was = earlier[e];
    if (was == kNoEdge) return kNoPatch;
    std::uint32_t its = kNoPatch;
    for (int q = 0; q < 4; ++q) {
      if (before.edges[was].leaves[q] == patch.leaf) its = before.patches.patch_of_quadrant[was][q];
    }
    if (its == kNoPatch || (found != kNoPatch && its != found)) return kNoPatch;
    found = its;
  }
  return before.patches.patches[found].edge_count == patch.edge_count ? found : kNoPatch;
}

/// The patch on the other side of the face that two edges of a patch bound.
std::uint32_t patch_across(const SurfacePatches& patches, const CreaseExit& exit) {
  const auto& a = patches.patch_of_quadrant[exit.edge];
  const auto& b = patches.patch_of_quadrant[exit.next_edge];
  const auto beside = [&](const std::array<std::uint32_t, 4>& around, int k) {
    return around[kRing[(k + 1) % 4]] == exit.patch || around[kRing[(k + 3) % 4]] == exit.patch;
  };
  for (int k = 0; k < 4; ++k) {
    const std::uint32_t other = a[kRing[k]];
    if (other == exit.patch || !beside(a, k)) continue;
    for (int j = 0; j < 4; ++j) {
      if (b[kRing[j]] == other && beside(b, j)) return other;
    }
  }
  return kNoPatch;
}

}  // namespace

std::optional<PatchVertices> place_vertices(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& now,
                                            const std::vector<std::uint32_t>& earlier, const Contour& before, const RunOptions& run) {
  PatchVertices result;
  const std::vector<Patch>& patches = now.patches.patches;
  result.vertices.resize(patches.size());
  std::vector<std::uint32_t> same(patches.size(), kNoPatch);
  if (!before.edges.empty()) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, patches.size(), 4096), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) same[i] = earlier_patch(now, patches[i], earlier, before);
    });
  }
  std::vector<std::uint32_t> wanted;
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    if (same[i] == kNoPatch) {
      wanted.push_back(i);
      continue;
    }
    result.vertices[i] = before.placed.vertices[same[i]];
    if (!result.vertices[i].crease) continue;
    const auto known = std::equal_range(before.placed.exits.begin(), before.placed.exits.end(), CreaseExit{same[i], 0, 0},
                                        [](const CreaseExit& a, const CreaseExit& b) { return a.patch < b.patch; });
    const auto ring = now.patches.edges_of(patches[i]);
    const auto now_edge = [&](std::uint32_t was) { return *std::find_if(ring.begin(), ring.end(), [&](auto e) { return earlier[e] == was; }); };
    for (auto exit = known.first; exit != known.second; ++exit) {
      result.exits.push_back({i, now_edge(exit->edge), now_edge(exit->next_edge)});
    }
  }
  const Groups by_cell(cover.size(), wanted.size(), [&](std::size_t i) { return tree.leaves()[patches[wanted[i]].leaf].cell; });
  tbb::enumerable_thread_specific<VertexPlacer> placers([&] { return VertexPlacer(tree, now, wanted, result.vertices); });
  tbb::parallel_for(std::size_t{0}, cover.size(), [&](std::size_t cell) {
    const auto items = by_cell.of(cell);
    if (items.empty() || run.cancelled()) return;
    placers.local().place(cover.cube_field(cell), items);
  });
  if (run.cancelled()) return std::nullopt;
  for (const VertexPlacer& placer : placers) result.exits.insert(result.exits.end(), placer.exits.begin(), placer.exits.end());
  std::sort(result.exits.begin(), result.exits.end());
  return result;
}

std::vector<std::array<std::uint32_t, 2>> crease_edges(const Contour& contour) {
  std::vector<std::array<std::uint32_t, 2>> creases;
  for (const CreaseExit& exit : contour.placed.exits) {
    const std::uint32_t other = patch_across(contour.patches, exit);
    if (other == kNoPatch || !contour.placed.vertices[other].crease) continue;
    creases.push_back({std::min(exit.patch, other), std::max(exit.patch, other)});
  }
  std::sort(creases.begin(), creases.end());
  creases.erase(std::unique(creases.begin(), creases.end()), creases.end());
  return creases;
}

}  // namespace cambium
