#include "polygonize/verify.h"

#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "polygonize/fixed_random.h"
#include "polygonize/mesh_distance.h"
#include "polygonize/surface_distance.h"
#include "polygonize/surface_samples.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace cambium {
namespace {

void check_input(const Mesh& mesh, const VerifyOptions& options) {
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) {
    throw InputError({}, fmt::format("a tolerance of {:g}", options.tolerance), "a length, or 0 for none");
  }
  if (options.surface_samples == 0) throw InputError({}, "0 surface samples", "at least 1");
  if (options.mesh_samples && *options.mesh_samples == 0) throw InputError({}, "0 mesh samples", "at least 1");
  for (const Vec3& p : mesh.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw InputError({}, "a vertex that is nowhere", "finite coordinates");
    }
  }
  for (const auto& t : mesh.triangles) {
    const std::uint32_t v = std::max({t[0], t[1], t[2]});
    if (v >= mesh.positions.size()) {
      throw InputError({}, fmt::format("a triangle with vertex {}", v), fmt::format("one of {} vertices", mesh.positions.size()));
    }
  }
}

// Samples and their distances, in groups that threads take; in a fixed order.
struct Group {
  std::vector<double> distances;
  double max = -1;
  Vec3 max_at{0.0};

  void add(const Vec3& p, double distance) {
    distances.push_back(distance);
    if (distance > max) max = distance, max_at = p;
  }
};

DistanceFigures figures_of(const std::vector<Group>& groups, double tolerance) {
  DistanceFigures figures;
  std::vector<double> all;
  figures.max = -1;
  for (const Group& g : groups) {
    all.insert(all.end(), g.distances.begin(), g.distances.end());
    if (g.max > figures.max) figures.max = g.max, figures.max_at = g.max_at;
  }
  figures.max = std::max(figures.max, 0.0);
  figures.samples = all.size();
  if (all.empty()) return figures;
  const double n = static_cast<double>(all.size());
  double sum = 0;
  std::size_t within = 0, within_twice = 0;
  for (const double d : all) {
    sum += d;
    within += d <= tolerance;
    within_twice += d <= 2 * tolerance;
  }
  figures.mean = sum / n;
  if (tolerance > 0) {
    figures.within = static_cast<double>(within) / n;
    figures.within_twice = static_cast<double>(within_twice) / n;
  }
  const auto quantile = [&](double share) {   // the least distance that this share of the samples does not exceed
    const auto k = static_cast<std::ptrdiff_t>(std::ceil(share * n)) - 1;
    std::nth_element(all.begin(), all.begin() + k, all.end());
    return all[static_cast<std::size_t>(k)];
  };
  figures.p999 = quantile(0.999);
  figures.p99 = quantile(0.99);
  return figures;
}

// Whether points lie in cracks: straight out from them, the wood is back before `width`.
class CrackProbe {
 public:
  CrackProbe(const Field& field, double width) : field_(field), width_(width) {}

  /// Of neighbouring points on the surface: they share a pruned field, and the way out is one batch.
  std::vector<bool> in_cracks(std::span<const Vec3> points) {
    std::vector<bool> result(points.size(), false);
    if (points.empty()) return result;
    Box box;
    for (const Vec3& p : points) box.extend(p);
    const PrunedField near = field_.prune(box.padded(1.01 * width_));
    for (std::size_t i = 0; i < points.size(); ++i) result[i] = in_crack(near, points[i]);
    return result;
  }

 private:
  static constexpr std::size_t kSteps = 32;
  using Row = std::array<float, kSteps>;

  bool in_crack(const PrunedField& near, const Vec3& p) {
    const Vec3 gradient = evaluator_.sample(near, p).gradient;
    const double slope = glm::length(gradient);
    if (!(slope > 0)) return false;
    Row x, y, z, f;
    for (std::size_t i = 0; i < kSteps; ++i) {
      const Vec3 q = p - (width_ * static_cast<double>(i + 1) / kSteps / slope) * gradient - near.origin();
      x[i] = static_cast<float>(q.x);
      y[i] = static_cast<float>(q.y);
      z[i] = static_cast<float>(q.z);
    }
    evaluator_.values(near, x, y, z, f);
    return std::any_of(f.begin(), f.end(), [](float value) { return value >= static_cast<float>(kIso); });
  }

  const Field& field_;
  double width_;
  Evaluator evaluator_;
};

