// Direct ray tracing of the field, no mesh: stills with bark, sun, sky and ground.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "raytrace/bark.h"
#include "raytrace/film.h"

#include <optional>

namespace cambium {

struct Camera {
  std::optional<Vec3> eye, target;         ///< unset: framed on the field (or on `frame`)
  std::optional<Box> frame;                ///< what to frame instead of the whole field
  double azimuth = 0.6, elevation = 0.05;  ///< radians, direction from which an automatic camera looks
  double field_of_view = 0.61;             ///< radians, vertical
  double margin = 1.06;                    ///< of automatic framing
};

struct Light {
  double sun_azimuth = -0.7, sun_elevation = 0.75;  ///< radians
  double sun_size = 0.01;                           ///< angular radius, radians
  Vec3 sun_color{2.7, 2.45, 2.05};                   ///< linear
  Vec3 sky_zenith{0.24, 0.42, 0.80}, sky_horizon{0.72, 0.80, 0.90};
  Vec3 ground_color{0.20, 0.185, 0.135};
  bool ground = true;                               ///< a plane that takes shadow at ground_height
  std::optional<double> ground_height;              ///< unset: the axis end of the lowest primitive (a trunk's root)
};

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
