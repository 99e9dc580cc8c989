#include "cli/recipe.h"

#include <algorithm>
#include <limits>

#include "cli/read_text.h"
#include "cli/recipe_base.h"
#include "cli/recipe_graph_tables.h"
#include "cli/recipe_leaf.h"
#include "cli/recipe_override.h"
#include "cli/recipe_render.h"
#include "cli/recipe_value.h"
#include "cli/units.h"

namespace cambium {
namespace {

constexpr std::int64_t kLargestInteger = std::numeric_limits<std::int64_t>::max();

// ---- [skeleton] ------------------------------------------------------------------------------------------------
const KeyRule<SkeletonRecipe> kSkeletonKeys[] = {
    {"lsystem", [](const RecipeValue& v, SkeletonRecipe& s) { s.lsystem = v.file(), s.named_at = v.location(); }},
    {"file",
     [](const RecipeValue& v, SkeletonRecipe& s) {
       if (s.lsystem) v.refuse("either lsystem or file, not both");
       s.file = v.file(), s.named_at = v.location();
     }},
    {"graph",
     [](const RecipeValue& v, SkeletonRecipe& s) {
       if (s.lsystem || s.file) throw InputError(v.location(), "a graph beside an lsystem or a file", "one of the three");
       s.graph = read_graph(v), s.named_at = v.location();
     }},
    {"label", [](const RecipeValue& v, SkeletonRecipe& s) { s.label = v.text(); }},
    {"dialect",
     [](const RecipeValue& v, SkeletonRecipe& s) {
       constexpr Dialect kDialects[] = {Dialect::kCpfg, Dialect::kLpy, Dialect::kHoudini};
       s.dialect = kDialects[v.choice({"cpfg", "lpy", "houdini"})];
     }},
    {"steps", [](const RecipeValue& v, SkeletonRecipe& s) { s.steps = static_cast<int>(v.integer(0, 1'000'000)); }},
    {"seed",
     [](const RecipeValue& v, SkeletonRecipe& s) { s.seed = static_cast<std::uint64_t>(v.integer(0, kLargestInteger)); }},
    {"step", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.step = v.positive_length(); }},
    {"angle", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.angle = v.degrees(); }},
    {"width", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.width = v.positive_length(); }},
    {"width_unit", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.width_unit = v.positive_length(); }},
    {"width_factor", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.width_factor = v.number(1e-3, 1); }},
    {"tropism", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.tropism = v.direction(); }},
    {"elasticity", [](const RecipeValue& v, SkeletonRecipe& s) { s.turtle.elasticity = v.number(-10, 10); }},
};

// ---- [surface] -------------------------------------------------------------------------------------------------
const KeyRule<ConditioningOptions> kConditioningKeys[] = {
    {"enabled", [](const RecipeValue& v, ConditioningOptions& c) { c.enabled = v.flag(); }},
    {"smooth", [](const RecipeValue& v, ConditioningOptions& c) { c.smooth = v.number(0, 1000); }},
    {"max_turn",
     [](const RecipeValue& v, ConditioningOptions& c) { c.max_turn = v.degrees(0.1, 180); }},
    {"min_radius", [](const RecipeValue& v, ConditioningOptions& c) { c.min_radius = v.positive_length(); }},
};

void read_conditioning(const RecipeValue& v, SurfaceOptions& surface) {
  if (v.is_flag())
    surface.conditioning.enabled = v.flag();
  else if (v.is_text())
    surface.conditioning.enabled = v.choice({"off", "on"}) == 1;
  else
    read_table(v, kConditioningKeys, surface.conditioning);
}

void read_bend(const RecipeValue& v, SurfaceOptions& surface) {
  surface.bend.clear();
  for (const RecipeValue& order : v.elements()) surface.bend.push_back(order.degrees(-170, 170));
}

