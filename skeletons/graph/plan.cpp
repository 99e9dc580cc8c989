#include "skeletons/graph/plan.h"

#include "blobtree/progress_meter.h"
#include "skeletons/graph/growing_tree.h"
#include "skeletons/graph/lifespan.h"
#include "skeletons/graph/path_smoothing.h"
#include "skeletons/graph/plan_checks.h"
#include "skeletons/graph/refinement.h"
#include "skeletons/graph/subgraph.h"
#include "skeletons/graph/thickness.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kMostLevels = 255;

/// What streams of a level and of its subgraphs are drawn from for.
enum Purpose : std::uint64_t { kFirstGraph = 1, kDirection, kCount, kDecrement, kGraph, kRefine, kDealtCounts, kDealtDecrements };

/// A subgraph that is to be: around which endpoint, which way, how big, and with how many endpoints.
struct Subgraph {
  GrowthTip around;
  Vec3 direction{0, 0, 1};
  double radius = 0;
  int endpoints = 0;
  std::optional<LifespanDecrement> decrement = {};   ///< of all its endpoints; unset: each draws its own
  std::uint64_t stream = 0;
};

/// Whether p is in the volume, on its surface, or not farther from it than a hundredth of its size.
bool is_near(const GraphVolume& volume, const Vec3& p) {
  if (volume.contains(p)) return true;
  const double size = glm::length(volume.bounds().size());
  for (const Vec3& direction : yao_directions(64))
    for (const double far : {0.001, 0.01})
      if (volume.contains(p + far * size * direction)) return true;
  return false;
}

/// Plans what is above the ground or what is below.
class Planner {
 public:
  Planner(const GraphOptions& options, const RunOptions& run)
      : options_(options), run_(run), rules_{options.edges, {options.weight_low, options.weight_high, options.weight_times_length, options.paint.get()}},
        initial_lifespan_(options.lifespan.initial.value_or(static_cast<double>(options.levels.size() - 1))) {}

  /// False if cancelled.
  bool grow() {
    if (!grow_first_level()) return false;
    double radius = size_of_first_level();
    for (std::size_t level = 2; level <= last_level(); ++level) {
      const GraphLevel& rules = level_rules(level);
      radius = rules.radius.value_or(rules.shrink * radius);
      const std::vector<Subgraph> subgraphs = subgraphs_of(level, radius);
      if (subgraphs.empty()) break;
      check_size(level, subgraphs.size());
      if (!grow_level(level, subgraphs)) return false;
    }
    return true;
  }

  GraphPlan finish() {
    note_shortcomings();
    GraphPlan plan;
    for (std::size_t i = 0; i < tree_.tips.size(); ++i)
      for (const GrowthTip& tip : tree_.tips[i]) {
        plan.endpoints.push_back(tip.node);
        plan.endpoint_levels.push_back(static_cast<std::uint8_t>(i + 1));
      }
    std::vector<bool> fixed(tree_.positions.size(), false);
    for (const std::uint32_t endpoint : plan.endpoints) fixed[endpoint] = true;
    smooth_paths(tree_.positions, tree_.parents, fixed, options_.obstacles.get(), options_.smoothing);

    std::vector<double> zetas;
    for (const GraphLevel& level : options_.levels) zetas.push_back(level.zeta);
    const auto radii = path_radii({tree_.positions, tree_.parents, plan.endpoints, plan.endpoint_levels}, options_.thickness, zetas);
    plan.skeleton.nodes.resize(tree_.positions.size());
    for (std::size_t i = 0; i < plan.skeleton.nodes.size(); ++i) {
      SkeletonNode& node = plan.skeleton.nodes[i];
      node = {tree_.positions[i], radii.tip[i], i == 0 ? -1 : static_cast<std::int32_t>(tree_.parents[i]), {}, {}};
      if (i > 0) node.base_radius = radii.base[i];
    }
    plan.report = std::move(report_);
    return plan;
  }

 private:
  const GraphLevel& level_rules(std::size_t level) const { return options_.levels[std::min(level, options_.levels.size()) - 1]; }
  std::size_t last_level() const {
    return std::min(kMostLevels, static_cast<std::size_t>(std::ceil(initial_lifespan_)) + 1);
  }
  std::uint64_t level_stream(std::size_t level) const { return hash_of(options_.seed, level); }

  GraphVolume first_volume() const {
    if (!options_.refinement) return GraphVolume(options_.volume, options_.obstacles);
    return naming("refinement", [&] {
      const std::uint64_t stream = hash_of(options_.seed, 1, kRefine);
      return GraphVolume(refined(options_.volume, *options_.refinement, options_.root, options_.obstacles.get(), stream), options_.obstacles);
    });
  }

