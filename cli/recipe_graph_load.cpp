// What [skeleton.graph] names by files, read.
#include "blobtree/place_hash.h"
#include "cli/read_text.h"
#include "cli/recipe_graph.h"
#include "polygonize/mesh_read.h"
#include "polygonize/volume_read.h"
#include "skeletons/graph/closed_mesh.h"

namespace cambium {
namespace {

std::string text_of(const NamedFile& named) {
  require_readable(named.file, &named.named_at);
  return read_text(named.file);
}

/// An error without a place is about what the file holds: it is told where the recipe names it.
template <class Make>
auto made_of(const NamedFile& named, Make&& make) {
  try {
    return make();
  } catch (const InputError& error) {
    if (!error.location().file.empty()) throw;
    throw InputError(named.named_at, error.found() + " in '" + named.file.string() + "'", error.expected());
  }
}

RevolutionSolid load_stroke(const NamedFile& svg, const SvgStrokeOptions& options) {
  RevolutionSolid solid{read_svg_stroke(text_of(svg), svg.file.string(), options)};
  made_of(svg, [&] { validate(solid); });
  return solid;
}

MeshSolid load_mesh(const NamedFile& named) {
  Mesh mesh = parse_mesh(text_of(named), named.file.string());
  return made_of(named, [&] { return MeshSolid{std::make_shared<ClosedMesh>(std::move(mesh.positions), std::move(mesh.triangles))}; });
}

PlacedSolid load_solid(const GraphSolidRecipe& recipe) {
  PlacedSolid placed = recipe.placed;
  if (recipe.svg) placed.solid = load_stroke(*recipe.svg, recipe.svg_options);
  if (recipe.mesh) placed.solid = load_mesh(*recipe.mesh);
  return placed;
}

std::shared_ptr<const WeightPaint> load_paint(const GraphRecipe& recipe) {
  if (recipe.weight_balls.empty() && !recipe.weight_volume) return nullptr;
  std::function<double(const Vec3&)> grid;
  if (recipe.weight_volume) {
    require_readable(recipe.weight_volume->file, &recipe.weight_volume->named_at);
    grid = read_factor_volume(recipe.weight_volume->file);
  }
  return std::make_shared<WeightPaint>(recipe.weight_balls, std::move(grid));
}

std::vector<PlacedSolid> load_solids(const std::vector<GraphSolidRecipe>& recipes) {
  std::vector<PlacedSolid> solids;
  for (const GraphSolidRecipe& recipe : recipes) solids.push_back(load_solid(recipe));
  return solids;
}

std::vector<GraphLevel> load_levels(const std::vector<GraphLevelRecipe>& recipes) {
  std::vector<GraphLevel> levels;
  for (const GraphLevelRecipe& recipe : recipes) levels.emplace_back(recipe.level).shape = load_solids(recipe.shape);
  return levels;
}

}  // namespace

GraphOptions load_graph(const GraphRecipe& recipe) {
  GraphOptions options = recipe.options;
  options.volume = load_solids(recipe.volume);
  options.levels = load_levels(recipe.levels);
  if (!recipe.obstacles.empty() || !recipe.half_spaces.empty())
    options.obstacles = std::make_shared<Obstacles>(load_solids(recipe.obstacles), recipe.half_spaces);
  options.paint = load_paint(recipe);
  for (const GraphRecipe& roots : recipe.roots) {
    options.roots.push_back(load_graph(roots));
    options.roots.back().seed = hash_of(options.seed, 1);   // or they would be drawn as the crown is
  }
  return options;
}

}  // namespace cambium