const KeyRule<SurfaceOptions> kSurfaceKeys[] = {
    {"profile",
     [](const RecipeValue& v, SurfaceOptions& s) {
       s.profile = v.choice({"chain", "galbraith"}) == 0 ? Profile::kChain : Profile::kGalbraith;
     }},
    {"ridges", [](const RecipeValue& v, SurfaceOptions& s) { s.ridges = v.flag(); }},
    {"lip", [](const RecipeValue& v, SurfaceOptions& s) { s.lip = v.number(0, 4); }},
    {"width", [](const RecipeValue& v, SurfaceOptions& s) { s.width = v.number(1e-6, kIso); }},
    {"bend", read_bend},
    {"seed",
     [](const RecipeValue& v, SurfaceOptions& s) { s.seed = static_cast<std::uint64_t>(v.integer(0, kLargestInteger)); }},
    {"conditioning", read_conditioning},
};

// ---- [[prune]], [[scar]], [scars] ------------------------------------------------------------------------------
void read_branch(const RecipeValue& v, BranchSelector& where) {
  where.branch = static_cast<std::uint32_t>(v.integer(0, std::numeric_limits<std::uint32_t>::max()));
}

const KeyRule<Prune> kPruneKeys[] = {
    {"branch", [](const RecipeValue& v, Prune& p) { read_branch(v, p.where); }},
    {"position", [](const RecipeValue& v, Prune& p) { p.where.position = v.point(); }},
    {"distance", [](const RecipeValue& v, Prune& p) { p.distance = v.not_negative_length(); }},
    {"normal", [](const RecipeValue& v, Prune& p) { p.normal = v.direction(); }},
};

const KeyRule<Scar> kScarKeys[] = {
    {"branch", [](const RecipeValue& v, Scar& s) { read_branch(v, s.where); }},
    {"position", [](const RecipeValue& v, Scar& s) { s.where.position = v.point(); }},
    {"along", [](const RecipeValue& v, Scar& s) { s.along = v.not_negative_length(); }},
    {"angle", [](const RecipeValue& v, Scar& s) { s.angle = v.degrees(); }},
    {"radius", [](const RecipeValue& v, Scar& s) { s.radius = v.positive_length(); }},
    {"depth", [](const RecipeValue& v, Scar& s) { s.depth = v.number(0.01, 10); }},
};

const KeyRule<RandomScars> kRandomScarsKeys[] = {
    {"count", [](const RecipeValue& v, RandomScars& s) { s.count = static_cast<int>(v.integer(0, 1'000'000)); }},
    {"min_radius", [](const RecipeValue& v, RandomScars& s) { s.min_axis_radius = v.not_negative_length(); }},
};

void require_one_place(const RecipeValue& v, const BranchSelector& where) {
  if (where.branch.has_value() == where.position.has_value())
    v.refuse(where.branch ? "either branch or position, not both" : "branch = id or position = [x, y, z] in it");
}

void read_prunes(const RecipeValue& v, Recipe& recipe) {
  for (const RecipeValue& element : v.elements()) {
    Prune prune;
    read_table(element, kPruneKeys, prune);
    require_one_place(element, prune.where);
    recipe.surface.prunes.push_back(prune);
    recipe.prunes_at.push_back(element.location());
  }
}

void read_scars(const RecipeValue& v, Recipe& recipe) {
  for (const RecipeValue& element : v.elements()) {
    Scar scar;
    read_table(element, kScarKeys, scar);
    require_one_place(element, scar.where);
    recipe.surface.scars.push_back(scar);
    recipe.scars_at.push_back(element.location());
  }
}

// ---- [bark] ----------------------------------------------------------------------------------------------------
void read_bark_style(const RecipeValue& v, BarkRecipe& b) {
  constexpr BarkStyle kStyles[] = {BarkStyle::kRidged, BarkStyle::kPlated, BarkStyle::kSmooth, BarkStyle::kBirch};
  b.material.style = kStyles[v.choice({"ridged", "plated", "smooth", "birch"})];
}

