// Primary and shadow rays traced directly from the field, against Embree's own round linear curves over the same skeletons.
#include <fmt/format.h>
#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "bench/clock.h"
#include "bench/embree_curves.h"
#include "bench/generated_trees.h"
#include "bench/process_figures.h"
#include "bench/sections.h"
#include "raytrace/framing.h"
#include "raytrace/tracer.h"
#include "skeletons/surface.h"

namespace cambium::bench {
namespace {

constexpr int kWidth = 1536, kHeight = 2048, kTile = 16, kThreads = 2;
constexpr int kRounds = 5;                    // of both by turns; the best of each counts
constexpr double kOverEmbree = 3;             // targets: times Embree's time,
constexpr double kGrowth = 2.5;               // and the larger tree's time over the smaller one's
constexpr std::size_t kSizes[] = {10'000, 100'000};
const Vec3 kSun = glm::normalize(Vec3(0.55, -0.45, 0.7));

struct Picture {
  std::size_t hits = 0, shadowed = 0;
};

struct PictureTime {
  double seconds = kInfinity, processor_seconds = kInfinity;
  Picture picture;
};

/// One primary ray through the middle of each pixel and, where it hits, one towards the sun: trace_pixel says how.
template <class TracePixel>
PictureTime trace(const View& view, const TracePixel& trace_pixel) {
  PictureTime time;
  std::atomic<std::size_t> hits{0}, shadowed{0};
  const double processor_begin = processor_seconds_now();
  const double begin = seconds_now();
  tbb::task_arena(kThreads).execute([&] {
    tbb::parallel_for(tbb::blocked_range2d<int>(0, kHeight, kTile, 0, kWidth, kTile), [&](const auto& tile) {
      Picture part;
      for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
        for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) trace_pixel(view.ray(x + 0.5, y + 0.5), part);
      hits += part.hits;
      shadowed += part.shadowed;
    });
  });
  time.seconds = seconds_now() - begin;
  time.processor_seconds = processor_seconds_now() - processor_begin;
  time.picture = {hits, shadowed};
  return time;
}

void keep_best(PictureTime& best, const PictureTime& time) {
  best.seconds = std::min(best.seconds, time.seconds);
  best.processor_seconds = std::min(best.processor_seconds, time.processor_seconds);
  best.picture = time.picture;
}

/// One tree, both ways.
struct Race {
  PictureTime ours, embree;
  double cover_seconds = 0, build_seconds = 0, embree_build_seconds = 0;
  double bytes = 0, embree_bytes = 0;
  std::size_t cells = 0;
};

Field field_of(const Skeleton& skeleton) {
  SurfaceOptions options;
  options.lip = 1.5;
  return Field(surface(skeleton, options).tree);
}

Race race(std::size_t internodes) {
  const Skeleton skeleton = random_tree(internodes, 5);
  const Field field = field_of(skeleton);
  Race made;
  RunOptions run;
  run.threads = kThreads;
  reset_peak_resident_bytes();
  const std::size_t before = resident_bytes();
  SurfaceCover cover = timed(made.cover_seconds, [&] { return *cover_surface(field, tracing_cells(), run); });
  made.cells = cover.size();
  const std::vector<Box> boxes = surface_boxes(cover);
  const auto tracer = timed(made.build_seconds, [&] {
    return tbb::task_arena(kThreads).execute([&] { return std::make_unique<Tracer>(std::move(cover)); });
  });
  made.bytes = static_cast<double>(resident_bytes() - before);
  const auto curves = timed(made.embree_build_seconds, [&] {
    return tbb::task_arena(kThreads).execute([&] { return std::make_unique<EmbreeCurves>(skeleton); });
  });
  made.embree_bytes = static_cast<double>(curves->memory_bytes());

  const View view = frame({}, boxes, kWidth, kHeight);
  tbb::enumerable_thread_specific<Evaluator> evaluators;
  const auto our_pixel = [&](const Ray& ray, Picture& part) {
    Evaluator& evaluator = evaluators.local();
    const auto hit = tracer->intersect(evaluator, ray);
    if (!hit) return;
    ++part.hits;
    if (tracer->occluded(evaluator, {off_surface(ray, *hit), kSun})) ++part.shadowed;
  };
  const auto embree_pixel = [&](const Ray& ray, Picture& part) {
    const auto hit = curves->intersect(ray);
    if (!hit) return;
    ++part.hits;
    if (curves->occluded({ray.at(hit->t) + 1e-4 * hit->normal, kSun})) ++part.shadowed;
  };
  for (int round = 0; round < kRounds; ++round) {
    keep_best(made.ours, trace(view, our_pixel));
    keep_best(made.embree, trace(view, embree_pixel));
  }
  return made;
}

void add_rows(Report& report, std::size_t internodes, const Race& race) {
  report.heading(fmt::format("Rays at a tree of {} internodes, {}x{}, a primary and a shadow ray per pixel, {} threads", internodes, kWidth,
                             kHeight, kThreads));
  const auto ratio = [](double ours, double embree) { return ours / embree; };
  report.add({.what = "Embree's round linear curves, unblended", .figure = race.embree.seconds, .unit = "s"});
  report.add({.what = "the field", .figure = race.ours.seconds, .unit = "s", .ratio = ratio(race.ours.seconds, race.embree.seconds),
              .ratio_to = "Embree's", .target = at_most(kOverEmbree)});
  report.add({.what = "the field, processor time", .figure = race.ours.processor_seconds, .unit = "s",
              .ratio = ratio(race.ours.processor_seconds, race.embree.processor_seconds), .ratio_to = "Embree's"});
  report.add({.what = "cover", .figure = race.cover_seconds, .unit = "s"});
  report.add({.what = "hierarchy over it", .figure = race.build_seconds, .unit = "s",
              .ratio = ratio(race.build_seconds, race.embree_build_seconds), .ratio_to = "Embree's"});
  report.add({.what = "memory of both", .figure = race.bytes / 1e6, .unit = "MB", .ratio = ratio(race.bytes, race.embree_bytes),
              .ratio_to = "Embree's"});
  const double pixels = double(kWidth) * kHeight;
  report.note(fmt::format("{} cells; of the pixels {:.1f} % hit ({:.1f} % Embree's), {:.1f} % are in shadow ({:.1f} % Embree's)", race.cells,
                          100 * race.ours.picture.hits / pixels, 100 * race.embree.picture.hits / pixels,
                          100 * race.ours.picture.shadowed / pixels, 100 * race.embree.picture.shadowed / pixels));
}

}  // namespace

void rays_section(Report& report, const Pace&) {
  std::optional<Race> smaller;
  for (const std::size_t size : kSizes) {
    const Race now = race(size);
    add_rows(report, size, now);
    if (smaller) {
      report.add({.what = "time over that of the smaller tree", .ratio = now.ours.seconds / smaller->ours.seconds,
                  .ratio_to = "10^4", .target = at_most(kGrowth)});
      report.add({.what = "the same, processor time", .ratio = now.ours.processor_seconds / smaller->ours.processor_seconds,
                  .ratio_to = "10^4"});
    }
    smaller = now;
  }
}

}  // namespace cambium::bench
