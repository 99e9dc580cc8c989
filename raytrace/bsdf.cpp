#include "raytrace/bsdf.h"

#include "raytrace/directions.h"
#include "raytrace/tone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNormalReflectance = 0.04;   // of index 1.5
constexpr double kLeastAlpha = 0.02;
constexpr double kLeastCosine = 1e-3;         // of the direction out to the shading normal

/// Schlick 1994.
double fresnel(double cosine) {
  const double c = std::clamp(1 - cosine, 0.0, 1.0), c2 = c * c;
  return kNormalReflectance + (1 - kNormalReflectance) * c2 * c2 * c;
}

double ggx(double cosine, double alpha) {
  const double a2 = alpha * alpha, d = (a2 - 1) * cosine * cosine + 1;
  return a2 / (kPi * d * d);
}

/// Smith's Lambda for GGX, of a local direction.
double smith(const Vec3& v, double alpha) {
  const double c2 = v.z * v.z;
  return 0.5 * (std::sqrt(1 + alpha * alpha * std::max(0.0, 1 - c2) / c2) - 1);
}

/// A microfacet's normal among those seen from `out` (Dupuy and Benyoub 2023).
Vec3 seen_facet(const Vec3& out, double alpha, const std::array<double, 2>& sample) {
  const Vec3 stretched = glm::normalize(Vec3(alpha * out.x, alpha * out.y, out.z));
  const double angle = 2 * kPi * sample[0], z = (1 - sample[1]) * (1 + stretched.z) - stretched.z;
  const double flat = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
  const Vec3 half = Vec3(flat * std::cos(angle), flat * std::sin(angle), z) + stretched;
  return glm::normalize(Vec3(alpha * half.x, alpha * half.y, std::max(1e-9, half.z)));
}

/// The coat's albedo over the cosine and alpha, and its mean over the cosine.
class CoatTable {
 public:
  static constexpr int kCosines = 32, kAlphas = 16;

  CoatTable() {
    for (int a = 0; a < kAlphas; ++a) {
      for (int c = 0; c < kCosines; ++c) albedo_[a][c] = integrated(cosine_at(c), alpha_at(a));
      // Of the table's own straight lines between the cosines: then a white body gives back exactly all.
      double mean = 0;
      for (int c = 0; c + 1 < kCosines; ++c) {
        const double x0 = cosine_at(c), x1 = cosine_at(c + 1), y0 = albedo_[a][c], y1 = albedo_[a][c + 1];
        mean += (x1 - x0) * (y0 * (2 * x0 + x1) + y1 * (x0 + 2 * x1)) / 3;
      }
      mean_[a] = mean;
    }
  }

  double albedo(double cosine, double alpha) const {
    const auto [a, s] = part(alpha, kAlphas);
    const auto [c, t] = part(cosine, kCosines);
    return (1 - s) * ((1 - t) * albedo_[a][c] + t * albedo_[a][c + 1]) + s * ((1 - t) * albedo_[a + 1][c] + t * albedo_[a + 1][c + 1]);
  }
  double mean(double alpha) const {
    const auto [a, s] = part(alpha, kAlphas);
    return (1 - s) * mean_[a] + s * mean_[a + 1];
  }

 private:
  struct Part {
    int index;
    double rest;
  };
  static Part part(double x, int count) {
    const double scaled = std::clamp(x, 0.0, 1.0) * (count - 1);
    const int index = std::min(static_cast<int>(scaled), count - 2);
    return {index, scaled - index};
  }
  static double cosine_at(int i) { return double(i) / (kCosines - 1); }
  static double alpha_at(int i) { return double(i) / (kAlphas - 1); }

  static double integrated(double cosine, double alpha) {
    constexpr int kSide = 24;
    const double c = std::max(cosine, kLeastCosine), a = std::max(alpha, kLeastAlpha);
    const Vec3 out(std::sqrt(1 - c * c), 0, c);
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec3 half = seen_facet(out, a, {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
      const double toward = glm::dot(out, half);
      const Vec3 in = 2 * toward * half - out;
      if (!(in.z > 0)) continue;
      sum += fresnel(toward) * (1 + smith(out, a)) / (1 + smith(out, a) + smith(in, a));
    }
    return sum / (kSide * kSide);
  }

  double albedo_[kAlphas][kCosines];
  double mean_[kAlphas];
};

const CoatTable& coat_table() {
  static const CoatTable table;
  return table;
}

}  // namespace