const KeyRule<BarkRecipe> kMaterialKeys[] = {
    {"style", read_bark_style},
    {"color", [](const RecipeValue& v, BarkRecipe& b) { b.material.color = v.color(); }},
    {"crack_color", [](const RecipeValue& v, BarkRecipe& b) { b.material.crack_color = v.color(); }},
    {"scale", [](const RecipeValue& v, BarkRecipe& b) { b.material.scale = v.positive(); }},
    {"young_color", [](const RecipeValue& v, BarkRecipe& b) { b.material.young_color = v.color(); }},
    {"mature_radius", [](const RecipeValue& v, BarkRecipe& b) { b.material.mature_radius = v.not_negative_length(); }},
    {"texture", [](const RecipeValue& v, BarkRecipe& b) { b.texture = {v.file(), v.location()}; }},
    {"normal_map", [](const RecipeValue& v, BarkRecipe& b) { b.normal_map = {v.file(), v.location()}; }},
    {"normal_convention",
     [](const RecipeValue& v, BarkRecipe& b) {
       constexpr TextureUse kConventions[] = {TextureUse::kNormalOpenGl, TextureUse::kNormalDirectX};
       b.normal_convention = kConventions[v.choice({"opengl", "directx"})];
     }},
    {"roughness_map", [](const RecipeValue& v, BarkRecipe& b) { b.roughness_map = {v.file(), v.location()}; }},
    {"texture_size", [](const RecipeValue& v, BarkRecipe& b) { b.material.texture_size = v.positive_length(); }},
};

/// Maps belong to a texture: by themselves nothing would say what they cover.
void require_texture_beside_maps(const BarkRecipe& bark) {
  if (bark.texture) return;
  if (bark.normal_map) throw InputError(bark.normal_map->named_at, "a normal map alone", "a texture that it belongs to");
  if (bark.roughness_map) throw InputError(bark.roughness_map->named_at, "a roughness map alone", "a texture that it belongs to");
}

/// [bark] is what every order starts from; each [[bark.order]] changes it for one order, 0 being the trunk.
void read_bark(const RecipeValue& v, Recipe& recipe) {
  BarkRecipe common;
  read_table(v, kMaterialKeys, common, {"order"});
  recipe.bark.clear();
  if (const toml::node* orders = v.table().get("order")) {
    for (const RecipeValue& order : RecipeValue(v.source(), *orders, v.child_path("order")).elements()) {
      recipe.bark.push_back(common);
      read_table(order, kMaterialKeys, recipe.bark.back());
    }
  }
  if (recipe.bark.empty()) recipe.bark.push_back(common);
  for (const BarkRecipe& bark : recipe.bark) require_texture_beside_maps(bark);
}

// ---- [mesh], [volume] ------------------------------------------------------------------------------------------
void read_levels(const RecipeValue& v, MeshRecipe& mesh) {
  mesh.lod.clear();
  for (const RecipeValue& level : v.elements()) {
    const std::size_t triangles = level.is_text() ? parse_count(level.text(), level.location())
                                                  : static_cast<std::size_t>(level.integer(1, kLargestInteger));
    if (!mesh.lod.empty() && triangles >= mesh.lod.back()) level.refuse("fewer triangles than the level before");
    mesh.lod.push_back(triangles);
  }
}

const KeyRule<MeshRecipe> kMeshKeys[] = {
    {"voxel", [](const RecipeValue& v, MeshRecipe& m) { m.polygonize.voxel = v.positive_length(); }},
    {"tolerance",
     [](const RecipeValue& v, MeshRecipe& m) {
       if (m.polygonize.voxel) v.refuse("either voxel or tolerance, not both");
       m.polygonize.tolerance = v.positive_length();
     }},
    {"max_triangles",
     [](const RecipeValue& v, MeshRecipe& m) {
       m.lod = {static_cast<std::size_t>(v.integer(1, kLargestInteger))};
     }},
    {"min_sides", [](const RecipeValue& v, MeshRecipe& m) { m.polygonize.min_sides = static_cast<double>(v.integer(4, 64)); }},
    {"lod", read_levels},
    {"occlusion", [](const RecipeValue& v, MeshRecipe& m) { m.occlusion = v.flag(); }},
};

