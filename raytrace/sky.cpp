#include "raytrace/sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kUnit = 12.5;                  // kcd/m2 of radiance 1
constexpr double kExtraterrestrial = 133.3;     // klx, the sun's before the air (Darula, Kittler and Gueymard 2005)
constexpr double kLeastCosine = 0.01;           // of the zenith distance: nearer to the horizon the sky stays the same

/// Chromaticity y of daylight with that x (Judd, MacAdam and Wyszecki 1964).
double daylight_locus(double x) { return (2.870 - 3.000 * x) * x - 0.275; }

double clamped_turbidity(double turbidity) { return std::clamp(turbidity, 2.0, 10.0); }

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

Vec3 srgb_from_xyz(const Vec3& xyz) {
  const Vec3 rgb(glm::dot(xyz, Vec3(3.2406, -1.5372, -0.4986)), glm::dot(xyz, Vec3(-0.9689, 1.8758, 0.0415)),
                 glm::dot(xyz, Vec3(0.0557, -0.2040, 1.0570)));
  return glm::max(rgb, Vec3(0.0));
}

/// CIE 1931 observer at a wavelength in nm, as a sum of lopsided Gaussians (Wyman, Sloan and Shirley 2013).
Vec3 observer(double nm) {
  const auto lobe = [nm](double center, double below, double above) {
    const double t = (nm - center) / (nm < center ? below : above);
    return std::exp(-0.5 * t * t);
  };
  return {1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
          0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
          1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)};
}

/// The paper's tables at every 20 nm: the sun's radiance above the air (only its shape counts here), and absorption by ozone
/// (1/cm), by mixed gases and by water vapour.
struct SpectralLine {
  double nm, sun, ozone, gases, water;
};
constexpr SpectralLine kSpectrum[] = {
    {380, 165.5, 0, 0, 0},       {400, 211.2, 0, 0, 0},       {420, 258.2, 0, 0, 0},       {440, 267.6, 0, 0, 0},
    {460, 305.4, 0.006, 0, 0},   {480, 306.6, 0.014, 0, 0},   {500, 287.1, 0.030, 0, 0},   {520, 271.0, 0.048, 0, 0},
    {540, 263.6, 0.075, 0, 0},   {560, 250.6, 0.103, 0, 0},   {580, 253.5, 0.120, 0, 0},   {600, 246.3, 0.125, 0, 0},
    {620, 236.8, 0.090, 0, 0},   {640, 228.2, 0.048, 0, 0},   {660, 219.7, 0.018, 0, 0},   {680, 211.0, 0.009, 0, 0},
    {700, 202.4, 0, 0, 0.024},   {720, 194.3, 0, 0, 1.0},     {740, 186.3, 0, 0, 0.061},
};

/// Share of that line's light that passes `mass` times the air's thickness at the zenith (the paper's appendix A.1).
double transmitted(const SpectralLine& line, double mass, double turbidity) {
  constexpr double kAngstromExponent = 1.3, kOzone = 0.35, kWater = 2.0;   // the latter two in cm
  const double um = line.nm / 1000, beta = 0.04608 * turbidity - 0.04586;
  const double gases = line.gases * mass, water = line.water * kWater * mass;
  const double depth = 0.008735 * std::pow(um, -4.08) * mass + beta * std::pow(um, -kAngstromExponent) * mass +
                       line.ozone * kOzone * mass + 1.41 * gases / std::pow(1 + 118.93 * gases, 0.45) +
                       0.2385 * water / std::pow(1 + 20.07 * water, 0.45);
  return std::exp(-depth);
}

double smooth(double lo, double hi, double x) {
  const double t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double cubic(const std::array<double, 4>& c, double x) { return ((c[0] * x + c[1]) * x + c[2]) * x + c[3]; }

}  // namespace

double Daylight::Perez::operator()(double cos_theta, double gamma, double cos_gamma) const {
  return (1 + a * std::exp(b / cos_theta)) * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
}

Daylight::Daylight(double turbidity, const Vec3& towards_sun) {
  const double t = clamped_turbidity(turbidity), elevation = std::asin(std::clamp(towards_sun.z, -1.0, 1.0));
  const double flat = std::hypot(towards_sun.x, towards_sun.y);
  const Vec3 on_horizon = flat > 0 ? Vec3(towards_sun.x / flat, towards_sun.y / flat, 0) : Vec3(1, 0, 0);
  sun_ = elevation > 0 ? towards_sun : on_horizon;
  const double theta = std::acos(std::clamp(sun_.z, 0.0, 1.0)), chi = (4.0 / 9 - t / 120) * (std::numbers::pi - 2 * theta);
  const double x = t * t * cubic({0.00166, -0.00375, 0.00209, 0}, theta) +
                   t * cubic({-0.02903, 0.06377, -0.03202, 0.00394}, theta) +
                   cubic({0.11693, -0.21196, 0.06052, 0.25886}, theta);
  const double y = t * t * cubic({0.00275, -0.00610, 0.00317, 0}, theta) +
                   t * cubic({-0.04214, 0.08970, -0.04153, 0.00516}, theta) +
                   cubic({0.15346, -0.26756, 0.06670, 0.26688}, theta);
  const double twilight = std::pow(0.01, std::max(0.0, -degrees(elevation)) / 6);
  const double luminance = std::max(0.0, (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192) / kUnit * twilight;
  const Perez perez[3] = {
      {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
      {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529},
      {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703}};
  const double zenith[3] = {x, y, luminance};
  for (int i = 0; i < 3; ++i) xyY_[i] = {perez[i], zenith[i] / perez[i](1, theta, std::cos(theta))};
}

Vec3 Daylight::radiance(const Vec3& direction) const {
  const double cos_theta = std::max(direction.z, kLeastCosine), cos_gamma = std::clamp(glm::dot(direction, sun_), -1.0, 1.0);
  const double gamma = std::acos(cos_gamma);
  double xyY[3];
  for (int i = 0; i < 3; ++i) xyY[i] = xyY_[i].scale * xyY_[i].perez(cos_theta, gamma, cos_gamma);
  const double x = std::clamp(xyY[0], 0.0, 0.8), y = std::clamp(std::max(xyY[1], daylight_locus(x)), 0.05, 0.8), over = std::max(0.0, xyY[2]) / y;
  return srgb_from_xyz({x * over, y * over, std::max(0.0, 1 - x - y) * over});
}

Vec3 daylight_sun(double turbidity, double elevation, double angular_radius) {
  const double above = std::max(0.0, degrees(elevation));
  const double mass = 1 / (std::sin(above * std::numbers::pi / 180) + 0.15 * std::pow(above + 3.885, -1.253));
  Vec3 through(0.0);
  double before = 0;
  for (const SpectralLine& line : kSpectrum) {
    const Vec3 seen = line.sun * observer(line.nm);
    through += transmitted(line, mass, clamped_turbidity(turbidity)) * seen;
    before += seen.y;
  }
  const double risen = angular_radius > 0 ? smooth(-angular_radius, angular_radius, elevation) : (elevation > 0 ? 1.0 : 0.0);
  return risen * kExtraterrestrial / (std::numbers::pi * kUnit) / before * srgb_from_xyz(through);
}

}  // namespace cambium
