// Bark as colour: texture images or a built-in procedural bark, blended over junctions (field.md section 7).
#pragma once

#include "blobtree/field.h"
#include "raytrace/bark_pattern.h"
#include "raytrace/texture_image.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

/// What one branch order is covered with. Colours are linear. A texture replaces the colours, and with them the relief, the
/// height and the roughness, which are then those of its own maps or flat, 1 and 0.85.
struct BarkMaterial {
  BarkStyle style = BarkStyle::kRidged;
  Vec3 color{0.30, 0.24, 0.18};
  Vec3 crack_color{0.10, 0.08, 0.06};
  double scale = 1;                                ///< of the pattern, 1 = as grown on this radius
  std::shared_ptr<const TextureImage> texture = nullptr;
  double texture_size = 0.3;                       ///< metres of v per repeat, of all its maps
  std::shared_ptr<const TextureImage> normal_map = nullptr;  ///< tangent space: x to growing u, y to growing v, z outwards
  std::shared_ptr<const TextureImage> roughness_map = nullptr;
  double mature_radius = 0.05;                     ///< metres; thinner stems are smooth (BarkPatternKind)
  std::optional<Vec3> young_color = std::nullopt;  ///< of smooth stems; unset: color
};

/// Errors: InputError naming the file if it cannot be read as an image.
std::shared_ptr<const TextureImage> load_texture(const std::filesystem::path& path, TextureUse use = TextureUse::kColor);

/// Bark at one surface point, and what a picture's layers say of it.
struct BarkLook {
  Vec3 albedo{0.0};        ///< linear
  double roughness = 0.8;  ///< [0.05, 1], of a microfacet model where 1 is dull
  Vec3 normal{0.0};        ///< unit, as the bark's relief tilts the surface's; zero from glance()
  double height = 1;       ///< 1 on an outer plate, 0 in a crack
  double relief = 0;       ///< metres, 0 on an outer plate and negative in a crack
  double ridge = 0;        ///< of the surface traits
  double branch = -1, order = -1;   ///< of the primitive that contributes most; -1 where none does
  glm::dvec2 uv{0.0};      ///< its own coordinates: turns, metres
};

/// What covers a surface point, blended over contributing primitives, then wood on cut faces, dark folds on ridges and grey wood in
/// scars. Thread safe. footprint: metres on the surface that one pixel covers, at grazing angles its longer side; finer detail fades to
/// its mean.
/// Blending is sum w_i a_i / sum w_i with w_i = f_i^3: where it is f_i, the grains of two barks are seen through each other over the
/// whole collar of a branch, which Galbraith et al. (2004, 3.6) call slightly unnatural; cubed they meet in a band.
class Bark {
 public:
  explicit Bark(std::vector<BarkMaterial> by_order, std::uint64_t seed = 0);  ///< empty: the built-in poplar
  /// Everything, for what a camera sees. normal: of the surface, unit. The relief's gradient is exact but for the little that
  /// the radius, the order's change with age and the wounds add to it.
  BarkLook look(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal, double footprint = 0) const;
  /// The same without its normal: what a bounce needs.
  BarkLook glance(Evaluator& evaluator, const PrunedField& field, const Vec3& p, double footprint = 0) const;
  /// Where contributions and traits are known.
  BarkLook look(std::span<const Contribution> contributions, const SurfaceTraits& traits, const Vec3& normal,
                double footprint = 0) const;
  BarkLook glance(std::span<const Contribution> contributions, const SurfaceTraits& traits, double footprint = 0) const;

 private:
  const BarkMaterial& material(std::uint32_t order) const;
  template <BarkNumber N>
  BarkLook blended(std::span<const Contribution> contributions, const SurfaceTraits& traits, double footprint,
                   Vec3& relief_gradient) const;

  std::vector<BarkMaterial> by_order_;
  std::uint64_t seed_ = 0;
};

/// Grey-brown fissured trunk, olive-grey branches with lenticels, red-brown twigs.
std::vector<BarkMaterial> poplar_bark();

}  // namespace cambium