bool measure_surface_to_mesh(const Field& field, const SurfaceSamples& samples, const MeshDistance& mesh, double tolerance,
                             const RunOptions& run, Verification& result) {
  constexpr std::size_t kGroup = 256;
  std::vector<Group> groups((samples.points.size() + kGroup - 1) / kGroup), open(groups.size());
  ProgressMeter progress(run, "measuring from the surface");
  tbb::enumerable_thread_specific<CrackProbe> probes([&] { return CrackProbe(field, tolerance); });
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    const std::size_t begin = g * kGroup, end = std::min(samples.points.size(), begin + kGroup);
    std::vector<Vec3> beyond;
    double last = kInfinity;
    for (std::size_t i = begin; i < end && !run.cancelled(); ++i) {
      const Vec3& p = samples.points[i];
      // The last sample is near by, and its triangle not farther than it and the way between them.
      const double hint = i > begin ? last + glm::length(p - samples.points[i - 1]) : kInfinity;
      last = mesh(p, hint);
      groups[g].add(p, last);
      if (tolerance > 0 && last > tolerance) beyond.push_back(p);
    }
    if (run.cancelled()) return;
    const std::vector<bool> in_crack = probes.local().in_cracks(beyond);
    std::size_t next = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const double distance = groups[g].distances[i - begin];
      const bool was_probed = tolerance > 0 && distance > tolerance;
      if (!(was_probed && in_crack[next++])) open[g].add(samples.points[i], distance);
    }
    progress.add(1.0 / static_cast<double>(groups.size()));
  });
  if (run.cancelled()) return false;
  result.surface_to_mesh = figures_of(groups, tolerance);
  result.open_surface_to_mesh = figures_of(open, tolerance);
  result.in_cracks = result.surface_to_mesh.samples - result.open_surface_to_mesh.samples;
  return true;
}

// From the mesh's samples to the surface. Where the gradient does not lead there, or leads far, the nearest of the surface's own
// samples is the start of another search, and the ways around of a third.
class MeshToSurface {
 public:
  MeshToSurface(const Mesh& mesh, const Field& field, const MeshDistance& places, const SurfaceSamples& surface, double tolerance)
      : mesh_(mesh), field_(field), places_(places.tree()), surface_(surface), owner_(mesh.positions.size(), 0),
        surface_tree_(surface.points.size(), [&](std::uint32_t i) { return Box{surface.points[i], surface.points[i]}; }),
        far_(tolerance > 0 ? std::min(tolerance, surface.spacing) : surface.spacing) {
    for (std::size_t i = mesh.triangles.size(); i-- > 0;)
      for (const std::uint32_t v : mesh.triangles[i]) owner_[v] = static_cast<std::uint32_t>(i);
  }

