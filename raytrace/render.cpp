#include "raytrace/render.h"

#include "blobtree/input_error.h"
#include "blobtree/surface_cover.h"
#include "raytrace/adaptive_sampling.h"
#include "raytrace/develop.h"
#include "raytrace/framing.h"
#include "raytrace/pixel_filter.h"
#include "raytrace/path_tracer.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <utility>

namespace cambium {
namespace {

class Stopwatch {
 public:
  /// Seconds since it was made or last asked.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(begin_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
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

std::string text_of(const PixelRect& r) {
  return std::to_string(r.x0) + "," + std::to_string(r.y0) + "," + std::to_string(r.x1) + "," + std::to_string(r.y1);
}

void check(const RenderOptions& options) {
  const auto require = [](bool good, const std::string& found, const std::string& expected) {
    if (!good) throw InputError({}, found, expected);
  };
  const auto side = [](int pixels) { return pixels >= 1 && pixels <= 65536; };
  require(side(options.width) && side(options.height),
          "an image of " + std::to_string(options.width) + "x" + std::to_string(options.height) + " pixels", "sizes from 1 to 65536");
  const Sampling& sampling = options.sampling;
  require(sampling.min >= 1 && sampling.min <= sampling.max && sampling.max <= kMostSamples,
          std::to_string(sampling.min) + ".." + std::to_string(sampling.max) + " samples",
          "1 to " + std::to_string(kMostSamples) + " per pixel, the smaller number first");
  require(sampling.noise >= 0, std::to_string(sampling.noise) + " as noise", "0 or more");
  require(sampling.filter_radius >= 0 && sampling.filter_radius <= kLargestFilter,
          "a filter of " + std::to_string(sampling.filter_radius) + " pixels", "a radius of 0 to " + std::to_string(kLargestFilter));
  if (!options.crop) return;
  const PixelRect whole{0, 0, options.width, options.height};
  require(!options.crop->empty() && whole.contains(*options.crop), "the crop " + text_of(*options.crop),
          "x0,y0,x1,y1 with x0 < x1, y0 < y1 within " + std::to_string(options.width) + "x" + std::to_string(options.height));
}

/// Camera rays through the pixels, shaded.
class CameraSamples : public SampleSource {
 public:
  CameraSamples(const View& view, const PathTracer& path_tracer, const Sampling& sampling, std::uint64_t seed)
      : view_(view), path_tracer_(path_tracer), filter_(sampling.filter_radius), seed_(seed) {}

  CameraSample sample(int x, int y, std::uint32_t index) const override {
    const PixelSampler sampler(seed_, x, y);
    const auto [dx, dy] = filter_.offset(sampler.pair(index, Use::kPixel));
    const double px = x + 0.5 + dx, py = y + 0.5 + dy;
    const Ray ray = view_.lens_radius > 0 ? view_.ray(px, py, sampler.pair(index, Use::kLens)) : view_.ray(px, py);
    return path_tracer_.sample(evaluators_.local(), ray, sampler, index);
  }

 private:
  const View& view_;
  const PathTracer& path_tracer_;
  PixelFilter filter_;
  std::uint64_t seed_;
  mutable tbb::enumerable_thread_specific<Evaluator> evaluators_;
};

double mean_samples(const Frame& frame, const PixelRect& crop) {
  double total = 0;
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x) total += frame.sum(x, y).samples;
  }
  return total / double(crop.size());
}

/// Runs work with as many threads as wanted.
template <typename Work>
auto with_threads(const RunOptions& run, const Work& work) {
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  return arena.execute(work);
}

}  // namespace

struct Renderer::Scene {
  Scene(const Field& of, SurfaceCover cover, FoliageScene leaves, const RunOptions& run)
      : field(of), boxes(surface_boxes(cover)), tracer(std::move(cover)) {
    for (const Box& box : boxes) bounds.extend(box);
    if (leaves.instances.empty()) return;
    foliage = std::make_unique<const FoliageTracer>(std::move(leaves), run);
    for (const Box& box : foliage->boxes())
      if (!box.empty()) boxes.push_back(box);
  }

