#include "cli/recipe_render.h"

#include <limits>
#include <numbers>
#include <tuple>

#include "cli/units.h"

namespace cambium {
namespace {

constexpr std::int64_t kLargestInteger = std::numeric_limits<std::int64_t>::max();

void read_frame(const RecipeValue& v, Camera& camera) {
  const auto corners = v.elements(2);
  Box frame;
  frame.extend(corners[0].point());
  frame.extend(corners[1].point());
  if (!(glm::length(frame.size()) > 0)) v.refuse("two different corners");
  camera.frame = frame;
}

const KeyRule<Camera> kCameraKeys[] = {
    {"eye", [](const RecipeValue& v, Camera& c) { c.eye = v.point(); }},
    {"target", [](const RecipeValue& v, Camera& c) { c.target = v.point(); }},
    {"azimuth", [](const RecipeValue& v, Camera& c) { c.azimuth = v.degrees(); }},
    {"elevation", [](const RecipeValue& v, Camera& c) { c.elevation = v.number(-89, 89) * std::numbers::pi / 180; }},
    {"fov", [](const RecipeValue& v, Camera& c) { c.field_of_view = v.number(0.1, 170) * std::numbers::pi / 180; }},
    {"margin", [](const RecipeValue& v, Camera& c) { c.margin = v.number(0.1, 100); }},
    {"frame", read_frame},
};

const KeyRule<Light> kLightKeys[] = {
    {"sun_azimuth", [](const RecipeValue& v, Light& l) { l.sun_azimuth = v.degrees(); }},
    {"sun_elevation", [](const RecipeValue& v, Light& l) { l.sun_elevation = v.number(-90, 90) * std::numbers::pi / 180; }},
    {"sun_size", [](const RecipeValue& v, Light& l) { l.sun_size = v.number(0, 90) * std::numbers::pi / 180; }},
    {"sun_color", [](const RecipeValue& v, Light& l) { l.sun_color = v.color(); }},
    {"sky_zenith", [](const RecipeValue& v, Light& l) { l.sky_zenith = v.color(); }},
    {"sky_horizon", [](const RecipeValue& v, Light& l) { l.sky_horizon = v.color(); }},
    {"ground_color", [](const RecipeValue& v, Light& l) { l.ground_color = v.color(); }},
    {"ground", [](const RecipeValue& v, Light& l) { l.ground = v.flag(); }},
    {"ground_height", [](const RecipeValue& v, Light& l) { l.ground_height = v.length(); }},
};

void read_image_size(const RecipeValue& v, RenderOptions& r) {
  if (v.is_array()) {
    const auto sides = v.elements(2);
    r.width = static_cast<int>(sides[0].integer(1, 65536));
    r.height = static_cast<int>(sides[1].integer(1, 65536));
  } else {
    if (!v.is_text()) v.refuse("an image size such as \"768x1024\"");
    std::tie(r.width, r.height) = parse_image_size(v.text(), v.location());
  }
}

const KeyRule<RenderOptions> kRenderKeys[] = {
    {"size", read_image_size},
    {"samples", [](const RecipeValue& v, RenderOptions& r) { r.samples = static_cast<int>(v.integer(1, 65536)); }},
    {"exposure", [](const RecipeValue& v, RenderOptions& r) { r.exposure = v.positive(); }},
    {"seed",
     [](const RecipeValue& v, RenderOptions& r) { r.seed = static_cast<std::uint64_t>(v.integer(0, kLargestInteger)); }},
    {"background", [](const RecipeValue& v, RenderOptions& r) { r.light.sky_zenith = r.light.sky_horizon = v.color(); }},
    {"camera", [](const RecipeValue& v, RenderOptions& r) { read_table(v, kCameraKeys, r.camera); }},
    {"light", [](const RecipeValue& v, RenderOptions& r) { read_table(v, kLightKeys, r.light); }},
};

}  // namespace

void read_render(const RecipeValue& table, RenderOptions& options) { read_table(table, kRenderKeys, options); }

}  // namespace cambium