  /// `count` samples, or every vertex, edge midpoint and centroid.
  std::optional<DistanceFigures> measure(double tolerance, std::optional<std::size_t> count, const RunOptions& run) const {
    constexpr std::size_t kLeaves = 4;   // a few dozen triangles share a pruned field
    std::vector<Group> groups((places_.leaf_count() + kLeaves - 1) / kLeaves);
    const auto begin = [&](std::size_t g) { return places_.leaf_begin(g * kLeaves); };
    const auto end = [&](std::size_t g) { return places_.leaf_end(std::min(places_.leaf_count(), (g + 1) * kLeaves) - 1); };
    std::vector<double> area_before(groups.size() + 1, 0.0);
    if (count) {
      tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
        for (const std::uint32_t* i = begin(g); i != end(g); ++i) area_before[g + 1] += area(corners(*i));
      });
      for (std::size_t g = 0; g < groups.size(); ++g) area_before[g + 1] += area_before[g];
    }
    const double density = area_before.back() > 0 ? static_cast<double>(count.value_or(0)) / area_before.back() : 0;
    ProgressMeter progress(run, "measuring from the mesh");
    tbb::enumerable_thread_specific<SurfaceDistance> distances([&] { return SurfaceDistance(field_); });
    tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
      if (run.cancelled() || begin(g) == end(g)) return;
      Box box;
      for (const std::uint32_t* i = begin(g); i != end(g); ++i)
        for (const Vec3& p : corners(*i)) box.extend(p);
      const PrunedField near = field_.prune(box.padded(0.25 * glm::length(box.size())));
      const auto add = [&](const Vec3& p) {
        if (!run.cancelled()) groups[g].add(p, from(near, p, distances.local()));
      };
      if (count)
        scatter(begin(g), end(g), area_before[g], density, add);
      else
        std::for_each(begin(g), end(g), [&](std::uint32_t i) { sample_whole(i, add); });
      progress.add(1.0 / static_cast<double>(groups.size()));
    });
    if (run.cancelled()) return std::nullopt;
    return figures_of(groups, tolerance);
  }

 private:
  using Corners = std::array<Vec3, 3>;

  Corners corners(std::uint32_t i) const {
    const auto& t = mesh_.triangles[i];
    return {mesh_.positions[t[0]], mesh_.positions[t[1]], mesh_.positions[t[2]]};
  }
  static double area(const Corners& p) { return 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0])); }

  template <class Add>
  void sample_whole(std::uint32_t i, const Add& add) const {
    const auto& t = mesh_.triangles[i];
    const Corners p = corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      if (owner_[t[k]] == i) add(p[k]);
      if (t[k] < t[(k + 1) % 3]) add(0.5 * (p[k] + p[(k + 1) % 3]));   // the triangle across has it the other way round
    }
    add((p[0] + p[1] + p[2]) / 3.0);
  }

  // One sample to each 1 / density of area, counted from the mesh's first triangle.
  template <class Add>
  void scatter(const std::uint32_t* begin, const std::uint32_t* end, double before, double density, const Add& add) const {
    for (const std::uint32_t* i = begin; i != end; ++i) {
      const Corners p = corners(*i);
      const double after = before + area(p);
      const auto last = static_cast<std::uint64_t>(after * density + 0.5);
      for (auto n = static_cast<std::uint64_t>(before * density + 0.5); n < last; ++n) {
        double u = chance(n, 0, 0, 0), v = chance(n, 1, 0, 0);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        add(p[0] + u * (p[1] - p[0]) + v * (p[2] - p[0]));
      }
      before = after;
    }
  }

  double from(const PrunedField& near, const Vec3& p, SurfaceDistance& distance) const {
    const auto foot = distance.nearest(near, p);
    double best = foot ? foot->distance : kInfinity;
    if (!(best > far_)) return best;
    std::uint32_t nearest = 0;
    double least = kInfinity;
    surface_tree_.nearest2(p, kInfinity, [&](std::uint32_t i) {
      const Vec3 d = p - surface_.points[i];
      const double distance2 = glm::dot(d, d);
      if (distance2 < least) least = distance2, nearest = i;
      return distance2;
    });
    if (least < kInfinity) best = std::min(best, distance.slide(near, p, surface_.points[nearest]).distance);
    if (!(best > far_ && best < kInfinity)) return best;
    const auto other = distance.around(near, p, best);
    return other ? std::min(best, other->distance) : best;
  }

  const Mesh& mesh_;
  const Field& field_;
  const BoxTree& places_;
  const SurfaceSamples& surface_;
  std::vector<std::uint32_t> owner_;       // of a vertex: the triangle that measures it
  BoxTree surface_tree_;
  double far_;
};

std::optional<Verification> verify_in_arena(const Mesh& mesh, const Field& field, const VerifyOptions& options,
                                            const RunOptions& run) {
  Verification result;
  const auto topology = check_topology(mesh, run);
  if (!topology) return std::nullopt;
  result.topology = *topology;
  if (options.self_intersections) {
    const auto pairs = self_intersections(mesh, run);
    if (!pairs) return std::nullopt;
    result.self_intersections = pairs->size();
  }
  const auto surface = sample_surface(field, options.surface_samples, run);
  if (!surface) return std::nullopt;
  const MeshDistance to_mesh(mesh);
  if (!measure_surface_to_mesh(field, *surface, to_mesh, options.tolerance, run, result)) return std::nullopt;
  const MeshToSurface mesh_to_surface(mesh, field, to_mesh, *surface, options.tolerance);
  const auto from_mesh = mesh_to_surface.measure(options.tolerance, options.mesh_samples, run);
  if (!from_mesh) return std::nullopt;
  result.mesh_to_surface = *from_mesh;
  return result;
}

}  // namespace

std::optional<Verification> verify_mesh(const Mesh& mesh, const Field& field, const VerifyOptions& options, const RunOptions& run) {
  check_input(mesh, options);
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return verify_in_arena(mesh, field, options, run); });
}

}  // namespace cambium
