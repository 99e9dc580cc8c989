#include "polygonize/polygon_distance.h"

#include "polygonize/field_batch.h"
#include "polygonize/groups.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// Scratch of one thread.
class PolygonSampler {
 public:
  PolygonSampler(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const std::vector<Vec3>& positions,
                 const std::vector<SplitPolygon>& polygons, std::vector<float>& distances)
      : tree_(tree), cover_(cover), contour_(contour), positions_(positions), polygons_(polygons), distances_(distances) {}

  void measure(std::size_t cell, std::span<const std::uint32_t> items) {
    cube_ = cover_.cube(cell);
    const PrunedField field = cover_.cube_field(cell);
    begin();
    for (const std::uint32_t item : items) add_polygon(field, item);
    finish(field);
    std::sort(strays_.begin(), strays_.end(), [](const Stray& a, const Stray& b) { return a.cell < b.cell; });
    for (std::size_t i = 0; i < strays_.size();) {
      const std::uint32_t other = strays_[i].cell;
      const PrunedField there = cover_.cube_field(other);
      begin();
      for (; i < strays_.size() && strays_[i].cell == other; ++i) take(there, strays_[i].item, strays_[i].at);
      finish(there);
    }
    strays_.clear();
  }

 private:
  /// A point of a polygon in another cell than its edge.
  struct Stray {
    std::uint32_t cell = 0, item = 0;
    Vec3 at{0.0};
  };

  void add_polygon(const PrunedField& field, std::uint32_t item) {
    const auto [edge, split] = polygons_[item];
    const Ring ring = ring_of(contour_.edges[edge], contour_.patch_of_quadrant[edge]);
    std::array<Vec3, 4> p;
    for (int k = 0; k < ring.count; ++k) p[k] = positions_[ring.patches[k]];
    const auto add = [&](const Vec3& at) {
      if (cube_.contains(at)) return take(field, item, at);
      if (const auto other = cover_.find(at)) strays_.push_back({static_cast<std::uint32_t>(*other), item, at});
    };
    for (int k = 0; k < ring.count; ++k) {
      const int next = (k + 1) % ring.count;
      if (!chord_known(contour_.vertices[ring.patches[k]], contour_.vertices[ring.patches[next]])) add((p[k] + p[next]) / 2.0);
    }
    if (split == Split::kFan) {
      const Vec3 center = crossing_point(tree_, contour_, edge);
      for (int k = 0; k < ring.count; ++k) {
        add((center + p[k]) / 2.0);
        add((center + p[k] + p[(k + 1) % ring.count]) / 3.0);
      }
      return;
    }
    const int k = split == Split::kSecond ? 1 : 0;
    add((p[k] + p[k + 1] + p[k + 2]) / 3.0);
    if (ring.count == 3) return;
    add((p[k] + p[k + 2] + p[(k + 3) % 4]) / 3.0);
    add((p[k] + p[k + 2]) / 2.0);
  }

  void begin() {
    batch_.clear();
    items_.clear();
  }
  void take(const PrunedField& field, std::uint32_t item, const Vec3& p) {
    batch_.add(field, p);
    items_.push_back(item);
  }
  void finish(const PrunedField& field) {
    if (items_.empty()) return;
    batch_.evaluate_samples(evaluator_, field);
    for (std::size_t i = 0; i < items_.size(); ++i) {
      const float off = std::abs(batch_.value(i)) / glm::length(batch_.gradient(i));
      if (std::isfinite(off)) distances_[items_[i]] = std::max(distances_[items_[i]], off);
    }
  }

  const SurfaceOctree& tree_;
  const SurfaceCover& cover_;
  const Contour& contour_;
  const std::vector<Vec3>& positions_;
  const std::vector<SplitPolygon>& polygons_;
  std::vector<float>& distances_;
  Box cube_;
  Evaluator evaluator_;
  FieldBatch batch_;
  std::vector<std::uint32_t> items_;
  std::vector<Stray> strays_;
};

}  // namespace

bool measure_polygons(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const std::vector<Vec3>& positions,
                      const std::vector<SplitPolygon>& polygons, std::vector<float>& distances, const RunOptions& run) {
  distances.assign(polygons.size(), 0.0f);
  const Groups by_cell(cover.size(), polygons.size(),
                       [&](std::size_t i) { return tree.leaves()[contour.edges[polygons[i].edge].owner()].cell; });
  tbb::enumerable_thread_specific<PolygonSampler> samplers(
      [&] { return PolygonSampler(tree, cover, contour, positions, polygons, distances); });
  tbb::parallel_for(std::size_t{0}, cover.size(), [&](std::size_t cell) {
    const auto items = by_cell.of(cell);
    if (items.empty() || run.cancelled()) return;
    samplers.local().measure(cell, items);
  });
  return !run.cancelled();
}

}  // namespace cambium
