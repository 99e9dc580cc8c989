// An image of a leaf: its colour, and which parts of the card it lies on are leaf.
#pragma once

#include "raytrace/texture_image.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace cambium {

class FoliageTexture {
 public:
  /// Colours straight, not premultiplied. Of 2 or 4 channels the last is how much of a texel is leaf.
  explicit FoliageTexture(const Pixels& pixels);

  double aspect() const { return color_.aspect(); }   ///< width / height
  /// Linear, at (u, v) in repeats, v upwards; footprint: repeats of v to average over.
  Vec3 color(double u, double v, double footprint) const { return color_.lookup(u, v, footprint); }
  /// Whether some of the image is cut away.
  bool cut_out() const { return !leaf_.empty(); }
  /// Whether the leaf is there: between texels as wide as their mixture is at least a half, as glTF's MASK has it.
  bool leaf_at(double u, double v) const;

 private:
  TextureImage color_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> leaf_;   ///< 0 to 255 by texel; empty: all of it
};

/// Errors: InputError naming the file if it cannot be read as an image.
std::shared_ptr<const FoliageTexture> load_foliage_texture(const std::filesystem::path& path);

}  // namespace cambium
