// A clear day's sky and sun (Preetham, Shirley and Smits 1999, "A practical analytic model for daylight").
#pragma once

#include "blobtree/geometry.h"

#include <array>

namespace cambium {

/// Radiance of the sky by direction: Perez distributions of luminance and chromaticity, in linear sRGB and in light.h's unit of
/// 12,500 cd/m2. Colours outside sRGB are clipped to it.
class Daylight {
 public:
  /// Near the horizon the paper's fit lies on the pink side of the colours that daylight has; there they are put on the line of
  /// those (Judd, MacAdam and Wyszecki 1964).
  /// turbidity is clamped to [2, 10]. Below the horizon the sun leaves the colours of its setting, fading to a hundredth at 6
  /// degrees (the end of civil twilight).
  Daylight(double turbidity, const Vec3& towards_sun);

  /// Of a unit direction; below the horizon that of the horizon. Cost: about 100 ns.
  Vec3 radiance(const Vec3& direction) const;

 private:
  /// F(theta, gamma) = (1 + A exp(B / cos theta)) (1 + C exp(D gamma) + E cos^2 gamma), eq. 3.
  struct Perez {
    double a, b, c, d, e;
    double operator()(double cos_theta, double gamma, double cos_gamma) const;
  };
  struct Distribution {
    Perez perez;
    double scale;     ///< zenith's value over F towards it
  };
  Vec3 sun_;
  std::array<Distribution, 3> xyY_;
};

/// What a white matt surface shows that faces the sun: its spectrum through Rayleigh scattering, aerosol, ozone, mixed gases and
/// water vapour. elevation in radians; 0 once a disc of that angular radius has set. turbidity as Daylight's.
Vec3 daylight_sun(double turbidity, double elevation, double angular_radius);

}  // namespace cambium
