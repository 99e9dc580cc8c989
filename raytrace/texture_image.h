// A bark photograph as a repeating texture, filtered by a pyramid of halved images.
#pragma once

#include "blobtree/geometry.h"
#include "raytrace/image_file.h"

#include <vector>

namespace cambium {

class TextureImage {
 public:
  explicit TextureImage(const Pixels& pixels);

  double aspect() const { return aspect_; }   ///< width / height in pixels

  /// Linear colour at (s, t) in repeats (period 1 in both, t upwards), averaged over about `footprint` repeats of t.
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
