// What lights a picture, as it is asked for.
#pragma once

#include "blobtree/geometry.h"

#include <memory>
#include <optional>
#include <vector>

namespace cambium {

class Environment;  // one image of all that is around, loaded whole

// Light is measured so that 1 is the radiance of a white matt surface under 39.3 klx: 12,500 cd/m2. The colour of a lamp or of
// the sun, too, is what a white matt surface that faces it shows. Colours are linear sRGB.

/// A lamp with a shining surface, even and matt. It has no body: it casts no shadow.
struct AreaLight {
  enum class Shape { kRectangle, kDisc, kSphere };
  Shape shape = Shape::kRectangle;
  Vec3 position{0, 0, 3};          ///< of its middle, metres
  Vec3 direction{0, 0, -1};        ///< in which it shines; a sphere shines all round
  double width = 1, height = 1;    ///< of a rectangle, metres; the width lies level
  double radius = 0.5;             ///< of a disc or a sphere, metres
  Vec3 radiance{10.0};
  bool visible = true;             ///< to the camera
};

enum class SkyKind {
  kDaylight,    ///< a clear day's, by turbidity and the sun's height
  kGradient,    ///< from sky_horizon to sky_zenith
  kEnvironment  ///< an image's
};

enum class Backdrop { kSky, kTransparent, kColor };

struct Light {
  SkyKind sky = SkyKind::kDaylight;
  double turbidity = 3;                             ///< of daylight, 2 (very clear) to 10 (haze)
  Vec3 sky_zenith{0.24, 0.42, 0.80}, sky_horizon{0.72, 0.80, 0.90};   ///< of the gradient
  std::shared_ptr<const Environment> environment;   ///< needed by kEnvironment

  bool sun = true;
  double sun_azimuth = -0.7, sun_elevation = 0.75;  ///< radians
  double sun_size = 0.00465;                        ///< angular radius, radians
  std::optional<Vec3> sun_color;                    ///< unset: the daylight's through the air; else (2.7, 2.45, 2.05)

  std::vector<AreaLight> area;

  bool ground = true;                               ///< a plane that takes shadow at ground_height, and sends light back
  bool catcher = false;                             ///< the plane itself is not seen, only what shadow falls on it
  Vec3 ground_color{0.20, 0.185, 0.135};
  std::optional<double> ground_height;              ///< unset: the axis end of the lowest primitive (a trunk's root)

  Backdrop backdrop = Backdrop::kSky;               ///< what the camera sees behind everything; it lights nothing
  Vec3 backdrop_color{1.0};                         ///< of kColor
};

}  // namespace cambium
