// One run of one command: what was asked, how to run it, what it reports; and the stages that commands share.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blobtree/field.h"
#include "cli/command_line.h"
#include "cli/figures.h"
#include "cli/input_kind.h"
#include "cli/progress.h"
#include "cli/recipe.h"
#include "skeletons/skeleton_io.h"

namespace cambium {

enum class Outcome { kDone, kInterrupted };

class Job {
 public:
  /// Reads the recipe and applies --set and --seed. Errors: InputError.
  Job(const CommandLine& line, const std::atomic<bool>& cancel);
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  const CommandLine& line;
  Recipe recipe;
  std::filesystem::path source;                  ///< the file that the tree comes from: the input, or what the recipe names
  InputKind source_kind = InputKind::kSkeleton;  ///< kRecipe: the recipe itself, which has a graph
  Figures figures;
  ProgressLine progress;
  RunOptions run;
  std::optional<Plant> grown;                    ///< in place of what the source would give
  std::vector<std::string> warnings;             ///< lines for stderr once the work is done: what was made is not all it should be
};

// Each stage times itself in job.figures and returns nullopt when interrupted. Errors: InputError, also where the source
// cannot give what the stage makes.

/// The L-system that the source is.
LSystem load_lsystem(const Job& job);
/// What the command line and the recipe say of a derivation; the model's printf goes to stderr unless --quiet.
DeriveOptions derive_options(const Job& job);
std::optional<ModuleString> derive_string(Job& job, const LSystem& system);
/// With the foliage that it bears, unless the recipe or --no-leaves leaves that out.
std::optional<Plant> grow_plant(Job& job);

/// A BlobTree and, unless it was read from a file, what happened on the way to it.
struct BuiltTree {
  BlobTree tree;
  std::optional<SurfaceReport> report;
  std::vector<BranchInfo> branches;              ///< by id; empty if it was read from a file
  Foliage foliage;                               ///< where the surfaced wood bears it
  std::vector<std::uint32_t> organ_branches;     ///< by organ
  std::optional<double> ground;                  ///< metres: the height of what the trunk stands on, where the recipe has a base
};
/// thinnest: twigs of a skeleton are thickened to this part of its diagonal, for what is only a first look.
std::optional<BuiltTree> build_tree(Job& job, double thinnest = 0);

Field compile_field(Job& job, const BlobTree& tree);
/// build_tree and compile_field.
std::optional<Field> build_field(Job& job);

/// The recipe's bark with its images loaded; empty: the built-in.
std::vector<BarkMaterial> load_bark(const Recipe& recipe);
/// The image that the recipe names as its surroundings; null if none. Errors: InputError at the place that names it.
std::shared_ptr<const Environment> load_surroundings(const RenderRecipe& render);

}  // namespace cambium
