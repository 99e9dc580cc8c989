// The recipe (*.tree.toml): everything about one tree in one commented file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blobtree/input_error.h"
#include "cli/named_file.h"
#include "cli/recipe_graph.h"
#include "lsystem/lsystem.h"
#include "polygonize/polygonize.h"
#include "polygonize/volume.h"
#include "raytrace/render.h"
#include "skeletons/surface.h"

namespace cambium {

/// [skeleton]: where it comes from. Exactly one of lsystem, file and graph is set in a recipe, none for any other input.
struct SkeletonRecipe {
  std::optional<std::filesystem::path> lsystem, file;  ///< relative to the working directory
  std::optional<GraphRecipe> graph;
  SourceLocation named_at;                             ///< where the recipe names it
  std::optional<std::string> label;                    ///< which L-system of the file; unset: the first
  std::optional<Dialect> dialect;                      ///< of the L-system; unset: as its file's extension says
  std::optional<int> steps;                            ///< of derivation; unset: the L-system's own
  std::optional<std::uint64_t> seed;                   ///< unset: the L-system's or the graph's own
  TurtleOptions turtle;

  bool has_source() const { return lsystem || file || graph; }
};

/// [bark] and [[bark.order]]: what one branch order is covered with.
struct BarkRecipe {
  BarkMaterial material;                            ///< without its images
  std::optional<NamedFile> texture;
  std::optional<NamedFile> normal_map, roughness_map;  ///< only beside a texture
  TextureUse normal_convention = TextureUse::kNormalOpenGl;
};

/// [[leaf]]: what organs of a name look like.
struct LeafRecipe {
  std::string name = "*";                  ///< "*": all; "polygon": all that the L-system drew between { and }
  /// An .obj: x to the left, y along the leaf from where it is held, z out of its face; one unit is as long as an outline reaches, or
  /// a metre times the scale of a ~name.
  std::optional<NamedFile> mesh;
  /// Width and length, metres, times the scale of a ~name. Neither this nor a mesh: as the organ itself is drawn.
  std::optional<std::array<double, 2>> card;
  double scale = 1;
  std::optional<Vec3> color;               ///< linear; unset: white with a texture, else leaf green
  std::optional<NamedFile> texture;
  double translucency = 0.35, roughness = 0.5;   ///< of FoliageMaterial

  bool matches(std::string_view organ) const;
};

/// Whether an organ of that name was drawn between { and }: "polygon1", "polygon2" and so on.
bool is_outline(std::string_view organ);

/// A branch that a recipe names by its number.
struct NamedBranch {
  std::uint32_t id = 0;
  SourceLocation at;
};

/// The image that is all around. Loaded only by commands that render.
struct EnvironmentRecipe {
  std::filesystem::path file;
  SourceLocation named_at;
  double rotation = 0;           ///< radians: where its middle lies
  double strength = 1;           ///< what its values are multiplied with
};

/// [render]: the options, and what they say by branches until the tree is there (close_up.h).
struct RenderRecipe : RenderOptions {
  std::optional<NamedBranch> close_up, focus_branch;
  std::optional<EnvironmentRecipe> environment;
};

/// [mesh].
struct MeshRecipe {
  PolygonizeOptions polygonize;
  std::vector<std::size_t> lod;  ///< triangles at most of each level of detail, descending; empty: one level, as it comes
  bool occlusion = true;
};

struct Recipe {
  SkeletonRecipe skeleton;
  SurfaceOptions surface;
  SourceLocation base_at;                           ///< of surface.base
  std::vector<SourceLocation> prunes_at, scars_at;  ///< of surface.prunes and surface.scars
  std::vector<BarkRecipe> bark;                     ///< by branch order, the last goes on; empty: the built-in
  bool leaves = true;                               ///< unset: foliage is left out
  std::vector<LeafRecipe> leaf;                     ///< the first that matches an organ is its; none: as drawn, green
  RenderRecipe render;                              ///< its bark is empty
  MeshRecipe mesh;
  VolumeOptions volume;
};

/// "1200k,50k,20k": levels of detail from the command line. Errors: InputError at `at`, also where they do not descend.
std::vector<std::size_t> parse_levels(std::string_view text, const SourceLocation& at);

/// Reads `file` with the `--set key=value` texts applied on top, one after the other.
/// Errors: InputError with line and column for broken TOML, unknown keys, wrong types and values out of range.
Recipe read_recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The recipe of an input that is none: defaults with the overrides applied. Paths in them are relative to the input's
/// folder.
Recipe empty_recipe(const std::filesystem::path& input, const std::vector<std::string>& overrides);

}  // namespace cambium
