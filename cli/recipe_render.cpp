#include "cli/recipe_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "cli/recipe_light.h"
#include "cli/units.h"

namespace cambium {
namespace {

constexpr std::int64_t kLargestInteger = std::numeric_limits<std::int64_t>::max();

void read_frame(const RecipeValue& v, RenderRecipe& r) {
  const auto corners = v.elements(2);
  Box frame;
  frame.extend(corners[0].point());
  frame.extend(corners[1].point());
  if (!(glm::length(frame.size()) > 0)) v.refuse("two different corners");
  r.camera.frame = frame;
}

NamedBranch named_branch(const RecipeValue& v) {
  return {static_cast<std::uint32_t>(v.integer(0, std::numeric_limits<std::uint32_t>::max())), v.location()};
}

void read_fov(const RecipeValue& v, RenderRecipe& r) {
  if (r.camera.focal_length) v.refuse("either focal_length or fov, not both");
  r.camera.field_of_view = v.degrees(0.1, 170);
}

void read_focus(const RecipeValue& v, RenderRecipe& r) {
  if (v.is_array()) {
    r.camera.focus = v.point();
  } else {
    r.focus_branch = named_branch(v);
  }
}

void read_focus_distance(const RecipeValue& v, RenderRecipe& r) {
  if (r.camera.focus || r.focus_branch) v.refuse("either focus or focus_distance, not both");
  r.camera.focus_distance = v.positive_length();
}

const KeyRule<RenderRecipe> kCameraKeys[] = {
    {"eye", [](const RecipeValue& v, RenderRecipe& r) { r.camera.eye = v.point(); }},
    {"target", [](const RecipeValue& v, RenderRecipe& r) { r.camera.target = v.point(); }},
    {"azimuth", [](const RecipeValue& v, RenderRecipe& r) { r.camera.azimuth = v.degrees(); }},
    {"elevation", [](const RecipeValue& v, RenderRecipe& r) { r.camera.elevation = v.degrees(-89, 89); }},
    {"focal_length", [](const RecipeValue& v, RenderRecipe& r) { r.camera.focal_length = v.positive_length(); }},
    {"fov", read_fov},
    {"f_number", [](const RecipeValue& v, RenderRecipe& r) { r.camera.f_number = v.number(0.1, 1e6); }},
    {"focus", read_focus},
    {"focus_distance", read_focus_distance},
    {"margin", [](const RecipeValue& v, RenderRecipe& r) { r.camera.margin = v.number(0.1, 100); }},
    {"frame", read_frame},
    {"close_up", [](const RecipeValue& v, RenderRecipe& r) { r.close_up = named_branch(v); }},
};

void read_image_size(const RecipeValue& v, RenderRecipe& r) {
  if (v.is_array()) {
    const auto sides = v.elements(2);
    r.width = static_cast<int>(sides[0].integer(1, 65536));
    r.height = static_cast<int>(sides[1].integer(1, 65536));
  } else {
    if (!v.is_text()) v.refuse("an image size such as \"768x1024\"");
    std::tie(r.width, r.height) = parse_image_size(v.text(), v.location());
  }
}

/// A number: at most so many. Text: "1..16".
void read_samples(const RecipeValue& v, RenderRecipe& r) {
  if (v.is_text()) {
    set_samples(parse_samples(v.text(), v.location()), r.sampling);
  } else {
    set_samples({std::nullopt, static_cast<int>(v.integer(1, kMostSamples))}, r.sampling);
  }
}

void read_crop(const RecipeValue& v, RenderRecipe& r) {
  if (v.is_text()) {
    r.crop = parse_crop(v.text(), v.location());
  } else {
    const auto edges = v.elements(4);
    const auto edge = [&](int i) { return static_cast<int>(edges[i].integer(0, 65536)); };
    r.crop = PixelRect{edge(0), edge(1), edge(2), edge(3)};
  }
  if (r.crop->empty()) v.refuse("x0,y0,x1,y1 with x0 < x1 and y0 < y1");
}

/// A factor, or text in stops: "+1.5 stops" is 2^1.5.
void read_exposure(const RecipeValue& v, RenderRecipe& r) {
  if (!v.is_text()) {
    r.exposure = v.positive();
    return;
  }
  const std::string text = v.text();
  const auto unit = text.find("stop");
  if (unit == std::string::npos || (text.substr(unit) != "stop" && text.substr(unit) != "stops"))
    v.refuse("a factor such as 1.5, or stops such as \"+0.5 stops\"");
  const double stops = parse_number(std::string_view(text).substr(0, unit), v.location());
  if (!(std::abs(stops) <= 64)) v.refuse("stops from -64 to 64");
  r.exposure = std::exp2(stops);
}

const KeyRule<RenderRecipe> kRenderKeys[] = {
    {"size", read_image_size},
    {"samples", read_samples},
    {"noise", [](const RecipeValue& v, RenderRecipe& r) { r.sampling.noise = v.number(0, 1); }},
    {"filter", [](const RecipeValue& v, RenderRecipe& r) { r.sampling.filter_radius = v.number(0, kLargestFilter); }},
    {"crop", read_crop},
    {"smooth", [](const RecipeValue& v, RenderRecipe& r) { r.smooth = v.flag(); }},
    {"exposure", read_exposure},
    {"seed",
     [](const RecipeValue& v, RenderRecipe& r) { r.seed = static_cast<std::uint64_t>(v.integer(0, kLargestInteger)); }},
    {"bounces", [](const RecipeValue& v, RenderRecipe& r) { r.paths.bounces = static_cast<int>(v.integer(0, kMostBounces)); }},
    {"clamp", [](const RecipeValue& v, RenderRecipe& r) { r.paths.clamp = v.positive(); }},
    {"occlusion_distance", [](const RecipeValue& v, RenderRecipe& r) { r.paths.occlusion_distance = v.positive_length(); }},
    {"background", [](const RecipeValue& v, RenderRecipe& r) { read_backdrop(v, r.light); }},
    {"camera", [](const RecipeValue& v, RenderRecipe& r) { read_table(v, kCameraKeys, r); }},
    {"light", read_light},
};

}  // namespace

void set_samples(const std::pair<std::optional<int>, int>& least_and_most, Sampling& sampling) {
  sampling.max = least_and_most.second;
  sampling.min = std::min(least_and_most.first.value_or(sampling.min), sampling.max);
}

void check_crop(const RenderOptions& options, const SourceLocation& at) {
  if (!options.crop) return;
  const PixelRect& c = *options.crop;
  if (!c.empty() && PixelRect{0, 0, options.width, options.height}.contains(c)) return;
  throw InputError(at, fmt::format("the crop {},{},{},{}", c.x0, c.y0, c.x1, c.y1),
                   fmt::format("x0,y0,x1,y1 with x0 < x1 and y0 < y1 within the picture's {}x{}", options.width, options.height));
}

void read_render(const RecipeValue& table, RenderRecipe& render) { read_table(table, kRenderKeys, render); }

}  // namespace cambium
