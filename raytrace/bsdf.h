// How bark, soil and leaves send light on: a matt body, for bark and leaves beneath a rough coat that mirrors.
#pragma once

#include "blobtree/geometry.h"

#include <array>

namespace cambium {

struct BsdfSample {
  Vec3 direction{0.0};
  Vec3 weight{0.0};   ///< value over pdf
  double pdf = 0;     ///< by solid angle; 0: no light comes back this way
  /// Density of cosine-distributed directions over pdf: what weighs this one for a mean over the hemisphere by cosine.
  double cosine_share = 0;
};

/// At one point, for one direction out. The coat is GGX of index 1.5 (Walter et al. 2007, height-correlated Smith masking); what
/// it lets through and out again falls on a Lambert body, (1 - E(out)) (1 - E(in)) albedo / (pi (1 - mean E)) (Kelemen and
/// Szirmay-Kalos 2001), so that a white body gives back all light, and the whole is reciprocal. Light near the terminator of the
/// real surface is faded where the shading normal leans towards it (Chiang, Li and Burley 2019). A thin sheet also lets light through
/// to its other side, matt, in through one coat and out through the other.
class Bsdf {
 public:
  /// All directions unit, away from the surface; out above it by `normal`. A shading normal that turns away from `out` is bent
  /// towards it. roughness: GGX's alpha is its square; unset by `coated` false: no coat.
  struct Surface {
    Vec3 normal, shading_normal;
    Vec3 albedo;
    double roughness = 0.8;
    bool coated = true;
    Vec3 through{0.0};   ///< of a sheet: share of light that comes out on the other side; at most 1 with the albedo
  };
  Bsdf(const Surface& surface, const Vec3& out);

  /// Times the cosine to the shading normal. 0 below the real surface or the shading normal's, but for a sheet's other side.
  Vec3 value(const Vec3& in) const;
  double pdf(const Vec3& in) const;
  BsdfSample sample(const std::array<double, 2>& sample) const;
  /// Share of all even light around that goes out, in [albedo or the coat's, 1], exact where the normals agree.
  const Vec3& reflectance() const { return reflectance_; }
  const Vec3& shading_normal() const { return n_; }

 private:
  double coat_value(const Vec3& in) const;   ///< without the cosine; local
  double coat_pdf(const Vec3& in) const;
  Vec3 local(const Vec3& v) const { return {glm::dot(v, s_), glm::dot(v, t_), glm::dot(v, n_)}; }

  Vec3 geometric_, n_, s_, t_;
  Vec3 out_;                 ///< local
  double through_share_ = 0; ///< of the samples that are not the coat's
  Vec3 body_;                ///< albedo over pi, and through the coat towards `out`
  Vec3 through_{0.0};        ///< likewise
  Vec3 reflectance_;
  double alpha_ = 1;
  double coat_share_ = 0;    ///< of the samples
  bool coated_ = false;
};

/// Share of light from that cosine that the coat mirrors, by a table; mean: over all directions, by cosine.
double coat_albedo(double cosine, double alpha);
double mean_coat_albedo(double alpha);

}  // namespace cambium
