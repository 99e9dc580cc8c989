#include "cli/mesh_look.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "cli/image_files.h"
#include "cli/job.h"
#include "raytrace/texture_image.h"

namespace cambium {
namespace {

std::uint8_t srgb_byte(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double srgb = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * srgb));
}

}  // namespace

MeshLook mesh_look(const Recipe& recipe, bool takes_textures) {
  std::vector<BarkMaterial> barks = load_bark(recipe);
  if (barks.empty()) barks = poplar_bark();
  std::vector<MeshMaterial> materials(barks.size());
  std::vector<std::string> warnings;
  ImageFiles files(warnings);
  const auto white = std::make_shared<const TextureImage>(Pixels{1, 1, 3, {1, 1, 1}, false});
  double aspect = 1;
  bool first = true;
  for (std::size_t order = 0; order < barks.size(); ++order) {
    materials[order].name = "bark of order " + std::to_string(order);
    if (!takes_textures || !barks[order].texture) continue;
    const BarkRecipe& bark = recipe.bark[order];
    materials[order].texture = files.read(bark.texture->file, "the vertices have its colours");
    if (!materials[order].texture) continue;
    if (std::exchange(first, false)) aspect = barks[order].texture->aspect();
    if (bark.normal_map && bark.normal_convention == TextureUse::kNormalOpenGl) {
      materials[order].normal_map = files.read(bark.normal_map->file, "it is left out");
    } else if (bark.normal_map) {
      warnings.push_back(bark.normal_map->file.string() + " has y downwards and a .glb's normals have it upwards: it is left out");
    }
    if (bark.roughness_map) materials[order].roughness_map = files.read(bark.roughness_map->file, "it is left out");
    if (materials[order].roughness_map) materials[order].roughness = 1;
    barks[order].texture = white;
  }
  return {std::move(materials), Bark(std::move(barks), recipe.render.seed), aspect, std::move(warnings)};
}

SurfaceColor vertex_colors(const Bark& bark) {
  return [&bark](std::span<const Contribution> contributions, const SurfaceTraits& traits, const VertexSite& site) {
    const Vec3 albedo = bark.glance(contributions, traits, site.spacing).albedo;
    return std::array<std::uint8_t, 4>{srgb_byte(albedo.x), srgb_byte(albedo.y), srgb_byte(albedo.z), 255};
  };
}

}  // namespace cambium
