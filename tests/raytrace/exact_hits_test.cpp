// No ray may miss a surface or report one that is not there: hits against dense sampling in which every stretch that is not sampled
// is certified empty by an interval. Half of the rays only just touch a surface, or only just pass it.
//
// 20 random BlobTrees and the poplar of examples/. With CAMBIUM_EXHAUSTIVE=1 in the environment a million rays.
#include "raytrace/tracer.h"

#include "lsystem/lsystem.h"
#include "skeletons/surface.h"
#include "tests/blobtree/random_blobtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace cambium {
namespace {

constexpr double kFinestRadii = 1e-3;     // stretches that no interval certifies are sampled when they are this short
constexpr double kNearTouching = 2e-3;    // and searched for their highest place where f is as near to the surface as this
constexpr double kTouching = 1e-9;        // of f: beyond, an answer is wrong
constexpr double kToleranceRadii = 2e-6;  // of the hit's place: 1e-6 of the radius to either side

bool is_exhaustive() {
  const char* const wish = std::getenv("CAMBIUM_EXHAUSTIVE");
  return wish && std::string_view(wish) == "1";
}

/// The field along one ray in one cell.
class AlongRay {
 public:
  AlongRay(Evaluator& evaluator, const PrunedField& field, const Ray& ray)
      : evaluator_(evaluator), field_(field), ray_(ray), finest_(kFinestRadii * radius_in(field)) {}

  double value(double t) const { return evaluator_.value(field_, ray_.at(t)); }

  /// Whether f is surely above kIso somewhere on the part.
  bool rises_above(const RaySegment& part) const {
    const double half = 0.5 * (part.end - part.begin), middle = part.begin + half;
    if (evaluator_.interval(field_, Ball{ray_.at(middle), half * (1 + 1e-9)}).hi < kIso) return false;
    if (2 * half > finest_) return rises_above({part.begin, middle}) || rises_above({middle, part.end});
    const double highest = std::max({value(part.begin), value(middle), value(part.end)});
    return highest > kIso + kTouching || (highest > kIso - kNearTouching && highest_on(part) > kIso + kTouching);
  }

 private:
  double highest_on(RaySegment part) const {
    for (int i = 0; i < 40; ++i) {
      const double a = part.begin + (part.end - part.begin) / 3, b = part.end - (part.end - part.begin) / 3;
      (value(a) < value(b) ? part.begin : part.end) = value(a) < value(b) ? a : b;
    }
    return value(0.5 * (part.begin + part.end));
  }

