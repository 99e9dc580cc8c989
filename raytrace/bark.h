// Bark as colour: a texture image or a built-in procedural bark, blended over junctions (field.md section 7).
#pragma once

#include "blobtree/field.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cambium {

class TextureImage;  // one OpenImageIO file, loaded whole

enum class BarkStyle { kRidged, kPlated, kSmooth, kBirch };

/// What one branch order is covered with. Colours are linear.
struct BarkMaterial {
  BarkStyle style = BarkStyle::kRidged;
  Vec3 color{0.30, 0.24, 0.18};
  Vec3 crack_color{0.10, 0.08, 0.06};
  double scale = 1;                                ///< of the pattern, 1 = as grown on this radius
  std::shared_ptr<const TextureImage> texture;     ///< replaces the colours when set
  double texture_size = 0.3;                       ///< metres of v per repeat
};

/// Errors: InputError naming the file if it cannot be read as an image.
std::shared_ptr<const TextureImage> load_texture(const std::filesystem::path& path);

/// Bark at one surface point, and what a picture's layers say of it.
struct BarkLook {
  Vec3 albedo{0.0};        ///< linear
  double roughness = 0.8;  ///< [0.05, 1], of a microfacet model where 1 is dull
  Vec3 normal{0.0};        ///< unit, as the bark's relief tilts the surface's; zero from glance()
  double height = 1;       ///< 1 on an outer plate, 0 in a crack
  double relief = 0;       ///< height in metres: height times how deep this bark's cracks are
  double ridge = 0;        ///< of the surface traits
  double branch = -1, order = -1;   ///< of the primitive that contributes most; -1 where none does
  glm::dvec2 uv{0.0};      ///< its own coordinates: turns, metres
};

/// What covers a surface point, blended over contributing primitives: sum f_i a_i / sum f_i, then wood on cut faces, darker bark
/// on ridges and grey in scars. Thread safe. footprint: metres on the surface that one pixel covers; finer detail fades out.
class Bark {
 public:
  explicit Bark(std::vector<BarkMaterial> by_order, std::uint64_t seed = 0);  ///< empty: the built-in poplar
  /// Everything, for what a camera sees. normal: of the surface, unit.
  BarkLook look(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal, double footprint = 0) const;
  /// The same without its normal, for less than half the cost: what a bounce needs.
  BarkLook glance(Evaluator& evaluator, const PrunedField& field, const Vec3& p, double footprint = 0) const;
  /// A glance where contributions and traits are known.
  BarkLook glance(std::span<const Contribution> contributions, const SurfaceTraits& traits, double footprint = 0) const;

 private:
  const BarkMaterial& material(std::uint32_t order) const;
  double relief_at(Evaluator& evaluator, const PrunedField& field, const Vec3& p, double footprint) const;
  Vec3 shading_normal(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal, double footprint) const;

  std::vector<BarkMaterial> by_order_;
  std::uint64_t seed_ = 0;
};

/// Grey-brown fissured trunk, olive-grey branches with lenticels, red-brown twigs.
std::vector<BarkMaterial> poplar_bark();

}  // namespace cambium
