// From a skeleton to a BlobTree (field.md section 6; Galbraith, MacMurchy, Wyvill 2004, section 3).
#pragma once

#include "blobtree/blobtree.h"
#include "blobtree/branch_info.h"
#include "blobtree/run_options.h"
#include "skeletons/foliage.h"
#include "skeletons/skeleton.h"
#include "skeletons/trunk_base.h"

#include <optional>
#include <string>
#include <vector>

namespace cambium {

enum class Profile { kChain, kGalbraith };

struct ConditioningOptions {
  bool enabled = true;
  double smooth = 2.5;                 ///< in radii; 0 leaves positions alone
  double max_turn = 0.0872664626;      ///< radians between neighbouring segments after resampling (5 degrees)
  std::optional<double> min_radius;    ///< metres; unset: 1e-3 of the largest radius
};

/// A branch to work on: an axis by its id (0 is the trunk; ids as `info` lists them) or by the place nearest to it.
struct BranchSelector {
  std::optional<std::uint32_t> branch;
  std::optional<Vec3> position;
};

/// Saw off one branch (and what it bears beyond the cut) by a plane at `distance` along it from its attachment.
struct Prune {
  BranchSelector where;
  double distance = 0.1;               ///< metres along the axis from where it leaves its parent's surface
  std::optional<Vec3> normal;          ///< of the cut; unset: along the branch
};

/// A scar: a shortened stub with a negative field summed onto it (paper section 3.4).
struct Scar {
  BranchSelector where;                ///< with `position`: placed at the nearest point of the nearest axis
  double along = 0;                    ///< metres along the branch from its base, where chosen by id
  double angle = 0;                    ///< radians about the axis
  std::optional<double> radius;        ///< metres; unset: 0.4 of the local axis radius
  double depth = 1;                    ///< strength of the dent, > 0
};

struct RandomScars {
  int count = 0;
  double min_axis_radius = 0;          ///< only on axes at least this thick, metres
};

struct SurfaceOptions {
  Profile profile = Profile::kChain;
  bool ridges = true;
  double width = kIso;                 ///< PCM propagation width, (0, 0.5]
  double lip = 0;                      ///< [0, 4]
  std::vector<double> bend;            ///< radians per branch order (index = order); the last one goes on; empty: none
  ConditioningOptions conditioning;
  std::vector<Prune> prunes;
  std::vector<Scar> scars;
  RandomScars random_scars;
  std::optional<TrunkBase> base;       ///< of the trunk that the first node is the root of; on the chain profile only
  std::uint64_t seed = 0;
};

/// What happened on the way, for `info`. Counts.
struct SurfaceReport {
  std::size_t internodes_in = 0, internodes = 0, axes = 0, max_order = 0, roots = 0;
  std::size_t radii_clamped = 0;       ///< raised to the minimum or lowered to their parent's
  std::size_t nodes_dropped = 0;       ///< inside their parent's solid, or merged
  std::size_t laterals_rerooted = 0;
  double largest_move = 0;             ///< metres, by smoothing
  std::size_t organs_pruned = 0;       ///< that went with the wood they were on
  double min_radius = 0, max_radius = 0, total_length = 0;
  std::vector<std::string> notes;      ///< one sentence each
};

struct Surfaced {
  BlobTree tree;
  SurfaceReport report;
  std::vector<BranchInfo> branches;    ///< by branch id; defaults for ids whose axis was pruned away
  Foliage foliage;                     ///< that is left, moved and turned along with the wood it is on
  std::vector<std::uint32_t> organ_branches;  ///< by organ: the branch that bears it; the trunk for one that is on no node
};

/// Never fails on a valid skeleton with at least one internode. Deterministic for a seed. Cost: linear in the internodes that come out.
/// The foliage follows its nodes as they are smoothed, re-rooted and bent on the chain profile, but not through galbraith's bends, which
/// are warps of the field; what is on wood beyond a prune is left out.
/// Errors: InputError without a location (the caller knows the file) for an empty skeleton, or a prune or scar that names no branch.
/// Precondition: the foliage's nodes are the skeleton's.
Surfaced surface(const Skeleton& skeleton, const SurfaceOptions& options, const Foliage& foliage = {});

}  // namespace cambium
