// Leaves that rays and light are tested on.
#pragma once

#include "raytrace/foliage_scene.h"

#include <utility>

namespace cambium::scenes {

/// A square of unit side around the origin, in x and y.
inline Sheet square() {
  Sheet sheet;
  sheet.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
  sheet.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  sheet.normals = mean_normals(sheet);
  return sheet;
}

/// Four by four texels, white; the four in the middle are cut out.
inline std::shared_ptr<const FoliageTexture> holed() {
  Pixels pixels{4, 4, 4, {}, false};
  for (int i = 0; i < 16; ++i) {
    const bool middle = i % 4 % 3 != 0 && i / 4 % 3 != 0;
    for (const float value : {1.0f, 1.0f, 1.0f, middle ? 0.0f : 1.0f}) pixels.data.push_back(value);
  }
  return std::make_shared<const FoliageTexture>(pixels);
}

/// One square leaf of that side, level, at a height above the origin.
inline FoliageScene level_leaf(double side, double height, const FoliageMaterial& material) {
  FoliageScene scene;
  scene.materials = {material};
  scene.shapes = {{square(), 0}};
  scene.instances = {{0, {0, 0, height}, Mat3(side), 3}};
  return scene;
}

}  // namespace cambium::scenes
