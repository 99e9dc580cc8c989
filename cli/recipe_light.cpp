#include "cli/recipe_light.h"

namespace cambium {
namespace {

/// A lamp while its keys are read.
struct LampRecipe {
  AreaLight light;
  Vec3 color{1.0};
  double intensity = 10;
  std::optional<Vec3> target;
};

void read_lamp_shape(const RecipeValue& v, LampRecipe& l) {
  constexpr AreaLight::Shape kShapes[] = {AreaLight::Shape::kRectangle, AreaLight::Shape::kDisc, AreaLight::Shape::kSphere};
  l.light.shape = kShapes[v.choice({"rectangle", "disc", "sphere"})];
}

void read_lamp_direction(const RecipeValue& v, LampRecipe& l) {
  if (l.light.shape == AreaLight::Shape::kSphere) v.refuse("no direction: a sphere shines all round");
  l.light.direction = v.direction();
}

void read_lamp_target(const RecipeValue& v, LampRecipe& l) {
  if (l.light.shape == AreaLight::Shape::kSphere) v.refuse("no target: a sphere shines all round");
  l.target = v.point();
  if (*l.target == l.light.position) v.refuse("a target away from the lamp's position");
}

void read_lamp_size(const RecipeValue& v, LampRecipe& l) {
  if (l.light.shape != AreaLight::Shape::kRectangle) v.refuse("radius instead, or shape = \"rectangle\"");
  const auto sides = v.elements(2);
  l.light.width = sides[0].positive_length();
  l.light.height = sides[1].positive_length();
}

void read_lamp_radius(const RecipeValue& v, LampRecipe& l) {
  if (l.light.shape == AreaLight::Shape::kRectangle) v.refuse("size = [width, height] instead, or shape = \"disc\" or \"sphere\"");
  l.light.radius = v.positive_length();
}

// In this order: what comes later is checked against what comes before.
const KeyRule<LampRecipe> kLampKeys[] = {
    {"shape", read_lamp_shape},
    {"position", [](const RecipeValue& v, LampRecipe& l) { l.light.position = v.point(); }},
    {"direction", read_lamp_direction},
    {"target", read_lamp_target},
    {"size", read_lamp_size},
    {"radius", read_lamp_radius},
    {"color", [](const RecipeValue& v, LampRecipe& l) { l.color = v.color(); }},
    {"intensity", [](const RecipeValue& v, LampRecipe& l) { l.intensity = v.number(0, 1e9); }},
    {"visible", [](const RecipeValue& v, LampRecipe& l) { l.light.visible = v.flag(); }},
};

void read_lamps(const RecipeValue& v, RenderRecipe& r) {
  for (const RecipeValue& element : v.elements()) {
    LampRecipe lamp;
    read_table(element, kLampKeys, lamp);
    if (lamp.target) lamp.light.direction = *lamp.target - lamp.light.position;
    lamp.light.radiance = lamp.intensity * lamp.color;
    r.light.area.push_back(lamp.light);
  }
}

void read_ground(const RecipeValue& v, RenderRecipe& r) {
  r.light.catcher = !v.is_flag();
  r.light.ground = v.is_flag() ? v.flag() : v.choice({"catcher"}) == 0;
}

EnvironmentRecipe& environment(RenderRecipe& r) {
  if (!r.environment) r.environment.emplace();
  return *r.environment;
}

void read_environment(const RecipeValue& v, RenderRecipe& r) {
  environment(r).file = v.file();
  environment(r).named_at = v.location();
}

const KeyRule<RenderRecipe> kLightKeys[] = {
    {"sky",
     [](const RecipeValue& v, RenderRecipe& r) {
       constexpr SkyKind kKinds[] = {SkyKind::kDaylight, SkyKind::kGradient};
       r.light.sky = kKinds[v.choice({"daylight", "gradient"})];
     }},
    {"turbidity", [](const RecipeValue& v, RenderRecipe& r) { r.light.turbidity = v.number(2, 10); }},
    {"sky_zenith", [](const RecipeValue& v, RenderRecipe& r) { r.light.sky_zenith = v.color(); }},
    {"sky_horizon", [](const RecipeValue& v, RenderRecipe& r) { r.light.sky_horizon = v.color(); }},
    {"environment", read_environment},
    {"environment_rotation", [](const RecipeValue& v, RenderRecipe& r) { environment(r).rotation = v.degrees(); }},
    {"environment_strength", [](const RecipeValue& v, RenderRecipe& r) { environment(r).strength = v.number(0, 1e9); }},
    {"sun", [](const RecipeValue& v, RenderRecipe& r) { r.light.sun = v.flag(); }},
    {"sun_azimuth", [](const RecipeValue& v, RenderRecipe& r) { r.light.sun_azimuth = v.degrees(); }},
    {"sun_elevation",
     [](const RecipeValue& v, RenderRecipe& r) { r.light.sun_elevation = v.degrees(-90, 90); }},
    {"sun_size", [](const RecipeValue& v, RenderRecipe& r) { r.light.sun_size = v.degrees(0, 57); }},
    {"sun_color", [](const RecipeValue& v, RenderRecipe& r) { r.light.sun_color = v.color(); }},
    {"area", read_lamps},
    {"ground_color", [](const RecipeValue& v, RenderRecipe& r) { r.light.ground_color = v.color(); }},
    {"ground", read_ground},
    {"ground_height", [](const RecipeValue& v, RenderRecipe& r) { r.light.ground_height = v.length(); }},
};

/// The keys that only one kind of sky has.
struct SkyKey {
  const char* key;
  SkyKind kind;
};
constexpr SkyKey kSkyKeys[] = {
    {"environment", SkyKind::kEnvironment},          {"environment_rotation", SkyKind::kEnvironment},
    {"environment_strength", SkyKind::kEnvironment}, {"sky_zenith", SkyKind::kGradient},
    {"sky_horizon", SkyKind::kGradient},             {"turbidity", SkyKind::kDaylight},
};

const char* what_it_takes(SkyKind kind) {
  switch (kind) {
    case SkyKind::kDaylight: return "sky = \"daylight\" (and no other sky's keys) with it";
    case SkyKind::kGradient: return "sky = \"gradient\" (and no other sky's keys) with it";
    case SkyKind::kEnvironment: return "environment = \"image.exr\" (and no other sky's keys) with it";
  }
  return "";
}

/// An image, or the gradient's colours, say which sky it is where `sky` does not.
SkyKind implied_sky(const toml::table& table, const Light& light) {
  if (table.contains("sky")) return light.sky;
  if (table.contains("environment")) return SkyKind::kEnvironment;
  return table.contains("sky_zenith") || table.contains("sky_horizon") ? SkyKind::kGradient : SkyKind::kDaylight;
}

[[noreturn]] void refuse_key(const RecipeValue& v, const char* key, const char* expected) {
  RecipeValue(v.source(), *v.table().get(key), v.child_path(key)).refuse(expected);
}

/// An image has its own sun: another is added only where it is asked for.
void settle_sun(const RecipeValue& v, Light& light) {
  if (light.sky == SkyKind::kEnvironment && !v.table().contains("sun")) light.sun = false;
  if (light.sun) return;
  const auto refuse = [&v](const char* key) {
    if (v.table().contains(key)) refuse_key(v, key, "sun = true with it");
  };
  refuse("sun_size");
  refuse("sun_color");
  if (light.sky == SkyKind::kDaylight) return;   // its place still colours that sky
  refuse("sun_azimuth");
  refuse("sun_elevation");
}

}  // namespace

void read_light(const RecipeValue& table, RenderRecipe& render) {
  read_table(table, kLightKeys, render);
  render.light.sky = implied_sky(table.table(), render.light);
  for (const SkyKey& own : kSkyKeys) {
    if (own.kind != render.light.sky && table.table().contains(own.key)) refuse_key(table, own.key, what_it_takes(own.kind));
  }
  settle_sun(table, render.light);
}

void read_backdrop(const RecipeValue& value, Light& light) {
  const bool named = value.is_text() && !value.text().starts_with('#');
  if (!named) {
    light.backdrop = Backdrop::kColor;
    light.backdrop_color = value.color();
  } else if (value.text() == "sky" || value.text() == "transparent") {
    light.backdrop = value.text() == "sky" ? Backdrop::kSky : Backdrop::kTransparent;
  } else {
    value.refuse("\"sky\", \"transparent\" or a colour such as \"#8a7358\"");
  }
}

}  // namespace cambium
