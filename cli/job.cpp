#include "cli/job.h"

#include <cstdio>
#include <utility>

#include "blobtree/blobtree_json.h"
#include "cli/read_text.h"
#include "raytrace/environment.h"

namespace cambium {
namespace {

/// Sets source and source_kind, and checks that there is such a file.
void find_source(Job& job) {
  const SkeletonRecipe& skeleton = job.recipe.skeleton;
  if (skeleton.lsystem) {
    job.source = *skeleton.lsystem;
    job.source_kind = InputKind::kLSystem;
  } else if (skeleton.file) {
    job.source = *skeleton.file;
    job.source_kind = input_kind(job.source);
    if (job.source_kind == InputKind::kRecipe)
      throw InputError(skeleton.named_at, "a recipe as the skeleton's file", ".skel.json, .swc, .csv or .blob.json");
  }
  require_readable(job.source, job.source == job.line.input ? nullptr : &skeleton.named_at);
}

std::optional<Plant> walk_turtle(Job& job, const ModuleString& string, const LSystem& system) {
  const StageTimer timer(job.figures, "turtle");
  auto turtled = interpret(string, system, job.recipe.skeleton.turtle, job.run);
  if (!turtled) return std::nullopt;
  if (turtled->radii_clamped > 0) job.figures.set("turtle_radii_clamped", turtled->radii_clamped);
  if (!turtled->skipped.empty()) job.figures.set("skipped_symbols", turtled->skipped);
  return Plant{std::move(turtled->skeleton), std::move(turtled->foliage)};
}

Json as_json(const GraphReport& report) {
  Json levels = Json::array();
  for (const GraphReport::Level& level : report.levels)
    levels.push_back({{"graphs", level.graphs}, {"nodes", level.nodes}, {"edges", level.edges}, {"endpoints", level.endpoints}});
  return {{"nodes", report.nodes},
          {"edges", report.edges},
          {"endpoints", report.endpoints},
          {"repaired", report.repaired},
          {"short_of_nodes", report.short_of_nodes},
          {"short_of_endpoints", report.short_of_endpoints},
          {"levels", std::move(levels)},
          {"notes", report.notes}};
}

std::optional<Plant> plan_plant(Job& job) {
  const StageTimer timer(job.figures, "plan");
  auto plan = plan_tree(*job.recipe.skeleton.graph, job.run);
  if (!plan) return std::nullopt;
  Json figures = as_json(plan->report);
  if (plan->below_ground > 0) figures["nodes_of_roots"] = plan->below_ground;
  job.figures.set("graph", std::move(figures));
  return Plant{std::move(plan->skeleton), {}};
}

/// What the source says is there, leaves and all.
std::optional<Plant> read_or_grow(Job& job) {
  if (job.grown) return job.grown;
  if (job.source_kind == InputKind::kRecipe) return plan_plant(job);
  if (job.source_kind == InputKind::kSkeleton) {
    const StageTimer timer(job.figures, "read");
    return read_plant(job.source);
  }
  const LSystem system = load_lsystem(job);
  const auto string = derive_string(job, system);
  if (!string || job.run.cancelled()) return std::nullopt;
  return walk_turtle(job, *string, system);
}

/// surface() knows no files. Where it refuses one of the recipe's prunes or scars, the place in the recipe is that of the
/// first that is refused alone.
Surfaced surface_with_places(const Job& job, const Plant& plant) {
  const Skeleton& skeleton = plant.skeleton;
  const SurfaceOptions& options = job.recipe.surface;
  try {
    return surface(skeleton, options, plant.foliage);
  } catch (const InputError& error) {
    if (!error.location().file.empty()) throw;
    if (error.found().starts_with("base: ")) throw InputError(job.recipe.base_at, error.found(), error.expected());
    const auto refused_alone = [&](const std::vector<Prune>& prunes, const std::vector<Scar>& scars) {
      SurfaceOptions alone = options;
      alone.prunes = prunes;
      alone.scars = scars;
      alone.random_scars.count = 0;
      try {
        surface(skeleton, alone);
      } catch (const InputError&) {
        return true;
      }
      return false;
    };
    for (std::size_t i = 0; i < options.prunes.size(); ++i)
      if (refused_alone({options.prunes[i]}, {})) throw InputError(job.recipe.prunes_at[i], error.found(), error.expected());
    for (std::size_t i = 0; i < options.scars.size(); ++i)
      if (refused_alone({}, {options.scars[i]})) throw InputError(job.recipe.scars_at[i], error.found(), error.expected());
    throw InputError({job.source.string()}, error.found(), error.expected());
  }
}

}  // namespace

Job::Job(const CommandLine& command_line, const std::atomic<bool>& cancel)
    : line(command_line), source(line.input), progress(!line.quiet) {
  require_readable(line.input);
  const InputKind kind = input_kind(line.input);
  recipe = kind == InputKind::kRecipe ? read_recipe(line.input, line.overrides) : empty_recipe(line.input, line.overrides);
  source_kind = kind;
  find_source(*this);
  if (line.label) recipe.skeleton.label = line.label;
  if (!line.dialect.empty()) recipe.skeleton.dialect = dialect_named(line.dialect);
  if (line.seed) {
    recipe.skeleton.seed = line.seed;
    recipe.surface.seed = *line.seed;
    recipe.render.seed = *line.seed;
  }
  if (line.no_leaves) recipe.leaves = false;
  if (auto& graph = recipe.skeleton.graph; graph && recipe.skeleton.seed) graph->options.seed = *recipe.skeleton.seed;
  run.threads = line.threads;
  run.cancel = &cancel;
  run.progress = [this](std::string_view stage, double fraction) { progress.show(stage, fraction); };
  figures.set("command", line.command_name);
  figures.set("input", line.input);
  if (!line.output.empty()) figures.set("output", line.output);
}

LSystem load_lsystem(const Job& job) {
  return LSystem::load(job.source, job.recipe.skeleton.label, job.recipe.skeleton.dialect);
}

DeriveOptions derive_options(const Job& job) {
  DeriveOptions options;
  options.seed = job.recipe.skeleton.seed;
  options.steps = job.line.step ? job.line.step : job.recipe.skeleton.steps;
  options.turtle = job.recipe.skeleton.turtle;
  options.max_modules = job.line.max_modules.value_or(options.max_modules);
  if (!job.line.quiet) options.print = [](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); };
  return options;
}

