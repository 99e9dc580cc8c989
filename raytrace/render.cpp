#include "raytrace/render.h"

#include "blobtree/input_error.h"
#include "blobtree/surface_cover.h"
#include "raytrace/framing.h"
#include "raytrace/path_tracer.h"
#include "raytrace/smoothing.h"
#include "raytrace/tone.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <utility>

namespace cambium {
namespace {

constexpr int kBaseSamples = 4;
constexpr int kTile = 16;
constexpr std::size_t kMostCells = 4000000;   // of a cover: beyond, its hierarchy would take more memory than it saves time
constexpr double kContrast = 0.035;   // of displayed luminance between neighbours, above which a pixel is refined

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Sums over a pixel's samples.
struct PixelSum {
  glm::vec3 direct{0.0f}, albedo{0.0f}, lit{0.0f}, normal{0.0f};
  float depth = 0, branch = -1;
  float shown = 0, shown_squared = 0;  // displayed luminance without the sky's noise
  std::uint16_t hits = 0, samples = 0;

  /// Standard error of the displayed luminance.
  double error() const {
    const double n = samples, mean = shown / n;
    return std::sqrt(std::max(0.0, shown_squared / n - mean * mean) / n);
  }
};

class Progress {
 public:
  Progress(const RunOptions& run, double total) : run_(run), total_(total) {}
  void add(double amount) {
    if (!run_.progress) return;
    const std::scoped_lock lock(mutex_);
    done_ += amount;
    run_.progress("render", std::min(1.0, done_ / total_));
  }

 private:
  const RunOptions& run_;
  std::mutex mutex_;
  double total_ = 1, done_ = 0;
};

class Frame {
 public:
  Frame(const RenderOptions& options, const View& view, const PathTracer& paths, const RunOptions& run)
      : options_(options), view_(view), paths_(paths), run_(run), sums_(std::size_t(options.width) * options.height) {}

  /// Takes samples first..last-1 of every wanted pixel (all if wanted is empty). False if cancelled.
  bool take(int first, int last, const std::vector<std::uint8_t>& wanted, Progress& progress) {
    const int across = (options_.width + kTile - 1) / kTile, down = (options_.height + kTile - 1) / kTile;
    tbb::parallel_for(0, across * down, [&](int tile) {
      Evaluator& evaluator = evaluators_.local();
      const int x0 = tile % across * kTile, y0 = tile / across * kTile;
      const int x1 = std::min(x0 + kTile, options_.width), y1 = std::min(y0 + kTile, options_.height);
      std::size_t rays = 0;
      int pixels = 0;
      for (int y = y0; y < y1 && !run_.cancelled(); ++y) {
        for (int x = x0; x < x1; ++x) {
          const std::size_t i = index(x, y);
          if (!wanted.empty() && !wanted[i]) continue;
          ++pixels;
          for (int s = first; s < last; ++s) rays += add_sample(evaluator, x, y, static_cast<std::uint32_t>(s), sums_[i]);
        }
      }
      rays_ += rays;
      progress.add(double(pixels) * (last - first));
    });
    return !run_.cancelled();
  }

  /// Pixels whose finished samples or neighbours differ enough to be seen.
  std::vector<std::uint8_t> contrasted() const {
    std::vector<std::uint8_t> wanted(sums_.size());
    tbb::parallel_for(0, options_.height, [&](int y) {
      for (int x = 0; x < options_.width; ++x) {
        const PixelSum& sum = sums_[index(x, y)];
        const double mean = sum.shown / sum.samples;
        bool edge = false;
        // Where a pixel's own samples disagree, its neighbours two away may only have been lucky: the rim of a soft shadow.
        for (int dy = -2; dy <= 2 && !edge; ++dy) {
          for (int dx = -2; dx <= 2 && !edge; ++dx) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= options_.width || ny >= options_.height) continue;
            const PixelSum& other = sums_[index(nx, ny)];
            edge = other.error() > 0.5 * kContrast;
            if (std::abs(dx) > 1 || std::abs(dy) > 1) continue;
            edge |= std::abs(other.shown / other.samples - mean) > kContrast || (other.hits == 0) != (sum.hits == 0);
          }
        }
        wanted[index(x, y)] = edge;
      }
    });
    return wanted;
  }

  std::optional<Film> develop() const {
    const std::size_t count = sums_.size();
    std::vector<PixelMean> means(count);
    for (std::size_t i = 0; i < count; ++i) {
      const PixelSum& sum = sums_[i];
      const float n = sum.samples;
      const float length = glm::length(sum.normal);
      means[i] = {sum.direct / n, sum.albedo / n, sum.lit / n, length > 0 ? sum.normal / length : glm::vec3(0.0f),
                  sum.hits ? sum.depth / sum.hits : static_cast<float>(kInfinity), sum.hits / n};
    }
    const auto ambient = smooth_ambient(means, options_.width, options_.height, view_.pixel_angle(), run_);
    if (ambient.empty()) return std::nullopt;
    Film film;
    film.width = options_.width;
    film.height = options_.height;
    film.color.reserve(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3 color = static_cast<float>(options_.exposure) * (means[i].direct + ambient[i]);
      const glm::vec3 albedo = sums_[i].hits ? sums_[i].albedo / float(sums_[i].hits) : glm::vec3(0.0f);
      film.color.insert(film.color.end(), {color.x, color.y, color.z, 1.0f});
      film.depth.push_back(means[i].depth);
      film.normal.insert(film.normal.end(), {means[i].normal.x, means[i].normal.y, means[i].normal.z});
      film.albedo.insert(film.albedo.end(), {albedo.x, albedo.y, albedo.z});
      film.branch.push_back(sums_[i].branch);
    }
    return film;
  }

