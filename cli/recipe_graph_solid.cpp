#include <algorithm>
#include <cctype>
#include <limits>
#include <numbers>

#include "cli/recipe_graph_tables.h"

namespace cambium {
namespace {

// ---- Where a solid is ------------------------------------------------------------------------------------------
const KeyRule<GraphSolidRecipe> kPlacementKeys[] = {
    {"shape", [](const RecipeValue&, GraphSolidRecipe&) {}},   // which says how the rest is read
    {"origin", [](const RecipeValue& v, GraphSolidRecipe& s) { s.placed.origin = v.point(); }},
    {"axis", [](const RecipeValue& v, GraphSolidRecipe& s) { s.placed.axis = v.direction(); }},
    {"scale", [](const RecipeValue& v, GraphSolidRecipe& s) { s.placed.scale = v.positive(); }},
    {"endpoints", [](const RecipeValue& v, GraphSolidRecipe& s) { s.placed.endpoints = v.flag(); }},
    {"part",
     [](const RecipeValue& v, GraphSolidRecipe& s) {
       s.placed.part = static_cast<std::uint16_t>(v.integer(0, std::numeric_limits<std::uint16_t>::max()));
     }},
};

// ---- What it is ------------------------------------------------------------------------------------------------
const KeyRule<BallSolid> kBallKeys[] = {
    {"radius", [](const RecipeValue& v, BallSolid& s) { s.radius = v.positive_length(); }},
    {"alpha", [](const RecipeValue& v, BallSolid& s) { s.angle = v.degrees(0.1, 180); }},
};

const KeyRule<BallSolid> kHemisphereKeys[] = {
    {"radius", [](const RecipeValue& v, BallSolid& s) { s.radius = v.positive_length(); }},
};

const KeyRule<EllipsoidSolid> kEllipsoidKeys[] = {
    {"half_size",
     [](const RecipeValue& v, EllipsoidSolid& s) {
       const auto sizes = v.elements(3);
       for (int i = 0; i < 3; ++i) s.half_size[i] = sizes[i].positive_length();
     }},
};

const KeyRule<CylinderSolid> kCylinderKeys[] = {
    {"radius", [](const RecipeValue& v, CylinderSolid& s) { s.radius = v.positive_length(); }},
    {"height", [](const RecipeValue& v, CylinderSolid& s) { s.height = v.positive_length(); }},
};

const KeyRule<ConeSolid> kConeKeys[] = {
    {"radius_base", [](const RecipeValue& v, ConeSolid& s) { s.radius_base = v.not_negative_length(); }},
    {"radius_tip", [](const RecipeValue& v, ConeSolid& s) { s.radius_tip = v.not_negative_length(); }},
    {"height", [](const RecipeValue& v, ConeSolid& s) { s.height = v.positive_length(); }},
};

// ---- What may be in a file -------------------------------------------------------------------------------------
void read_stroke(const RecipeValue& v, GraphSolidRecipe& s) {
  RevolutionSolid solid;
  for (const RecipeValue& element : v.elements()) {
    const auto place = element.elements(2);
    solid.stroke.emplace_back(place[0].length(), place[1].length());
  }
  try {
    validate(solid);
  } catch (const InputError& error) {
    throw InputError(v.location(), error.found(), error.expected());
  }
  s.placed.solid = std::move(solid);
}

NamedFile file_ending(const RecipeValue& v, const std::set<std::string>& extensions) {
  NamedFile named{v.file(), v.location()};
  std::string extension = named.file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  std::string listed;
  for (const std::string& known : extensions) listed += (listed.empty() ? "" : " or ") + known;
  if (!extensions.contains(extension)) v.refuse("a file " + listed);
  return named;
}

void read_svg(const RecipeValue& v, GraphSolidRecipe& s) {
  if (std::holds_alternative<RevolutionSolid>(s.placed.solid)) v.refuse("either stroke or svg, not both");
  s.svg = file_ending(v, {".svg"});
}

const KeyRule<GraphSolidRecipe> kRevolutionKeys[] = {
    {"stroke", read_stroke},
    {"svg", read_svg},
    {"svg_id", [](const RecipeValue& v, GraphSolidRecipe& s) { s.svg_options.id = v.text(); }},
    {"svg_axis", [](const RecipeValue& v, GraphSolidRecipe& s) { s.svg_options.axis = v.number(); }},
    {"height", [](const RecipeValue& v, GraphSolidRecipe& s) { s.svg_options.height = v.positive_length(); }},
};

const KeyRule<GraphSolidRecipe> kMeshKeys[] = {
    {"mesh", [](const RecipeValue& v, GraphSolidRecipe& s) { s.mesh = file_ending(v, {".obj", ".ply"}); }},
};

// ---- Either ----------------------------------------------------------------------------------------------------
/// Reads what one kind of solid has; the placement's keys are known, but not read.
template <class Part, std::size_t N>
Part read_own_keys(const RecipeValue& v, const KeyRule<Part> (&rules)[N], Part part = {}) {
  read_table(v, rules, part, keys_of(kPlacementKeys));
  return part;
}

/// Index among these names.
std::size_t shape_of(const RecipeValue& v) {
  const toml::node* shape = v.table().get("shape");
  if (!shape) throw InputError(v.location(), "'" + v.path() + "' without a shape", "a shape in it, such as shape = \"ball\"");
  return RecipeValue(v.source(), *shape, v.child_path("shape"))
      .choice({"ball", "hemisphere", "ellipsoid", "cylinder", "cone", "revolution", "mesh", "half_space"});
}

GraphSolidRecipe read_revolution(const RecipeValue& v) {
  GraphSolidRecipe s = read_own_keys(v, kRevolutionKeys);
  if (s.svg) return s;
  if (!v.table().contains("stroke"))
    throw InputError(v.location(), "a revolution without a stroke", "stroke = [[r, z], ...] or svg = \"file.svg\"");
  for (const char* key : {"svg_id", "svg_axis", "height"})
    if (v.table().contains(key)) throw InputError(v.location(), std::string(key) + " without svg", "svg = \"file.svg\" beside it");
  return s;
}

GraphSolidRecipe read_mesh(const RecipeValue& v) {
  GraphSolidRecipe s = read_own_keys(v, kMeshKeys);
  if (!s.mesh) throw InputError(v.location(), "a mesh without its file", "mesh = \"crown.obj\" or .ply");
  return s;
}

constexpr std::size_t kHalfSpace = 7;

void read_shape(const RecipeValue& v, GraphSolidRecipe& s) {
  switch (shape_of(v)) {
    case 0: s.placed.solid = read_own_keys(v, kBallKeys); break;
    case 1: s.placed.solid = read_own_keys(v, kHemisphereKeys, BallSolid{.angle = 0.5 * std::numbers::pi}); break;
    case 2: s.placed.solid = read_own_keys(v, kEllipsoidKeys); break;
    case 3: s.placed.solid = read_own_keys(v, kCylinderKeys); break;
    case 4: s.placed.solid = read_own_keys(v, kConeKeys); break;
    case 5: s = read_revolution(v); break;
    case 6: s = read_mesh(v); break;
    case kHalfSpace: throw InputError(v.location(), "a half_space for '" + v.path() + "'", "a solid; half-spaces are obstacles only");
  }
}

GraphSolidRecipe read_solid(const RecipeValue& v) {
  GraphSolidRecipe solid;
  read_shape(v, solid);
  for (const auto& rule : kPlacementKeys)
    if (const toml::node* node = v.table().get(rule.key)) rule.read(RecipeValue(v.source(), *node, v.child_path(rule.key)), solid);
  return solid;
}

const KeyRule<HalfSpaceObstacle> kHalfSpaceKeys[] = {
    {"shape", [](const RecipeValue&, HalfSpaceObstacle&) {}},
    {"point", [](const RecipeValue& v, HalfSpaceObstacle& h) { h.point = v.point(); }},
    {"normal", [](const RecipeValue& v, HalfSpaceObstacle& h) { h.normal = v.direction(); }},
};

}  // namespace

std::vector<GraphSolidRecipe> read_solids(const RecipeValue& array) {
  std::vector<GraphSolidRecipe> solids;
  for (const RecipeValue& element : array.elements()) solids.push_back(read_solid(element));
  return solids;
}

void read_obstacles(const RecipeValue& array, GraphRecipe& graph) {
  for (const RecipeValue& element : array.elements()) {
    if (shape_of(element) == kHalfSpace)
      read_table(element, kHalfSpaceKeys, graph.half_spaces.emplace_back());
    else
      graph.obstacles.push_back(read_solid(element));
  }
}

void add_solid_keys(const std::string& prefix, KeySet& keys) {
  add_keys(prefix, kPlacementKeys, keys);
  add_keys(prefix, kBallKeys, keys);
  add_keys(prefix, kHemisphereKeys, keys);
  add_keys(prefix, kEllipsoidKeys, keys);
  add_keys(prefix, kCylinderKeys, keys);
  add_keys(prefix, kConeKeys, keys);
  add_keys(prefix, kRevolutionKeys, keys);
  add_keys(prefix, kMeshKeys, keys);
}

void add_obstacle_keys(const std::string& prefix, KeySet& keys) {
  add_keys(prefix, kHalfSpaceKeys, keys);
}

}  // namespace cambium
