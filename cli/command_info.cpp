// info: counts, bounds, radii, and what conditioning did.
#include <algorithm>
#include <map>
#include <span>

#include "cli/commands.h"

namespace cambium {
namespace {

Json as_json(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

double path_length(std::span<const ChainNode> nodes) {
  double length = 0;
  for (std::size_t i = 1; i < nodes.size(); ++i) length += glm::distance(nodes[i - 1].position, nodes[i].position);
  return length;
}

/// Axes as [[prune]] and [[scar]] name them, ascending ids. On `galbraith`, which has no chains, a branch is its cones.
Json list_branches(const BlobTree& tree) {
  struct Branch {
    std::uint32_t order = 0;
    double v_begin = kInfinity, length = 0, radius_begin = 0, radius_end = 0;
    Vec3 begin{0.0};
  };
  std::map<std::uint32_t, Branch> branches;
  const auto add = [&](NodeId id, const Vec3& begin, double length, double radius_begin, double radius_end) {
    const Attributes& attributes = tree.attributes(id);
    Branch& branch = branches[attributes.branch];
    branch.order = attributes.order;
    branch.length += length;
    if (attributes.v_begin < branch.v_begin)
      branch.v_begin = attributes.v_begin, branch.begin = begin, branch.radius_begin = radius_begin;
    branch.radius_end = branch.radius_end > 0 ? std::min(branch.radius_end, radius_end) : radius_end;
  };
  for (NodeId id = 0; id < tree.size(); ++id) {
    if (tree.kind(id) == kNodeKind<Chain> || tree.kind(id) == kNodeKind<Flare>) {
      const std::span<const ChainNode> nodes = tree.chain_nodes(id);
      add(id, nodes.front().position, path_length(nodes), nodes.front().radius, nodes.back().radius);
    } else if (tree.kind(id) == kNodeKind<Cone>) {
      const Cone cone = tree.get<Cone>(id);
      if (cone.strength > 0) add(id, cone.base, glm::distance(cone.base, cone.tip), cone.radius_base, cone.radius_tip);
    }
  }
  Json list = Json::array();
  for (const auto& [id, branch] : branches)
    list.push_back({{"branch", id},
                    {"order", branch.order},
                    {"position", as_json(branch.begin)},
                    {"length", branch.length},
                    {"radius_base", branch.radius_begin},
                    {"radius_tip", branch.radius_end}});
  return list;
}

/// By name.
Json organ_counts(const Foliage& foliage) {
  std::map<std::string, std::size_t> counts;
  for (const OrganPlacement& organ : foliage.organs) ++counts[foliage.shapes[organ.shape].name];
  return counts;
}

void report_surface(Job& job, const SurfaceReport& report) {
  Figures& figures = job.figures;
  figures.set("internodes_in", report.internodes_in);
  figures.set("internodes", report.internodes);
  figures.set("axes", report.axes);
  figures.set("max_order", report.max_order);
  figures.set("roots", report.roots);
  figures.set("total_length", report.total_length);
  figures.set("conditioning", {{"radii_clamped", report.radii_clamped},
                               {"nodes_dropped", report.nodes_dropped},
                               {"laterals_rerooted", report.laterals_rerooted},
                               {"largest_move", report.largest_move}});
  if (report.organs_pruned > 0) figures.set("organs_pruned", report.organs_pruned);
  figures.set("notes", report.notes);
}

}  // namespace

Outcome run_info(Job& job) {
  const auto built = build_tree(job);
  if (!built) return Outcome::kInterrupted;
  const Field field = compile_field(job, built->tree);
  if (built->report) report_surface(job, *built->report);
  if (!built->foliage.organs.empty()) job.figures.set("organs", organ_counts(built->foliage));
  double min_radius = kInfinity, max_radius = 0;
  for (std::uint32_t atom = 0; atom < field.atom_count(); ++atom) {
    const double radius = field.atom_radius(atom);
    if (radius == kInfinity) continue;
    min_radius = std::min(min_radius, radius);
    max_radius = std::max(max_radius, radius);
  }
  job.figures.set("nodes", built->tree.size());
  job.figures.set("primitives", field.atom_count());
  if (max_radius > 0) {
    job.figures.set("min_radius", built->report ? built->report->min_radius : min_radius);
    job.figures.set("max_radius", built->report ? built->report->max_radius : max_radius);
  }
  job.figures.set("bounds", {{"lo", as_json(field.bounds().lo)}, {"hi", as_json(field.bounds().hi)}});
  if (built->report) job.figures.set("branches", list_branches(built->tree));
  return job.run.cancelled() ? Outcome::kInterrupted : Outcome::kDone;
}

}  // namespace cambium