  Evaluator& evaluator_;
  const PrunedField& field_;
  const Ray& ray_;
  double finest_;
};

struct Count {
  std::size_t rays = 0, hits = 0, analytic = 0, misses = 0, false_hits = 0;
};

/// A scene, and all the cells that its surface is in: every one is tried for every ray, without any hierarchy.
struct Subject {
  explicit Subject(SurfaceCover cover) : tracer(std::move(cover)) {
    for (std::size_t i = 0; i < tracer.cover().size(); ++i) cells.push_back(tracer.cover().field(i));
  }
  Tracer tracer;
  std::vector<PrunedField> cells;
};

void check(const Subject& subject, Evaluator& evaluator, const Ray& ray, Count& count) {
  const auto hit = subject.tracer.intersect(evaluator, ray);
  ++count.rays;
  count.hits += hit.has_value();
  double before = kInfinity;
  if (hit) {
    count.analytic += hit->analytic;
    const PrunedField field = subject.tracer.cover().field(hit->cell);
    const double tolerance = kToleranceRadii * radius_in(field);
    const AlongRay along(evaluator, field, ray);
    before = hit->t - tolerance;
    if (std::max(along.value(hit->t), along.value(hit->t + 0.5 * tolerance)) < kIso - kTouching) ++count.false_hits;
  }
  for (const PrunedField& cell : subject.cells) {
    const auto part = clip(ray, cell.box(), {0, before});
    if (part && AlongRay(evaluator, cell, ray).rises_above(*part)) {
      ++count.misses;
      return;
    }
  }
  if (hit && !subject.tracer.occluded(evaluator, ray)) ++count.misses;
}

/// From around the scene to a place in it.
Ray random_ray(const Box& box, Draws& draws) {
  const Vec3 from = box.center() + 1.5 * glm::length(box.size()) * draws.direction();
  return {from, glm::normalize(draws.point(box) - from)};
}

/// Along the surface where another ray hits it, off by some part of the radius.
Ray grazing_ray(const Ray& other, const SurfaceHit& hit, double far, Draws& draws) {
  const Vec3 along = glm::normalize(glm::cross(hit.normal, draws.direction()));
  const double off = std::copysign(std::pow(10.0, draws.in(-9, -1.5)), draws.in(-1, 1)) * hit.radius;
  return {other.at(hit.t) + off * hit.normal - far * along, along};
}

Count trace_all(const Subject& subject, std::size_t rays, Draws& draws) {
  Evaluator evaluator;
  Count count;
  const Box& box = subject.tracer.bounds();
  while (count.rays < rays) {
    const Ray ray = random_ray(box, draws);
    check(subject, evaluator, ray, count);
    if (const auto hit = subject.tracer.intersect(evaluator, ray); hit && hit->t > 0) {
      for (int i = 0; i < 2; ++i) check(subject, evaluator, grazing_ray(ray, *hit, glm::length(box.size()), draws), count);
    }
  }
  return count;
}

void expect_exact(const Count& count, const std::string& what) {
  EXPECT_EQ(count.misses, 0u) << what;
  EXPECT_EQ(count.false_hits, 0u) << what;
  EXPECT_GT(count.hits, count.rays / 10) << what;
}

TEST(ExactHits, OnRandomBlobTrees) {
  constexpr int kTrees = 20;
  const std::size_t rays = is_exhaustive() ? 45'000 : 60;
  Evaluator evaluator;
  Count all;
  int trees = 0;
  for (std::uint64_t seed = 1; trees < kTrees; ++seed) {
    ASSERT_LT(seed, 1000u);
    const Field field(random_blobtree(seed, 4));
    auto cover = cover_surface(field, {}, {});
    if (cover->empty()) continue;
    const Subject subject(std::move(*cover));
    // Some have cells, but hardly any surface.
    Draws draws(seed);
    int probes = 0;
    for (int i = 0; i < 50; ++i) probes += subject.tracer.intersect(evaluator, random_ray(subject.tracer.bounds(), draws)).has_value();
    if (probes < 15) continue;
    ++trees;
    const Count count = trace_all(subject, rays, draws);
    expect_exact(count, "tree " + std::to_string(seed));
    all = {all.rays + count.rays, all.hits + count.hits, all.analytic + count.analytic, all.misses + count.misses, all.false_hits + count.false_hits};
  }
  RecordProperty("rays", std::to_string(all.rays));
  RecordProperty("hits", std::to_string(all.hits));
  std::printf("%zu rays, %zu hits, %zu misses, %zu false hits\n", all.rays, all.hits, all.misses, all.false_hits);
}

TEST(ExactHits, OnThePoplar) {
  const LSystem system = LSystem::load(CAMBIUM_SOURCE "/examples/poplar.l");
  SurfaceOptions options;
  options.lip = 1.5;
  options.random_scars = {14, 0.05};
  Prune prune;
  prune.where.branch = 4;
  prune.distance = 0.12;
  options.prunes = {prune};
  const Field field(surface(interpret(*derive(system, {}, {}), system, {}).skeleton, options).tree);
  auto cover = cover_surface(field, tracing_cells(), {});
  const Subject subject(std::move(*cover));
  Draws draws(2);
  const Count count = trace_all(subject, is_exhaustive() ? 100'000 : 300, draws);
  expect_exact(count, "poplar");
  EXPECT_GT(count.analytic, count.hits / 4);
  std::printf("%zu rays, %zu hits of which %zu in closed form, %zu misses, %zu false hits\n", count.rays, count.hits, count.analytic,
              count.misses, count.false_hits);
}

}  // namespace
}  // namespace cambium
