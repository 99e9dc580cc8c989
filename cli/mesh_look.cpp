#include "cli/mesh_look.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "cli/job.h"
#include "cli/read_text.h"
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
  std::vector<std::pair<std::filesystem::path, std::shared_ptr<const std::string>>> read;   // orders often share one
  double aspect = 1;
  std::vector<std::string> warnings;
  bool first = true;
  for (std::size_t order = 0; order < barks.size(); ++order) {
    materials[order].name = "bark of order " + std::to_string(order);
    if (!takes_textures || !barks[order].texture) continue;
    const std::filesystem::path& path = *recipe.bark[order].texture;
    auto known = std::find_if(read.begin(), read.end(), [&](const auto& entry) { return entry.first == path; });
    if (known == read.end()) {
      known = read.insert(read.end(), {path, std::make_shared<const std::string>(read_text(path))});
      if (image_type(*known->second).empty())
        warnings.push_back(path.string() + " is neither PNG nor JPEG, as a .glb's textures are: the vertices have its colours");
    }
    if (image_type(*known->second).empty()) continue;
    if (std::exchange(first, false)) aspect = barks[order].texture->aspect();
    materials[order].texture = known->second;
    barks[order].texture = nullptr;
    barks[order].color = barks[order].crack_color = Vec3(1.0);
  }
  return {std::move(materials), Bark(std::move(barks), recipe.render.seed), aspect, std::move(warnings)};
}

SurfaceColor vertex_colors(const Bark& bark) {
  return [&bark](std::span<const Contribution> contributions, const SurfaceTraits& traits, const Vec3&, const Vec3&) {
    const Vec3 albedo = bark.glance(contributions, traits).albedo;
    return std::array<std::uint8_t, 4>{srgb_byte(albedo.x), srgb_byte(albedo.y), srgb_byte(albedo.z), 255};
  };
}

}  // namespace cambium