  const Field& field;
  std::vector<Box> boxes;   ///< that hold the surface, and a leaf each
  Box bounds;               ///< of the surface
  Tracer tracer;
  std::unique_ptr<const FoliageTracer> foliage;   ///< null: none
  double seconds = 0;

  std::optional<Ground> ground(const Light& light) const {
    if (!light.ground) return std::nullopt;
    return Ground{light.ground_height.value_or(ground_height(field, bounds)), 1.0};
  }

  View view(const RenderOptions& options, const std::optional<Ground>& ground) const {
    std::vector<Box> framed = boxes;
    // What the ground hides is not framed.
    if (ground) std::erase_if(framed, [&](const Box& box) { return box.hi.z < ground->height; });
    return frame(options.camera, framed, options.width, options.height);
  }

  /// Metres from the camera over which the ground goes into the horizon.
  double fade(const View& view) const {
    if (bounds.empty()) return 9;
    return 9 * (glm::length(bounds.size()) + glm::length(view.eye - bounds.center()));
  }
};

Renderer::Renderer(std::unique_ptr<const Scene> scene) : scene_(std::move(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

std::optional<Renderer> Renderer::make(const Field& field, const RunOptions& run, FoliageScene foliage) {
  if (run.cancelled()) return std::nullopt;
  return with_threads(run, [&]() -> std::optional<Renderer> {
    Stopwatch watch;
    auto cover = cover_surface(field, tracing_cells(), run);
    if (!cover) return std::nullopt;
    auto scene = std::make_unique<Scene>(field, std::move(*cover), std::move(foliage), run);
    if (run.cancelled()) return std::nullopt;
    scene->seconds = watch.lap();
    return Renderer(std::move(scene));
  });
}

std::optional<Rendered> Renderer::render(const RenderOptions& options, const RunOptions& run, const PassFinished& pass_finished) const {
  check(options);
  return with_threads(run, [&]() -> std::optional<Rendered> {
    Stopwatch watch;
    std::optional<Ground> ground = scene_->ground(options.light);
    const View view = scene_->view(options, ground);
    if (ground) ground->fade = scene_->fade(view);
    const Bark bark(options.bark, options.seed);
    const PathTracer path_tracer(scene_->tracer, bark, options.light, ground, view.pixel_angle(), options.paths,
                                 scene_->foliage.get());

    const PixelRect whole{0, 0, options.width, options.height};
    const PixelRect crop = options.crop.value_or(whole);
    const PixelRect developed = developed_area(crop, whole, options.smooth);
    const PixelRect sampled = sampled_area(developed, whole, options.sampling);
    const PixelMask surface = silhouette(scene_->boxes, view, sampled, options.sampling.filter_radius);
    Frame frame(whole, sampled, {options.exposure, options.smooth, !options.aovs.empty()});

    Rendered out;
    out.report.samples = take_passes(frame, CameraSamples(view, path_tracer, options.sampling, options.seed), developed, surface,
                                     options.sampling, run, pass_finished);
    if (out.report.samples == 0) return std::nullopt;
    out.interrupted = out.report.samples < options.sampling.max;
    out.report.seconds_trace = watch.lap();
    out.film = develop(frame, crop, {options.exposure, options.smooth, view, options.light.backdrop == Backdrop::kTransparent, options.aovs});
    out.report.seconds_develop = watch.lap();
    out.report.seconds_cover = scene_->seconds;
    out.report.cells = scene_->tracer.cover().size();
    out.report.rays = frame.rays();
    out.report.samples_per_pixel = mean_samples(frame, crop);
    return out;
  });
}

std::optional<Rendered> render(const Field& field, const RenderOptions& options, const RunOptions& run,
                               const PassFinished& pass_finished) {
  check(options);
  const auto renderer = Renderer::make(field, run);
  if (!renderer) return std::nullopt;
  return renderer->render(options, run, pass_finished);
}

}  // namespace cambium
