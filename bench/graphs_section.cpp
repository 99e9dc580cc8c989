// Graphs of path-planned trees from ten thousand nodes to ten million, the paper's largest trees, and the straightforward way beside them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bench/clock.h"
#include "bench/graph_yardstick.h"
#include "bench/process_figures.h"
#include "bench/sections.h"
#include "skeletons/graph/least_cost.h"
#include "skeletons/graph/plan.h"
#include "skeletons/graph/poisson_disc.h"
#include "skeletons/skeleton_io.h"

namespace cambium::bench {
namespace {

constexpr int kRounds = 3;   // the best of each counts
constexpr double kSlope = 1.1, kBytesPerNode = 150;   // the issue's
constexpr std::size_t kQuickNodes = 100'000, kMostNodes = 10'000'000;

GraphVolume ball() { return GraphVolume({PlacedSolid{.solid = BallSolid{1}}}); }

/// A subgraph's volume at the default alpha.
GraphVolume cone() { return GraphVolume({PlacedSolid{.solid = BallSolid{1, 0.3 * std::numbers::pi}, .axis = {1, 2, 3}}}); }

struct GraphRun {
  GraphSeconds seconds;
  double spacing = 0;
};

GraphRun run_graph(const GraphVolume& volume, std::size_t count, std::uint64_t seed, int threads) {
  RunOptions run;
  run.threads = threads;
  const Vec3 root{0.0};
  GraphRun result;
  const auto nodes = timed(result.seconds.nodes, [&] {
    return *poisson_disc(volume, {&root, 1}, {.count = count, .seed = seed}, run);
  });
  const auto graph = timed(result.seconds.edges, [&] { return *join_nodes(nodes.positions, nodes.spacing, {}, nullptr, {}, run); });
  timed(result.seconds.paths, [&] { return *least_cost_paths(nodes.positions, graph, {}, seed, run); });
  result.spacing = nodes.spacing;
  return result;
}

/// The least-squares slope of log seconds over log nodes.
double log_slope(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(points.size());
  for (const auto& [nodes, seconds] : points) {
    const double a = std::log(nodes), b = std::log(seconds);
    x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void add_sizes(Report& report, std::size_t largest) {
  std::vector<std::pair<double, double>> points;
  for (std::size_t count = 10'000; count <= largest; count *= 10) {
    reset_peak_resident_bytes();
    const auto before = static_cast<double>(resident_bytes());
    GraphSeconds best{kInfinity, 0, 0};
    for (int round = 0; round < (count < kMostNodes ? kRounds : 1); ++round) {
      const GraphSeconds seconds = run_graph(ball(), count, static_cast<std::uint64_t>(round), 0).seconds;
      if (seconds.all() < best.all()) best = seconds;
    }
    const double nodes = static_cast<double>(count), bytes = static_cast<double>(peak_resident_bytes()) - before;
    points.push_back({nodes, best.all()});
    report.add({.what = fmt::format("one graph of {} nodes", count), .figure = best.all() / nodes * 1e9, .unit = "ns/node"});
    report.note(fmt::format("  {:.3f} s: nodes {:.3f}, edges {:.3f}, paths {:.3f}", best.all(), best.nodes, best.edges, best.paths));
    if (count == largest)
      report.add({.what = "  most memory", .figure = bytes / nodes, .unit = "B/node", .target = at_most(kBytesPerNode)});
  }
  report.add({.what = "  log-log slope of time over nodes", .figure = log_slope(points), .unit = "", .target = at_most(kSlope)});
}

/// Trees of table 1: as many nodes and endpoints as the paper's.
struct PaperTree {
  const char* what;
  std::vector<std::pair<std::size_t, int>> levels;   ///< (nodes of each graph, endpoints)
  std::size_t nodes, endpoints;
  double seconds, written;                           ///< the issue's; written: 0: not asked
  double paper_seconds;
};

const PaperTree kPaperTrees[] = {
    {"figure 20", {{9810, 20}, {300, 8}, {300, 6}, {300, 35}}, 351'810, 34'740, 1.0, 1.5, 32.4},
    {"the next largest", {{18'755, 12}, {500, 10}, {500, 30}}, 84'755, 3732, 0.25, 0, 4.5},
};

GraphOptions options_of(const PaperTree& tree) {
  GraphOptions options;
  options.volume = {PlacedSolid{.solid = BallSolid{5}, .origin = {0, 0, 6}}};
  options.root = {0, 0, 1.1};
  for (const auto& [nodes, endpoints] : tree.levels) {
    GraphLevel level;
    level.nodes = nodes;
    level.endpoints = {endpoints, endpoints};
    options.levels.push_back(level);
  }
  return options;
}

/// Seconds of the same graphs in the straightforward way, at the spacings that ours come to.
GraphSeconds straightforward_tree(const PaperTree& tree) {
  GraphSeconds sum;
  std::size_t graphs = 1;
  for (std::size_t i = 0; i < tree.levels.size(); ++i) {
    const std::size_t nodes = tree.levels[i].first;
    const GraphVolume volume = i == 0 ? ball() : cone();
    const double spacing = run_graph(volume, nodes, 1, 1).spacing;
    for (std::size_t g = 0; g < graphs; ++g) {
      const GraphSeconds seconds = straightforward_graph(volume, nodes, spacing, g);
      sum.nodes += seconds.nodes, sum.edges += seconds.edges, sum.paths += seconds.paths;
    }
    graphs *= static_cast<std::size_t>(tree.levels[i].second);
  }
  return sum;
}

void add_tree(Report& report, const PaperTree& tree) {
  const GraphOptions options = options_of(tree);
  double best = kInfinity;
  std::optional<GraphPlan> plan;
  for (int round = 0; round < kRounds; ++round) {
    double seconds = 0;
    plan = timed(seconds, [&] { return plan_tree(options); });
    best = std::min(best, seconds);
  }
  double text_seconds = 0;
  const std::size_t text_size = timed(text_seconds, [&] { return skeleton_text(plan->skeleton, "skel.json").size(); });
  const GraphSeconds straight = straightforward_tree(tree);
  report.add({.what = fmt::format("{}: {} nodes, {} endpoints", tree.what, plan->report.nodes, plan->report.endpoints),
              .figure = best,
              .unit = "s",
              .target = at_most(tree.seconds)});
  if (plan->report.nodes != tree.nodes || plan->report.endpoints != tree.endpoints)
    report.note(fmt::format("  THE PAPER'S HAS {} NODES AND {} ENDPOINTS", tree.nodes, tree.endpoints));
  Row written{.what = fmt::format("  and its skeleton of {} nodes as {:.0f} MB of text", plan->skeleton.nodes.size(), 1e-6 * static_cast<double>(text_size)),
              .figure = best + text_seconds,
              .unit = "s"};
  if (tree.written > 0) written.target = at_most(tree.written);
  report.add(written);
  report.add({.what = "  its graphs in the straightforward way", .figure = straight.all(), .unit = "s", .ratio = straight.all() / best, .ratio_to = "ours"});
  report.note(fmt::format("  nodes {:.2f}, edges {:.2f}, paths {:.2f}; the paper's took {} s", straight.nodes, straight.edges, straight.paths, tree.paper_seconds));
}

}  // namespace

void graphs_section(Report& report, const Pace& pace) {
  const bool quick = pace.largest_tree < Pace{}.largest_tree;
  report.heading("Path-planned trees: nodes strewn, joined by eight sectors, and all paths to the root; all cores, by the wall clock");
  add_sizes(report, quick ? kQuickNodes : kMostNodes);
  for (const PaperTree& tree : kPaperTrees) add_tree(report, tree);
}

}  // namespace cambium::bench
