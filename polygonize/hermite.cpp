#include "polygonize/hermite.h"

#include "polygonize/field_batch.h"
#include "polygonize/groups.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr int kFalsiRounds = 6;       // enough for all but one crossing in a hundred; brackets of the rest, at kinks, are halved as well,
constexpr int kRootRounds = 34;       // in every other round: 14 times make 1e-4 of any
constexpr float kRootValue = 2e-5f;
constexpr float kRootWidth = 1e-4f;
constexpr float kEndMargin = 1e-3f;   // a crossing keeps off the corners, so that no two can meet there

struct Root {
  std::uint32_t edge = 0;
  Vec3 low{0.0};
  double length = 0;
  float t_in = 0, t_out = 1;             // bracket, as the low end's and the high end's
  float f_low = 0, f_high = 0;
  float t = 0.5f;
  int last_side = 0;
};

/// Scratch of one thread.
class RootFinder {
 public:
  void find(const SurfaceOctree& tree, const PrunedField& field, const std::vector<MinimalEdge>& edges,
            const std::vector<std::uint32_t>& wanted, std::span<const std::uint32_t> items, std::vector<Crossing>& crossings) {
    roots_.clear();
    batch_.clear();
    for (const std::uint32_t item : items) {
      const std::uint32_t id = wanted[item];
      const MinimalEdge& edge = edges[id];
      Root root;
      root.edge = id;
      root.low = edge_point(tree, edge, 0);
      root.length = tree.edge(tree.leaves()[edge.owner()]);
      roots_.push_back(root);
      batch_.add(field, root.low);
      batch_.add(field, edge_point(tree, edge, 1));
    }
    batch_.evaluate_values(evaluator_, field);
    active_.resize(roots_.size());
    for (std::uint32_t i = 0; i < roots_.size(); ++i) {
      // The corners' signs were decided in double; a float may be on the other side by a rounding.
      const float side = edges[roots_[i].edge].low_inside ? 1.0f : -1.0f;
      roots_[i].f_low = side * std::max(side * batch_.value(2 * i), 1e-7f);
      roots_[i].f_high = -side * std::max(-side * batch_.value(2 * i + 1), 1e-7f);
      active_[i] = i;
    }
    for (int round = 0; round < kRootRounds && !active_.empty(); ++round) {
      narrow(edges, field, round >= kFalsiRounds && round % 2 == 0);
    }
    batch_.clear();
    for (Root& root : roots_) {
      root.t = std::clamp(root.t, kEndMargin, 1 - kEndMargin);
      batch_.add(field, at(edges, root));
    }
    batch_.evaluate_samples(evaluator_, field);
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      Crossing& crossing = crossings[roots_[i].edge];
      crossing.t = roots_[i].t;
      const glm::vec3 g = batch_.gradient(i);
      const float length = glm::length(g);
      if (std::isfinite(length) && length > 0) crossing.normal = g / -length;
    }
  }

 private:
  static Vec3 at(const std::vector<MinimalEdge>& edges, const Root& root) {
    Vec3 p = root.low;
    p[edges[root.edge].axis] += root.length * static_cast<double>(root.t);
    return p;
  }

  // Regula falsi with the Illinois rule, all edges of the cell side by side.
  void narrow(const std::vector<MinimalEdge>& edges, const PrunedField& field, bool halve) {
    batch_.clear();
    for (const std::uint32_t i : active_) {
      Root& r = roots_[i];
      const float t = r.t_in - r.f_low * (r.t_out - r.t_in) / (r.f_high - r.f_low);
      r.t = !halve && t >= r.t_in && t <= r.t_out ? t : 0.5f * (r.t_in + r.t_out);
      batch_.add(field, at(edges, r));
    }
    batch_.evaluate_values(evaluator_, field);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      Root& r = roots_[active_[k]];
      const float f = batch_.value(k);
      if (!(std::abs(f) > kRootValue)) continue;
      if ((f >= 0) == (r.f_low >= 0)) {
        r.t_in = r.t, r.f_low = f;
        if (r.last_side < 0) r.f_high *= 0.5f;
        r.last_side = -1;
      } else {
        r.t_out = r.t, r.f_high = f;
        if (r.last_side > 0) r.f_low *= 0.5f;
        r.last_side = 1;
      }
      if (r.t_out - r.t_in > kRootWidth) active_[kept++] = active_[k];
    }
    active_.resize(kept);
  }

  Evaluator evaluator_;
  FieldBatch batch_;
  std::vector<Root> roots_;
  std::vector<std::uint32_t> active_;
};

}  // namespace

bool find_crossings(const SurfaceOctree& tree, const SurfaceCover& cover, const std::vector<std::uint32_t>& edges,
                    Contour& contour, const RunOptions& run) {
  const Groups by_cell(cover.size(), edges.size(), [&](std::size_t i) { return tree.leaves()[contour.edges[edges[i]].owner()].cell; });
  tbb::enumerable_thread_specific<RootFinder> finders;
  tbb::parallel_for(std::size_t{0}, cover.size(), [&](std::size_t cell) {
    const auto items = by_cell.of(cell);
    if (items.empty() || run.cancelled()) return;
    finders.local().find(tree, cover.cube_field(cell), contour.edges, edges, items, contour.crossings);
  });
  return !run.cancelled();
}

}  // namespace cambium