double coat_albedo(double cosine, double alpha) { return coat_table().albedo(cosine, alpha); }
double mean_coat_albedo(double alpha) { return coat_table().mean(alpha); }

Bsdf::Bsdf(const Surface& surface, const Vec3& out)
    : geometric_(surface.normal), n_(surface.shading_normal), coated_(surface.coated) {
  const double facing = glm::dot(n_, out);
  if (facing < kLeastCosine) n_ = glm::normalize(n_ + (kLeastCosine * 1.01 - facing) * out);
  const auto [s, t] = tangents(n_);
  s_ = s;
  t_ = t;
  out_ = local(out);
  alpha_ = std::clamp(surface.roughness * surface.roughness, kLeastAlpha, 1.0);
  const double mirrored = coated_ ? coat_albedo(out_.z, alpha_) : 0;
  const double coats = kPi * (1 - (coated_ ? mean_coat_albedo(alpha_) : 0));
  body_ = surface.albedo * (1 - mirrored) / coats;
  Vec3 from_body = surface.albedo * (1 - mirrored);
  if (surface.through != Vec3(0.0)) {
    through_ = surface.through * (1 - mirrored) / coats;
    through_share_ = luminance(surface.through) / std::max(1e-9, luminance(surface.through + surface.albedo));
    from_body += surface.through * (1 - mirrored);
  }
  reflectance_ = mirrored + from_body;
  coat_share_ = coated_ ? mirrored / (mirrored + std::max(luminance(from_body), 1e-3)) : 0;
}

double Bsdf::coat_value(const Vec3& in) const {
  const Vec3 half = glm::normalize(in + out_);
  const double masked = 1 + smith(out_, alpha_) + smith(in, alpha_);
  return ggx(half.z, alpha_) * fresnel(glm::dot(half, out_)) / (masked * 4 * out_.z * in.z);
}

double Bsdf::coat_pdf(const Vec3& in) const {
  const Vec3 half = glm::normalize(in + out_);
  return ggx(half.z, alpha_) / ((1 + smith(out_, alpha_)) * 4 * out_.z);
}

Vec3 Bsdf::value(const Vec3& direction) const {
  const double above = glm::dot(geometric_, direction);
  const Vec3 in = local(direction);
  if (through_share_ > 0 && above < 0 && in.z < 0) return -in.z * (coated_ ? 1 - coat_albedo(-in.z, alpha_) : 1) * through_;
  if (!(above > 0 && in.z > 0)) return Vec3(0.0);
  const double slant = above / std::max(1e-6, in.z * glm::dot(geometric_, n_));
  const double faded = slant >= 1 ? 1 : slant * (1 + slant - slant * slant);
  if (!coated_) return faded * in.z * body_;
  return faded * in.z * (body_ * (1 - coat_albedo(in.z, alpha_)) + coat_value(in));
}

double Bsdf::pdf(const Vec3& direction) const {
  const Vec3 in = local(direction);
  if (!(in.z > 0)) return (1 - coat_share_) * through_share_ * -in.z / kPi;
  return (1 - coat_share_) * (1 - through_share_) * in.z / kPi + (coated_ ? coat_share_ * coat_pdf(in) : 0);
}

BsdfSample Bsdf::sample(const std::array<double, 2>& sample) const {
  Vec3 in;
  if (sample[0] < coat_share_) {
    const Vec3 half = seen_facet(out_, alpha_, {sample[0] / coat_share_, sample[1]});
    in = 2 * glm::dot(out_, half) * half - out_;
  } else {
    const double rest = (sample[0] - coat_share_) / (1 - coat_share_);
    if (rest < through_share_)
      in = cosine_direction({0, 0, -1}, {rest / through_share_, sample[1]});
    else
      in = cosine_direction({0, 0, 1}, {(rest - through_share_) / (1 - through_share_), sample[1]});
  }
  BsdfSample out;
  out.direction = in.x * s_ + in.y * t_ + in.z * n_;
  const double density = pdf(out.direction);
  if (!(density > 0)) return out;
  out.weight = value(out.direction) / density;
  out.pdf = density;
  out.cosine_share = std::max(0.0, in.z) / (kPi * density);
  return out;
}

}  // namespace cambium
