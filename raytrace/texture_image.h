// An image of bark, or of its normals or roughness, as a repeating texture filtered by a pyramid of halved images.
#pragma once

#include "blobtree/geometry.h"
#include "raytrace/image_file.h"

#include <vector>

namespace cambium {

/// What an image's numbers stand for.
enum class TextureUse {
  kColor,          ///< sRGB where its file says so
  kNormalOpenGl,   ///< x to the right, y up in the image, z out of it, each from [-1, 1] to [0, 1]
  kNormalDirectX,  ///< the same with y down
  kRoughness,      ///< the green channel, as glTF has it, or the only one
};

class TextureImage {
 public:
  explicit TextureImage(const Pixels& pixels, TextureUse use = TextureUse::kColor);

  double aspect() const { return aspect_; }   ///< width / height in pixels

  /// At (s, t) in repeats (period 1 in both, t upwards), averaged over about `footprint` repeats of t: a linear colour; of normals
  /// the slopes (rise per way to the right, rise per way up, 0), which average as normals do not; of roughness thrice that.
  Vec3 lookup(double s, double t, double footprint) const;

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<glm::vec3> texels;
  };
  Vec3 bilinear(const Level& level, double s, double t) const;

  std::vector<Level> levels_;
  double aspect_ = 1;
};

}  // namespace cambium
