// A bark made of images: colour, and normals and roughness where there are any, wound around a branch.
#pragma once

#include "raytrace/texture_image.h"

namespace cambium {

struct MappedBark {
  Vec3 albedo{0.0};
  double roughness = 0.85;
  glm::dvec2 slope{0.0};   ///< rise per metre around (to growing u) and along (to growing v)
};

struct BarkMaps {
  const TextureImage& color;
  const TextureImage* normals = nullptr;     ///< none: flat
  const TextureImage* roughness = nullptr;   ///< none: everywhere the same
  double size = 0.3;                         ///< metres of v per repeat

  /// u in turns, v and radius and footprint in metres. Closed around the girth.
  MappedBark at(double u, double v, double radius, double footprint) const;

 private:
  MappedBark wound(double turns, double u, double v, double footprint) const;
};

}  // namespace cambium
