#include "skeletons/surface.h"

#include "blobtree/input_error.h"
#include "skeletons/branch_edits.h"
#include "skeletons/conditioning.h"
#include "skeletons/foliage_follow.h"
#include "skeletons/profiles.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

void check(const SurfaceOptions& options) {
  if (!(options.width > 0 && options.width <= kIso))
    throw InputError({}, "width " + std::to_string(options.width), "a contact width above 0, at most 0.5");
  if (!(options.lip >= 0 && options.lip <= 4))
    throw InputError({}, "lip " + std::to_string(options.lip), "a lip from 0 to 4");
  for (const double angle : options.bend)
    if (!std::isfinite(angle)) throw InputError({}, "a bend that is no number", "a finite angle");
  if (!options.base) return;
  check_trunk_base(*options.base);
  if (options.profile != Profile::kChain) throw InputError({}, "base: a flare on the galbraith profile", "profile chain");
}

void describe(const AxisTree& tree, SurfaceReport& report) {
  report.axes = tree.axes.size();
  report.min_radius = kInfinity;
  for (const Axis& axis : tree.axes) {
    report.internodes += axis.nodes.size() - 1;
    report.max_order = std::max<std::size_t>(report.max_order, axis.order);
    report.roots += axis.parent < 0 ? 1 : 0;
    report.total_length += length_of(axis);
    for (const AxisNode& node : axis.nodes) {
      report.min_radius = std::min(report.min_radius, node.radius);
      report.max_radius = std::max(report.max_radius, node.radius);
    }
  }
}

std::vector<BranchInfo> branches_of(const AxisTree& tree) {
  std::vector<BranchInfo> branches(tree.branch_count);
  for (const Axis& axis : tree.axes) {
    BranchInfo& branch = branches[axis.branch];
    branch.pivot = axis.nodes[0].position;
    branch.axis = segment_direction(axis, 0);
    if (axis.parent < 0) continue;
    branch.parent = static_cast<std::int32_t>(tree.axes[axis.parent].branch);
    branch.pivot = position_at(tree.axes[axis.parent], axis.attach);
  }
  return branches;
}

Surfaced surfaced(const Skeleton& skeleton, const SurfaceOptions& options, const Foliage& foliage) {
  Surfaced made;
  SurfaceReport& report = made.report;
  for (const SkeletonNode& node : skeleton.nodes) report.internodes_in += node.parent >= 0 ? 1 : 0;

  const RadiusSteps steps = options.profile == Profile::kChain ? RadiusSteps::kTaper : RadiusSteps::kKeep;
  AxisTree tree = decompose_axes(skeleton, steps, &report.nodes_dropped, nodes_ridden(foliage));
  condition(tree, options.conditioning, options.profile, options.bend, report);
  apply_prunes(tree, options.prunes, options.profile, report);
  const std::vector<AxisFrame> frames = frames_of(tree);
  const std::vector<PlacedScar> scars = place_scars(tree, frames, options, report);
  describe(tree, report);
  made.branches = branches_of(tree);
  follow_wood(foliage, skeleton, tree, made);

  BlobTreeBuilder builder;
  const auto build = options.profile == Profile::kChain ? build_chain_profile : build_galbraith_profile;
  try {
    made.tree = builder.build(build(tree, frames, options, scars, builder, report));
  } catch (const InvalidNode& error) {  // coordinates or radii beyond what a BlobTree holds
    throw InputError({}, error.found() + " as " + error.key() + " of the surface", error.expected());
  }
  return made;
}

}  // namespace

Surfaced surface(const Skeleton& skeleton, const SurfaceOptions& options, const Foliage& foliage) {
  if (skeleton.nodes.empty()) throw InputError({}, "a skeleton without nodes", "at least one");
  check(options);
  if (options.base && options.base->roots.length > 0) return surfaced(rooted(skeleton, *options.base, options.seed), options, foliage);
  return surfaced(skeleton, options, foliage);
}

}  // namespace cambium
