#include "cli/close_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace cambium {
namespace {

constexpr double kFramedRadii = 3;      // to each side
constexpr double kAlongTheBranch = 1;   // from the pivot to the middle of the picture, in the same radii

const BranchInfo& info_of(const NamedBranch& branch, std::span<const BranchInfo> branches) {
  const std::string found = fmt::format("branch {}", branch.id);
  if (branches.empty()) throw InputError(branch.at, found, "a tree whose branches are known: a BlobTree file has none");
  if (branch.id >= branches.size()) throw InputError(branch.at, found, fmt::format("0 to {}: see cambium info", branches.size() - 1));
  return branches[branch.id];
}

/// Of the thickest branch there, metres.
double radius_at(const Field& field, const Vec3& p) {
  Evaluator evaluator;
  std::vector<Contribution> contributions;
  evaluator.contributions(field.prune({p, p}), p, contributions);
  double radius = 0;
  for (const Contribution& c : contributions) radius = std::max(radius, c.radius);
  return radius;
}

}  // namespace

void aim_at_branches(RenderRecipe& render, const Field& field, std::span<const BranchInfo> branches) {
  if (render.focus_branch) render.camera.focus = info_of(*render.focus_branch, branches).pivot;
  if (!render.close_up) return;
  const BranchInfo& branch = info_of(*render.close_up, branches);
  const double radius = radius_at(field, branch.pivot);
  if (!(radius > 0)) {
    throw InputError(render.close_up->at, fmt::format("branch {}, whose beginning is cut away", render.close_up->id),
                     "a branch that is there");
  }
  const Vec3 middle = branch.pivot + kAlongTheBranch * radius * branch.axis;
  render.camera.frame = Box{middle, middle}.padded(kFramedRadii * radius);
}

}  // namespace cambium