const KeyRule<VolumeOptions> kVolumeKeys[] = {
    {"voxel", [](const RecipeValue& v, VolumeOptions& o) { o.voxel = v.positive_length(); }},
    {"kind",
     [](const RecipeValue& v, VolumeOptions& o) {
       constexpr VolumeKind kKinds[] = {VolumeKind::kSdf, VolumeKind::kField, VolumeKind::kFog};
       o.kind = kKinds[v.choice({"sdf", "field", "fog"})];
     }},
    {"half_width", [](const RecipeValue& v, VolumeOptions& o) { o.half_width = v.number(1, 100); }},
};

// ---- all of it -------------------------------------------------------------------------------------------------
const KeyRule<Recipe> kRecipeKeys[] = {
    {"skeleton", [](const RecipeValue& v, Recipe& r) { read_table(v, kSkeletonKeys, r.skeleton); }},
    {"surface", [](const RecipeValue& v, Recipe& r) { read_table(v, kSurfaceKeys, r.surface); }},
    {"base", [](const RecipeValue& v, Recipe& r) { r.surface.base = read_trunk_base(v), r.base_at = v.location(); }},
    {"prune", read_prunes},
    {"scar", read_scars},
    {"scars", [](const RecipeValue& v, Recipe& r) { read_table(v, kRandomScarsKeys, r.surface.random_scars); }},
    {"bark", read_bark},
    {"leaves", [](const RecipeValue& v, Recipe& r) { r.leaves = v.flag(); }},
    {"leaf", [](const RecipeValue& v, Recipe& r) { r.leaf = read_leaves(v); }},
    {"render", [](const RecipeValue& v, Recipe& r) { read_render(v, r.render); }},
    {"mesh", [](const RecipeValue& v, Recipe& r) { read_table(v, kMeshKeys, r.mesh); }},
    {"volume", [](const RecipeValue& v, Recipe& r) { read_table(v, kVolumeKeys, r.volume); }},
};

Recipe read_root(toml::table root, RecipeSource source, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) apply_override(text, root, source);
  Recipe recipe;
  read_table(RecipeValue(source, root, ""), kRecipeKeys, recipe);
  return recipe;
}

}  // namespace

std::vector<std::size_t> parse_levels(std::string_view text, const SourceLocation& at) {
  std::vector<std::size_t> levels;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    levels.push_back(parse_count(text.substr(begin, end - begin), at));
    const std::size_t n = levels.size();
    if (n > 1 && levels[n - 1] >= levels[n - 2])
      throw InputError(at, "'" + std::string(text.substr(0, 60)) + "'", "each level to have fewer triangles than the one before");
    begin = end + 1;
  }
  return levels;
}

Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const std::string text = read_text(file);
  toml::table root;
  try {
    root = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    throw InputError({file.string(), static_cast<int>(at.line), static_cast<int>(at.column)},
                     std::string(error.description()), "TOML");
  }
  Recipe recipe = read_root(std::move(root), {file, {}}, overrides);
  if (!recipe.skeleton.has_source())
    throw InputError({file.string()}, "no skeleton", "lsystem = \"...\" or file = \"...\" in [skeleton], or [skeleton.graph]");
  return recipe;
}

Recipe empty_recipe(const std::filesystem::path& input, const std::vector<std::string>& overrides) {
  Recipe recipe = read_root({}, {input, {}}, overrides);
  if (recipe.skeleton.has_source())
    throw InputError(recipe.skeleton.named_at, "a skeleton source for an input that is one",
                     "a recipe (.tree.toml) as input");
  return recipe;
}

}  // namespace cambium