  bool grow_first_level() {
    const GraphVolume volume = first_volume();
    const GraphLevel& rules = options_.levels.front();
    const std::uint64_t stream = level_stream(1);
    StreamDraws count(hash_of(stream, kCount));
    const int endpoints = draw_count(rules, count);
    check_size(1, 1);
    const auto paths = plan_graph({&volume, options_.root, &rules, endpoints, rules.shell, hash_of(stream, kFirstGraph)}, rules_, run_);
    if (!paths) return false;
    if (paths->nodes < 2) throw InputError({}, "volume: no room for a node beside the root", "a volume that is not all obstacle, or a smaller d");
    if (!is_near(volume, options_.root)) throw InputError({}, "root: a place outside of the volume", "one in it or on its surface");
    if (paths->endpoints_missing > 0)
      throw InputError({}, "level 1: b = " + std::to_string(endpoints) + " endpoints, but " + std::to_string(paths->endpoints.size()) + " nodes where one may be",
                       "fewer endpoints, more nodes (k), or a thicker shell (d_e)");
    tree_.positions = {options_.root};
    tree_.parents = {0};
    tree_.tips.emplace_back();
    report_.levels.emplace_back();
    Subgraph graph{.around = {0, options_.root, initial_lifespan_, stream}, .decrement = LifespanDecrement{0, false}, .stream = stream};
    join(graph, *paths);
    return true;
  }

  /// Half the mean way, as the crow flies, from the root to an endpoint.
  double size_of_first_level() const {
    double sum = 0;
    for (const GrowthTip& tip : tree_.tips.front()) sum += glm::length(tree_.positions[tip.node] - options_.root);
    return 0.5 * sum / static_cast<double>(tree_.tips.front().size());
  }

  std::vector<Subgraph> subgraphs_of(std::size_t level, double radius) const {
    const GraphLevel& rules = level_rules(level);
    std::vector<Subgraph> subgraphs;
    for (std::size_t before = rules.around_all ? 1 : level - 1; before < level; ++before)
      for (const GrowthTip& tip : tree_.tips[before - 1])
        if (tip.lifespan > 0) subgraphs.push_back(subgraph_around(tip, level, radius));
    if (options_.light) deal_light(level, subgraphs);
    return subgraphs;
  }

  Subgraph subgraph_around(const GrowthTip& tip, std::size_t level, double radius) const {
    const GraphLevel& rules = level_rules(level);
    Subgraph subgraph{.around = tip, .stream = hash_of(tip.stream, level)};
    subgraph.direction = subgraph_direction(rules, tree_.positions[tip.node], tip.from, options_.wind, hash_of(subgraph.stream, kDirection));
    subgraph.radius = radius * (options_.lifespan.sizes && initial_lifespan_ > 0 ? tip.lifespan / initial_lifespan_ : 1.0);
    StreamDraws count(hash_of(subgraph.stream, kCount));
    subgraph.endpoints = draw_count(rules, count);
    return subgraph;
  }

  static int draw_count(const GraphLevel& rules, StreamDraws& draws) {
    return rules.endpoints[0] + static_cast<int>(draws.below(static_cast<std::uint64_t>(rules.endpoints[1] - rules.endpoints[0]) + 1));
  }

  /// Section 3.4: as many draws as there are subgraphs, dealt out from the one that looks most into the light.
  void deal_light(std::size_t level, std::vector<Subgraph>& subgraphs) const {
    std::vector<Vec3> directions;
    for (const Subgraph& subgraph : subgraphs) directions.push_back(subgraph.direction);
    const auto ranked = ranked_by_light(directions, options_.light->direction);
    if (options_.light->on_endpoints) {
      StreamDraws draws(hash_of(level_stream(level), kDealtCounts));
      std::vector<int> counts;
      for (std::size_t i = 0; i < ranked.size(); ++i) counts.push_back(draw_count(level_rules(level), draws));
      std::sort(counts.begin(), counts.end(), std::greater<>());
      for (std::size_t i = 0; i < ranked.size(); ++i) subgraphs[ranked[i]].endpoints = counts[i];
    }
    if (options_.light->on_lifespan) {
      StreamDraws draws(hash_of(level_stream(level), kDealtDecrements));
      std::vector<LifespanDecrement> decrements;
      for (std::size_t i = 0; i < ranked.size(); ++i) decrements.push_back(draw_decrement(options_.lifespan.outcomes, draws));
      std::stable_sort(decrements.begin(), decrements.end(), [&](const LifespanDecrement& a, const LifespanDecrement& b) {
        return a.left(initial_lifespan_) > b.left(initial_lifespan_);
      });
      for (std::size_t i = 0; i < ranked.size(); ++i) subgraphs[ranked[i]].decrement = decrements[i];
    }
  }

  void check_size(std::size_t level, std::size_t graphs) const { check_level_size(level, static_cast<double>(graphs), level_rules(level).nodes); }