  std::size_t rays() const { return rays_; }
  double samples_per_pixel() const {
    double total = 0;
    for (const PixelSum& sum : sums_) total += sum.samples;
    return total / double(sums_.size());
  }

 private:
  std::size_t index(int x, int y) const { return std::size_t(y) * options_.width + x; }

  int add_sample(Evaluator& evaluator, int x, int y, std::uint32_t s, PixelSum& sum) const {
    const PixelSampler sampler(options_.seed, x, y);
    const auto [jx, jy] = sampler.pair(s, Use::kPixel);
    const CameraSample sample = paths_.sample(evaluator, view_.ray(x + jx, y + jy), sampler, s);
    sum.direct += glm::vec3(sample.direct);
    sum.albedo += glm::vec3(sample.albedo);
    sum.lit += glm::vec3(sample.albedo * sample.ambient);
    if (sample.depth < kInfinity) {
      sum.normal += glm::vec3(sample.normal);
      sum.depth += static_cast<float>(sample.depth);
      ++sum.hits;
    }
    if (sum.samples == 0) sum.branch = static_cast<float>(sample.branch);
    ++sum.samples;
    // The sky at its mean, so that only edges, texture and the sun's shadow count as contrast.
    const Vec3 even = sample.direct + 0.45 * sample.albedo;
    const double shown = luminance(display_from_linear(options_.exposure * even));
    sum.shown += static_cast<float>(shown);
    sum.shown_squared += static_cast<float>(shown * shown);
    return sample.rays;
  }

  const RenderOptions& options_;
  const View& view_;
  const PathTracer& paths_;
  const RunOptions& run_;
  std::vector<PixelSum> sums_;
  tbb::enumerable_thread_specific<Evaluator> evaluators_;
  std::atomic<std::size_t> rays_{0};
};

/// Where the lowest primitive's axis ends: a trunk's chain starts at the root, and its round end lies below it.
double ground_height(const Field& field, const Box& surface) {
  double lowest = kInfinity, height = 0;
  for (std::uint32_t atom = 0; atom < field.atom_count(); ++atom) {
    const double radius = field.atom_radius(atom);
    const Box support = field.atom_bounds(atom);
    if (!(radius < kInfinity) || !support.bounded() || support.lo.z >= lowest) continue;
    lowest = support.lo.z;
    height = support.lo.z + kSupportPerRadius * radius;
  }
  if (lowest < kInfinity) return height;
  return surface.empty() ? 0 : surface.lo.z;
}

void check(const RenderOptions& options) {
  const auto bad = [](const std::string& found, const std::string& expected) { throw InputError({}, found, expected); };
  if (options.width < 1 || options.height < 1 || options.width > 65536 || options.height > 65536) {
    bad("an image of " + std::to_string(options.width) + "x" + std::to_string(options.height) + " pixels",
        "sizes from 1 to 65536");
  }
  if (options.samples < 1 || options.samples > 65535) bad(std::to_string(options.samples) + " samples", "1 to 65535 per pixel");
}

std::optional<Rendered> render_in_arena(const Field& field, const RenderOptions& options, const RunOptions& run) {
  Rendered out;
  const auto cover_start = Clock::now();
  CoverOptions cells;
  cells.max_cells = kMostCells;
  auto cover = cover_surface(field, cells, run);
  if (!cover) return std::nullopt;
  out.report.cells = cover->size();

  std::vector<Box> boxes = surface_boxes(*cover);
  Box whole;
  for (const Box& box : boxes) whole.extend(box);
  std::optional<Ground> ground;
  if (options.light.ground) ground = {options.light.ground_height.value_or(ground_height(field, whole)), 1.0};
  if (ground && !whole.empty()) {
    // What the ground hides is not framed.
    std::erase_if(boxes, [&](const Box& box) { return box.hi.z < ground->height; });
  }
  const View view = frame(options.camera, boxes, options.width, options.height);
  if (ground) {
    const double size = whole.empty() ? 1 : glm::length(whole.size());
    ground->fade = 9 * (size + (whole.empty() ? 0 : glm::length(view.eye - whole.center())));
  }
  const Tracer tracer(std::move(*cover));
  out.report.seconds_cover = seconds_since(cover_start);

  const auto trace_start = Clock::now();
  const Bark bark(options.bark, options.seed);
  const PathTracer paths(tracer, bark, options.light, ground, view.pixel_angle());
  Frame film(options, view, paths, run);
  const int base = std::min(kBaseSamples, options.samples);
  const double pixels = double(options.width) * options.height;
  Progress first(run, pixels * base * 2);
  if (!film.take(0, base, {}, first)) return std::nullopt;
  if (options.samples > base) {
    const auto wanted = film.contrasted();
    const auto count = static_cast<double>(std::count(wanted.begin(), wanted.end(), 1));
    const double extra = count * (options.samples - base);
    Progress second(run, 2 * std::max(extra, 1.0));
    second.add(std::max(extra, 1.0));
    if (!film.take(base, options.samples, wanted, second)) return std::nullopt;
  }
  auto developed = film.develop();
  if (!developed) return std::nullopt;
  out.film = std::move(*developed);
  out.report.rays = film.rays();
  out.report.samples_per_pixel = film.samples_per_pixel();
  out.report.seconds_trace = seconds_since(trace_start);
  return out;
}

}  // namespace

std::optional<Rendered> render(const Field& field, const RenderOptions& options, const RunOptions& run) {
  check(options);
  if (run.cancelled()) return std::nullopt;
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return render_in_arena(field, options, run); });
}

}  // namespace cambium
