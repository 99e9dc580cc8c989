// Direct ray tracing of the field, no mesh: stills with bark, sun, sky and ground.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "raytrace/bark.h"
#include "raytrace/camera.h"
#include "raytrace/film.h"
#include "raytrace/foliage_scene.h"
#include "raytrace/light.h"
#include "raytrace/path_options.h"
#include "raytrace/sampling.h"

#include <functional>
#include <memory>
#include <optional>

namespace cambium {

struct RenderOptions {
  int width = 768, height = 1024;
  std::optional<PixelRect> crop;           ///< the part to make, bit-identical to that part of the whole; unset: the whole
  Sampling sampling;
  Camera camera;
  Light light;
  PathOptions paths;
  std::vector<BarkMaterial> bark;          ///< by branch order, the last one goes on; empty: the built-in
  double exposure = 1;                     ///< what all light is multiplied with
  bool smooth = true;                      ///< the ambient light's noise, between pixels of one surface
  std::set<Aov> aovs;                      ///< what the film carries beside its colour
  std::uint64_t seed = 0;
};

struct RenderReport {
  std::size_t cells = 0, rays = 0;
  int samples = 0;                         ///< most that a pixel may have: sampling.max unless cancelled
  double samples_per_pixel = 0;            ///< mean over the film
  double seconds_cover = 0, seconds_trace = 0, seconds_develop = 0;
};

struct Rendered {
  Film film;
  RenderReport report;
  bool interrupted = false;                ///< cancelled: the film is that of the last finished pass
};

/// Called after each finished pass with the samples that pixels have by then, at most.
using PassFinished = std::function<void(int samples)>;

/// A field, and the leaves beside it, made ready for any number of pictures. Thread safe once made.
class Renderer {
 public:
  /// nullopt if cancelled. The field must outlive it. Cost: covering the surface, and Embree's hierarchy over it.
  /// Errors: InputError for foliage that refers to what is not there, or whose numbers are out of range.
  static std::optional<Renderer> make(const Field& field, const RunOptions& run, FoliageScene foliage = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// nullopt if cancelled before the first pass was finished; later, the picture has fewer samples, as if asked for with
  /// sampling.max = report.samples. Deterministic at any thread count.
  /// Errors: InputError for sizes, samples or a crop out of range.
  std::optional<Rendered> render(const RenderOptions& options, const RunOptions& run, const PassFinished& pass_finished = {}) const;

 private:
  struct Scene;
  explicit Renderer(std::unique_ptr<const Scene> scene);
  std::unique_ptr<const Scene> scene_;
};

/// One picture of a field, as Renderer's.
std::optional<Rendered> render(const Field& field, const RenderOptions& options, const RunOptions& run,
                               const PassFinished& pass_finished = {});

}  // namespace cambium
