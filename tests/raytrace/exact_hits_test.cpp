// No ray may miss a surface or report one that is not there: what the tracer says against a reference that knows nothing but values
// and intervals. Half of the rays only just touch a surface, or only just pass it.
//
// 20 random BlobTrees and the poplar of examples/. With CAMBIUM_EXHAUSTIVE=1 in the environment a million rays: a quarter of an hour
// of processor time.
#include "raytrace/tracer.h"

#include "lsystem/lsystem.h"
#include "blobtree/place_hash.h"
#include "skeletons/surface.h"
#include "tests/blobtree/random_blobtrees.h"
#include "tests/raytrace/sampled_surface.h"

#include <gtest/gtest.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {
namespace {

constexpr double kToleranceRadii = 1e-6;   // of the hit's place
constexpr double kMisplacedRadii = 1e-3;   // a hit that is later than this is another one, and the first was missed

bool is_exhaustive() {
  const char* const wish = std::getenv("CAMBIUM_EXHAUSTIVE");
  return wish && std::string_view(wish) == "1";
}

struct Subject {
  const Tracer& tracer;
  SampledSurface reference;
};

enum class Fault { kNone, kMiss, kFalseHit, kMisplaced, kShadowMissed, kFalseShadow };

/// What one ray came to.
struct Verdict {
  Fault fault = Fault::kNone;
  bool hit = false, analytic = false, touching = false;
  double t = 0;                 ///< the tracer's; infinite where it found nothing
  double early = 0, late = 0;   ///< between them a place is right; infinite where there is none
  double error = 0;             ///< of the place, in radii, where the ray does not only touch
};

/// The tracer's answers about a ray, first place and shadow, against the reference's.
class Judge {
 public:
  Judge(const Subject& subject, Evaluator& evaluator, const Ray& ray) : subject_(subject), evaluator_(evaluator), ray_(ray) {}

  Verdict operator()() {
    const auto hit = subject_.tracer.intersect(evaluator_, ray_);
    verdict_.hit = hit.has_value();
    verdict_.analytic = hit && hit->analytic;
    verdict_.t = hit ? hit->t : kInfinity;
    verdict_.early = reference(kIso - kTouching);
    const double tolerance = hit ? kToleranceRadii * hit->radius : 0;
    verdict_.fault = place_fault(hit.has_value(), hit ? hit->radius : 1);
    if (verdict_.fault == Fault::kNone) verdict_.fault = shadow_fault(tolerance);
    return verdict_;
  }

 private:
  double reference(double level) const { return subject_.reference.first_reaching(evaluator_, ray_, level).value_or(kInfinity); }
  bool occluded(double t_end) const { return subject_.tracer.occluded(evaluator_, ray_, t_end); }

  Fault place_fault(bool hit, double radius) {
    if (!hit && verdict_.early == kInfinity) return Fault::kNone;
    if (hit && std::abs(verdict_.t - verdict_.early) <= kToleranceRadii * radius) {
      verdict_.error = std::abs(verdict_.t - verdict_.early) / radius;
      return Fault::kNone;
    }
    if (verdict_.t < verdict_.early) return Fault::kFalseHit;
    verdict_.touching = true;
    verdict_.late = reference(kIso + kTouching);
    if (verdict_.late == kInfinity) return Fault::kNone;
    if (!hit || verdict_.t > verdict_.late + kMisplacedRadii * radius) return Fault::kMiss;
    return verdict_.t > verdict_.late + kToleranceRadii * radius ? Fault::kMisplaced : Fault::kNone;
  }

  /// Nothing stands before the first place that can be right, and something does up to the hit.
  Fault shadow_fault(double tolerance) {
    const double before = verdict_.early - tolerance;
    if (before > 0 && occluded(before)) return Fault::kFalseShadow;
    const bool deep = verdict_.t == 0 && !subject_.tracer.cover().find(ray_.origin);
    if (!verdict_.hit || occluded(deep ? kInfinity : verdict_.t + tolerance)) return Fault::kNone;
    verdict_.touching = true;
    verdict_.late = reference(kIso + kTouching);
    return verdict_.late <= verdict_.t ? Fault::kShadowMissed : Fault::kNone;
  }

  const Subject& subject_;
  Evaluator& evaluator_;
  const Ray& ray_;
  Verdict verdict_;
};

/// The rays that a tracer is tried with: each a function of its number alone.
class RayMix {
 public:
  RayMix(const Tracer& tracer, std::uint64_t seed) : tracer_(tracer), seed_(seed) {}