  /// Plans the level's graphs side by side and joins them in their order, so many at a time that what waits stays small.
  bool grow_level(std::size_t level, const std::vector<Subgraph>& subgraphs) {
    constexpr std::size_t kAtOnce = 4096;
    tree_.tips.emplace_back();
    report_.levels.emplace_back();
    ProgressMeter progress(run_, "level " + std::to_string(level));
    for (std::size_t begin = 0; begin < subgraphs.size(); begin += kAtOnce) {
      const std::size_t count = std::min(kAtOnce, subgraphs.size() - begin);
      std::vector<std::optional<GraphPaths>> planned(count);
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        if (run_.cancelled()) return;
        planned[i] = plan_subgraph(level, subgraphs[begin + i]);
        progress.add(1.0 / static_cast<double>(subgraphs.size()));
      });
      for (std::size_t i = 0; i < count; ++i) {
        if (!planned[i]) return false;
        join(subgraphs[begin + i], *planned[i]);
      }
    }
    progress.finish();
    return true;
  }

  std::optional<GraphPaths> plan_subgraph(std::size_t level, const Subgraph& subgraph) const {
    const GraphLevel& rules = level_rules(level);
    const Vec3 root = tree_.positions[subgraph.around.node];
    const GraphVolume volume = subgraph_volume(rules, root, subgraph.direction, subgraph.radius, options_.obstacles);
    RunOptions quiet = run_;
    quiet.progress = nullptr;
    return plan_graph({&volume, root, &rules, subgraph.endpoints, rules.shell * subgraph.radius, hash_of(subgraph.stream, kGraph)}, rules_, quiet);
  }

  /// Takes a planned graph into the tree, with the endpoints that it gives the last level.
  void join(const Subgraph& subgraph, const GraphPaths& paths) {
    const Vec3 root = tree_.positions[subgraph.around.node];
    const std::vector<std::uint32_t> endpoints = tree_.join(paths, subgraph.around.node);
    for (std::size_t i = 0; i < endpoints.size(); ++i) {
      const std::uint64_t stream = hash_of(subgraph.stream, kGraph, i);
      StreamDraws draws(hash_of(stream, kDecrement));
      const LifespanDecrement decrement = subgraph.decrement ? *subgraph.decrement : draw_decrement(options_.lifespan.outcomes, draws);
      tree_.tips.back().push_back({endpoints[i], root, decrement.left(subgraph.around.lifespan), stream});
    }
    GraphReport::Level& level = report_.levels.back();
    ++level.graphs;
    level.nodes += paths.nodes, report_.nodes += paths.nodes;
    level.edges += paths.edges, report_.edges += paths.edges;
    level.endpoints += endpoints.size(), report_.endpoints += endpoints.size();
    report_.repaired += paths.repaired;
    report_.short_of_endpoints += paths.endpoints_missing > 0;
    report_.short_of_nodes += paths.nodes < level_rules(report_.levels.size()).nodes && !level_rules(report_.levels.size()).spacing;
  }

  void note_shortcomings() {
    const auto note = [&](std::size_t count, const char* text) {
      if (count > 0) report_.notes.push_back(std::to_string(count) + text);
    };
    note(report_.repaired, " edges were added to graphs that were not connected.");
    note(report_.short_of_nodes, " graphs had room for fewer nodes than wanted (k).");
    note(report_.short_of_endpoints, " graphs had room for fewer endpoints than wanted (b).");
  }

  const GraphOptions& options_;
  const RunOptions& run_;
  GraphRules rules_;
  double initial_lifespan_;
  GrowingTree tree_;
  GraphReport report_;
};

/// Puts the roots at the end of the tree. They share its first node, and leave it as laterals so that the trunk keeps its axis.
void append_roots(GraphPlan& tree, GraphPlan&& roots) {
  const auto offset = static_cast<std::int32_t>(tree.skeleton.nodes.size()) - 1;
  for (std::size_t i = 1; i < roots.skeleton.nodes.size(); ++i) {
    SkeletonNode node = roots.skeleton.nodes[i];
    if (node.parent == 0)
      node.lateral = true;
    else
      node.parent += offset;
    tree.skeleton.nodes.push_back(node);
  }
  tree.below_ground = roots.skeleton.nodes.size() - 1;
  for (const std::uint32_t endpoint : roots.endpoints) tree.endpoints.push_back(endpoint + static_cast<std::uint32_t>(offset));
  tree.endpoint_levels.insert(tree.endpoint_levels.end(), roots.endpoint_levels.begin(), roots.endpoint_levels.end());
  tree.report.nodes += roots.report.nodes;
  tree.report.edges += roots.report.edges;
  tree.report.endpoints += roots.report.endpoints;
  tree.report.repaired += roots.report.repaired;
  for (std::string& note : roots.report.notes) tree.report.notes.push_back("Roots: " + note);
}

std::optional<GraphPlan> planned(const GraphOptions& options, const RunOptions& run) {
  Planner planner(options, run);
  if (!planner.grow()) return std::nullopt;
  GraphPlan plan = planner.finish();
  if (options.roots.empty() || !options.with_roots) return plan;
  GraphOptions below = options.roots.front();
  below.root = options.root;
  auto roots = naming("roots", [&] { return planned(below, run); });
  if (!roots) return std::nullopt;
  append_roots(plan, std::move(*roots));
  return plan;
}

}  // namespace

std::optional<GraphPlan> plan_tree(const GraphOptions& options, const RunOptions& run) {
  check_plan(options);
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return planned(options, run); });
}

}  // namespace cambium
