// Bark as colour: a texture image or a built-in procedural bark, blended over junctions (field.md section 7).
#pragma once

#include "blobtree/field.h"

#include <filesystem>
#include <memory>
#include <optional>
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

/// Linear albedo at a surface point: sum f_i color_i / sum f_i over contributing primitives, then wood on cut faces, darker
/// bark on ridges and grey in scars. Thread safe.
class Bark {
 public:
  explicit Bark(std::vector<BarkMaterial> by_order, std::uint64_t seed = 0);  ///< empty: the built-in poplar
  Vec3 albedo(Evaluator& evaluator, const PrunedField& field, const Vec3& p, const Vec3& normal) const;
  /// Height in [0,1] of the bark at the point, for a shading normal; 1 outside, 0 in a crack.
  double height(Evaluator& evaluator, const PrunedField& field, const Vec3& p) const;

 private:
  std::vector<BarkMaterial> by_order_;
  std::uint64_t seed_ = 0;
};

}  // namespace cambium