  /// Ten of twenty graze, six pass through at random, one along an axis, and three start off, on and under the surface.
  Ray ray(Evaluator& evaluator, std::size_t number) const {
    Draws draws(mix_bits(seed_) + number);
    draws = Draws(draws.next());
    const std::size_t kind = number % 20;
    Ray other = through(draws);
    if (kind >= 10 && kind < 16) return other;
    if (kind == 16) return along_an_axis(draws);
    auto hit = tracer_.intersect(evaluator, other);
    for (int tries = 0; tries < kTries && !(hit && hit->t > 0); ++tries) {
      other = through(draws);
      hit = tracer_.intersect(evaluator, other);
    }
    if (!hit) return other;
    if (kind < 10) return grazing(other, *hit, draws);
    if (kind == 17) return {off_surface(other, *hit), draws.direction()};
    if (kind == 18) return {other.at(hit->t), draws.direction()};
    return {other.at(hit->t) - std::pow(10.0, draws.in(-9, -0.5)) * hit->radius * hit->normal, draws.direction()};
  }

 private:
  static constexpr int kTries = 100;
  const Box& box() const { return tracer_.bounds(); }
  double far() const { return 1.5 * glm::length(box().size()); }

  /// From around the scene to a place in it.
  Ray through(Draws& draws) const {
    const Vec3 from = box().center() + far() * draws.direction();
    return {from, glm::normalize(draws.point(box()) - from)};
  }
  Ray along_an_axis(Draws& draws) const {
    Vec3 direction(0.0);
    direction[draws.below(3)] = draws.chance(0.5) ? 1 : -1;
    return {draws.point(box()) - far() * direction, direction};
  }
  /// Along the surface where another ray hits it, off by some part of the radius.
  Ray grazing(const Ray& other, const SurfaceHit& hit, Draws& draws) const {
    const Vec3 along = glm::normalize(glm::cross(hit.normal, draws.direction()));
    const double off = std::copysign(std::pow(10.0, draws.in(-9, -1.5)), draws.in(-1, 1)) * hit.radius;
    return {other.at(hit.t) + off * hit.normal - far() * along, along};
  }

  const Tracer& tracer_;
  std::uint64_t seed_;
};

std::string described(std::size_t number, const Ray& ray, const Verdict& verdict) {
  static constexpr const char* kNames[] = {"fine", "miss", "false hit", "misplaced", "shadow missed", "false shadow"};
  std::ostringstream out;
  out.precision(17);
  out << "ray " << number << ": " << kNames[static_cast<int>(verdict.fault)] << " at " << verdict.t << ", right from " << verdict.early << " to "
      << verdict.late << ", origin {" << ray.origin.x << ", " << ray.origin.y << ", " << ray.origin.z << "}, direction {" << ray.direction.x << ", "
      << ray.direction.y << ", " << ray.direction.z << "}\n";
  return out.str();
}

struct Count {
  std::size_t rays = 0, hits = 0, analytic = 0, touching = 0;
  double largest_error = 0;   // radii
  std::vector<std::string> faults;