std::optional<ModuleString> derive_string(Job& job, const LSystem& system) {
  const StageTimer timer(job.figures, "derive");
  return derive(system, derive_options(job), job.run);
}

std::optional<Plant> grow_plant(Job& job) {
  if (job.source_kind == InputKind::kBlobTree)
    throw InputError({job.source.string()}, "a BlobTree",
                     "an input with a skeleton: .tree.toml, .l, .lpy, .skel.json, .swc or .csv");
  auto plant = read_or_grow(job);
  if (plant && !job.recipe.leaves) plant->foliage = {};
  return plant;
}

std::optional<BuiltTree> build_tree(Job& job, double thinnest) {
  if (job.source_kind == InputKind::kBlobTree) {
    const StageTimer timer(job.figures, "read");
    return BuiltTree{read_blobtree(job.source), std::nullopt, {}, {}, {}, {}};
  }
  const auto plant = grow_plant(job);
  if (!plant || job.run.cancelled()) return std::nullopt;
  if (thinnest > 0) {
    Box bounds;
    for (const SkeletonNode& node : plant->skeleton.nodes) bounds.extend(node.position);
    std::optional<double>& least = job.recipe.surface.conditioning.min_radius;
    const double radius = bounds.empty() ? 0 : thinnest * glm::length(bounds.size());
    if (radius > least.value_or(0)) least = radius;
  }
  const StageTimer timer(job.figures, "surface");
  Surfaced surfaced = surface_with_places(job, *plant);
  std::optional<double> ground;
  if (const auto& base = job.recipe.surface.base) ground = ground_of(*base, plant->skeleton.nodes[0].position).point.z;
  return BuiltTree{std::move(surfaced.tree), std::move(surfaced.report), std::move(surfaced.branches), std::move(surfaced.foliage),
                   std::move(surfaced.organ_branches), ground};
}

Field compile_field(Job& job, const BlobTree& tree) {
  const StageTimer timer(job.figures, "compile");
  try {
    return Field(tree);
  } catch (const InvalidNode& error) {
    throw InputError({job.source.string()}, error.found() + " for '" + error.key() + "'", error.expected());
  }
}

std::optional<Field> build_field(Job& job) {
  const auto built = build_tree(job);
  if (!built || job.run.cancelled()) return std::nullopt;
  return compile_field(job, built->tree);
}

std::vector<BarkMaterial> load_bark(const Recipe& recipe) {
  const auto load = [](const std::optional<NamedFile>& image, TextureUse use) -> std::shared_ptr<const TextureImage> {
    if (!image) return nullptr;
    require_readable(image->file, &image->named_at);
    return load_texture(image->file, use);
  };
  std::vector<BarkMaterial> materials;
  for (const BarkRecipe& bark : recipe.bark) {
    BarkMaterial& material = materials.emplace_back(bark.material);
    material.texture = load(bark.texture, TextureUse::kColor);
    material.normal_map = load(bark.normal_map, bark.normal_convention);
    material.roughness_map = load(bark.roughness_map, TextureUse::kRoughness);
  }
  return materials;
}

std::shared_ptr<const Environment> load_surroundings(const RenderRecipe& render) {
  if (!render.environment) return nullptr;
  const EnvironmentRecipe& named = *render.environment;
  try {
    return load_environment(named.file, named.rotation, named.strength);
  } catch (const InputError& error) {
    throw InputError(named.named_at, error.found() + " in '" + named.file.string() + "'", error.expected());
  }
}

}  // namespace cambium
