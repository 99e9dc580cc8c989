// Direct ray tracing of the field, no mesh: stills with bark, sun, sky and ground.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "raytrace/bark.h"
#include "raytrace/camera.h"
#include "raytrace/film.h"
#include "raytrace/light.h"

#include <optional>

namespace cambium {

struct RenderOptions {
  int width = 768, height = 1024;
  int samples = 16;                        ///< most per pixel; adaptive by contrast
  Camera camera;
  Light light;
  std::vector<BarkMaterial> bark;          ///< by branch order, the last one goes on; empty: the built-in
  double exposure = 1;
  std::uint64_t seed = 0;
};

struct RenderReport {
  std::size_t cells = 0, rays = 0;
  double samples_per_pixel = 0;
  double seconds_cover = 0, seconds_trace = 0;
};

struct Rendered {
  Film film;
  RenderReport report;
};

/// nullopt if cancelled. Deterministic at any thread count. Errors: InputError for sizes < 1 or > 65536.
std::optional<Rendered> render(const Field& field, const RenderOptions& options, const RunOptions& run);

}  // namespace cambium
