// Leaves and other thin organs as rays meet them: a few shapes, placed many times.
#pragma once

#include "blobtree/sheet.h"
#include "raytrace/foliage_texture.h"

#include <memory>
#include <vector>

namespace cambium {

/// A thin sheet, matt on both sides beneath a rough coat, that lets some light through.
struct FoliageMaterial {
  Vec3 color{1.0};             ///< linear, [0, 1]: share of the light that goes on, to both sides together; times the texture
  std::shared_ptr<const FoliageTexture> texture = nullptr;
  double translucency = 0.35;  ///< share of that which goes through to the other side, [0, 1]
  double roughness = 0.5;      ///< of the coat
};

struct FoliageShape {
  Sheet sheet;
  std::uint32_t material = 0;  ///< of FoliageScene::materials
};

/// A point p of the shape lies at position + axes * p, metres.
struct FoliageInstance {
  std::uint32_t shape = 0;
  Vec3 position{0.0};
  Mat3 axes{1.0};              ///< not singular
  std::int32_t branch = -1;    ///< that bears it
};

struct FoliageScene {
  std::vector<FoliageShape> shapes;
  std::vector<FoliageMaterial> materials;
  std::vector<FoliageInstance> instances;
};

}  // namespace cambium