  void add(const Verdict& verdict) {
    ++rays;
    hits += verdict.hit;
    analytic += verdict.analytic;
    touching += verdict.touching;
    largest_error = std::max(largest_error, verdict.error);
  }
  void add(const Count& other) {
    rays += other.rays;
    hits += other.hits;
    analytic += other.analytic;
    touching += other.touching;
    largest_error = std::max(largest_error, other.largest_error);
    faults.insert(faults.end(), other.faults.begin(), other.faults.end());
  }
};

Count trace_all(const Subject& subject, std::size_t rays, std::uint64_t seed) {
  const RayMix mix(subject.tracer, seed);
  struct Worker {
    Evaluator evaluator;
    Count count;
  };
  tbb::enumerable_thread_specific<Worker> workers;
  tbb::parallel_for(std::size_t{0}, rays, [&](std::size_t i) {
    auto& [evaluator, count] = workers.local();
    const Ray ray = mix.ray(evaluator, i);
    const Verdict verdict = Judge(subject, evaluator, ray)();
    count.add(verdict);
    if (verdict.fault != Fault::kNone) count.faults.push_back(described(i, ray, verdict));
  });
  Count all;
  for (const Worker& worker : workers) all.add(worker.count);
  return all;
}

void expect_exact(const Count& count, const std::string& what) {
  std::string faults;
  for (std::size_t i = 0; i < std::min<std::size_t>(count.faults.size(), 20); ++i) faults += count.faults[i];
  EXPECT_EQ(count.faults.size(), 0u) << what << '\n' << faults;
  EXPECT_GT(count.hits, count.rays / 10) << what;
}

void print(const Count& count, const std::string& what) {
  std::printf("%s: %zu rays, %zu hits (%zu in closed form), %zu faults, %zu only touch, farthest %.2g radii off\n", what.c_str(), count.rays, count.hits,
              count.analytic, count.faults.size(), count.touching, count.largest_error);
  std::fflush(stdout);
}

/// Some have cells, but hardly any surface.
bool is_worth_rays(const Tracer& tracer, std::uint64_t seed) {
  if (tracer.cover().empty()) return false;
  Evaluator evaluator;
  const RayMix mix(tracer, seed);
  int hits = 0;
  for (int i = 0; i < 50; ++i) hits += tracer.intersect(evaluator, mix.ray(evaluator, 20 * i + 10)).has_value();
  return hits >= 15;
}

/// Over so many of the trees that `make` gives by seed.
template <class Make>
void expect_exact_hits(int wanted, const Make& make) {
  const std::size_t rays = is_exhaustive() ? 45'000 : 100;
  Count all;
  int trees = 0;
  for (std::uint64_t seed = 1; trees < wanted; ++seed) {
    ASSERT_LT(seed, 1000u);
    const Field field(make(seed));
    const Tracer tracer(*cover_surface(field, {}, {}));
    if (!is_worth_rays(tracer, seed)) continue;
    ++trees;
    const Count count = trace_all({tracer, SampledSurface(field)}, rays, seed);
    const std::string what = "tree " + std::to_string(seed);
    expect_exact(count, what);
    print(count, what);
    all.add(count);
  }
  print(all, "all");
}

TEST(ExactHits, OnRandomBlobTrees) {
  expect_exact_hits(20, [](std::uint64_t seed) { return random_blobtree(seed, 4); });
}

TEST(ExactHits, OnNestsOfFlares) {
  expect_exact_hits(20, [](std::uint64_t seed) { return random_flared_blobtree(seed, 1 + static_cast<int>(seed % 3)); });
}

// A trunk that stands on its prongs and bears a limb: above its height it is met in closed form, below it is searched for.
TEST(ExactHits, OnAFlaredTrunk) {
  for (const double sharpness : {0.4, 0.95}) {
    BlobTreeBuilder b;
    const NodeId trunk = b.add(flared_trunk(5, sharpness)), limb = b.add(Chain{{{{0, 0, 1}, 0.12}, {{1, 0, 1.8}, 0.08}}});
    const Field field(b.build(b.add(Fork{trunk, {{limb, {0, 0, 1}, {0, 0, 1}, 0.07, 0.8}}})));
    const Tracer tracer(*cover_surface(field, tracing_cells(), {}));
    const Count count = trace_all({tracer, SampledSurface(field)}, is_exhaustive() ? 100'000 : 1'000, 3);
    expect_exact(count, "flared trunk");
    EXPECT_GT(count.analytic, 0u);
    EXPECT_LT(count.analytic, count.hits);
    print(count, "flared trunk");
  }
}

TEST(ExactHits, ARayThatStartsDeeperThanAnyCellIsAtItsFirstPlaceWhereItStarts) {
  BlobTreeBuilder builder;
  const Field ball(builder.build(builder.add(Sphere{{0, 0, 0}, 1})));
  CoverOptions cells;
  cells.cell = 0.05;
  const Tracer tracer(*cover_surface(ball, cells, {}));
  ASSERT_FALSE(tracer.cover().find({0, 0, 0}));
  Evaluator evaluator;
  Draws draws(3);
  for (int i = 0; i < 200; ++i) {
    const auto hit = tracer.intersect(evaluator, {0.8 * draws.in(0, 1) * draws.direction(), draws.direction()});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0);
  }
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
  const Field field(surface(interpret(*derive(system, {}, {}), system, {}, {})->skeleton, options).tree);
  const Tracer tracer(*cover_surface(field, tracing_cells(), {}));
  const Count count = trace_all({tracer, SampledSurface(field)}, is_exhaustive() ? 100'000 : 1'000, 2);
  expect_exact(count, "poplar");
  EXPECT_GT(count.analytic, count.hits / 4);
  print(count, "poplar");
}

}  // namespace
}  // namespace cambium
