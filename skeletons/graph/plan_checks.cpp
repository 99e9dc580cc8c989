#include "skeletons/graph/plan_checks.h"

#include "skeletons/graph/lifespan.h"
#include "skeletons/graph/subgraph.h"
#include "skeletons/number_checks.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kMostNodes = 100'000'000;   // of one graph: some 15 GB
constexpr int kMostEndpoints = 10'000'000;

void require(bool holds, const std::string& found, const std::string& expected) {
  if (!holds) throw InputError({}, found, expected);
}

bool is_direction(const Vec3& v) { return glm::length(v) > 0 && std::isfinite(glm::length(v)); }

void check_graph(const GraphLevel& level) {
  require(level.nodes >= 1 && level.nodes <= kMostNodes, "k = " + std::to_string(level.nodes), "a k of 1 to 10^8 nodes");
  if (level.spacing) require_positive(*level.spacing, "d");
  require(level.alpha > 0 && level.alpha <= std::numbers::pi * (1 + 1e-12), numbered("alpha", level.alpha), "an alpha above 0, pi at most");
  if (level.radius) require_positive(*level.radius, "r");
  require_positive(level.shrink, "a");
  require(std::isfinite(level.turn.angle), "a turn that is not finite", "a turn by a finite angle");
  if (level.turn.axis) require(is_direction(*level.turn.axis), "a turn about an axis of length 0", "an axis that is not 0");
  if (!level.shape.empty()) subgraph_volume(level, Vec3{0.0}, Vec3{0, 0, 1}, 1.0, nullptr);
}

void check_endpoints(const GraphLevel& level, bool first) {
  const auto [least, most] = level.endpoints;
  require(0 <= least && least <= most && most <= kMostEndpoints, "b = [" + std::to_string(least) + ", " + std::to_string(most) + "]",
          "a b of 0 to 10^7, the least first");
  require(first || level.given_endpoints.empty(), "endpoints given by hand (at)", "them at level 1 only");
  for (const Vec3& p : level.given_endpoints) require(std::isfinite(glm::dot(p, p)), "an endpoint that is not finite (at)", "finite places");
  const std::size_t wanted = static_cast<std::size_t>(most) + level.given_endpoints.size();
  require(wanted < level.nodes || wanted == 0, "b = " + std::to_string(wanted) + " endpoints", "fewer than k = " + std::to_string(level.nodes) + " nodes, of which the root is one");
  if (level.placement != EndpointPlacement::kUniform) require_positive(level.shell, "d_e");
  require_positive(level.zeta, "zeta");
}

void check_volume(const std::vector<PlacedSolid>& volume) {
  require(!volume.empty(), "no volume", "at least one");
  for (std::size_t i = 0; i < volume.size(); ++i) naming("volume " + std::to_string(i + 1), [&] { GraphVolume({volume[i]}); });
}

void check_thickness(const GraphThickness& thickness) {
  require_positive(thickness.trunk_radius, "trunk_radius");
  require_positive(thickness.tip_radius, "tip_radius");
  require(thickness.tip_radius <= thickness.trunk_radius, numbered("tip_radius", thickness.tip_radius),
          "at most trunk_radius = " + std::to_string(thickness.trunk_radius));
  if (thickness.exponent) require_positive(*thickness.exponent, "exponent");
  if (thickness.unit) require_positive(*thickness.unit, "unit");
}

void check_weights(const GraphOptions& options) {
  const bool legal = options.weight_low >= 0 && options.weight_low <= options.weight_high && options.weight_high > 0 && std::isfinite(options.weight_high);
  require(legal, "weights: low = " + std::to_string(options.weight_low) + ", high = " + std::to_string(options.weight_high),
          "0 <= low <= high, and high above 0");
}

void check_surroundings(const GraphOptions& options) {
  if (options.light) require(is_direction(options.light->direction), "light: a direction of length 0", "a direction that is not 0");
  if (!options.wind) return;
  require(is_direction(options.wind->direction), "wind: a direction of length 0", "a direction that is not 0");
  require(options.wind->strength >= 0 && std::isfinite(options.wind->strength), numbered("wind: strength", options.wind->strength),
          "a strength of 0 or more");
}

void check_edges(const EdgeOptions& edges) {
  if (edges.rule == EdgeRule::kYao)
    require(edges.sectors >= 4 && edges.sectors <= 64, "edges: sectors = " + std::to_string(edges.sectors), "4 to 64 sectors");
  else
    require(edges.threshold > 1 && edges.threshold <= 10, numbered("edges: threshold", edges.threshold), "a threshold above 1, 10 at most");
}

void check_roots(const GraphOptions& options) {
  require(options.roots.size() <= 1, "more than one system of roots", "one at most");
  for (const GraphOptions& roots : options.roots) {
    require(roots.roots.empty(), "roots: roots of their own", "none");
    naming("roots", [&] { check_plan(roots); });
  }
}

/// Refused before the levels before it are grown: a level that will be too large if every graph has the fewest endpoints it may.
void check_growth(const GraphOptions& options) {
  const bool all_live = options.lifespan.outcomes.size() == 1 && options.lifespan.outcomes[0].high <= 1 && !options.lifespan.outcomes[0].relative;
  if (options.obstacles || !all_live) return;   // some graphs may have none
  double tips = 1, all_tips = 0;
  const double last = options.lifespan.initial ? std::ceil(*options.lifespan.initial) + 1 : static_cast<double>(options.levels.size());
  for (std::size_t level = 1; static_cast<double>(level) <= last; ++level) {
    const GraphLevel& rules = options.levels[std::min(level, options.levels.size()) - 1];
    const double graphs = level > 1 && rules.around_all ? all_tips : tips;
    check_level_size(level, graphs, rules.nodes);
    if (rules.endpoints[0] <= 1 && level >= options.levels.size()) return;   // it does not grow any more
    tips = graphs * rules.endpoints[0] + (level == 1 ? static_cast<double>(rules.given_endpoints.size()) : 0.0);
    all_tips += tips;
  }
}

}  // namespace

void check_level_size(std::size_t level, double graphs, std::size_t nodes) {
  constexpr double kMostNodesOfLevel = 2e8;
  if (graphs * static_cast<double>(nodes) <= kMostNodesOfLevel) return;
  const std::string count = std::to_string(static_cast<std::uint64_t>(std::min(graphs, 1e18)));
  throw InputError({}, "level " + std::to_string(level) + ": " + count + " graphs of k = " + std::to_string(nodes) + " nodes",
                   "at most 2*10^8 nodes in a level: fewer nodes (k), or fewer endpoints (b) in the levels before");
}

void check_plan(const GraphOptions& options) {
  require(std::isfinite(glm::dot(options.root, options.root)), "root: a place that is not finite", "a finite one");
  check_volume(options.volume);
  require(!options.levels.empty(), "no level", "at least one");
  for (std::size_t i = 0; i < options.levels.size(); ++i)
    naming("level " + std::to_string(i + 1), [&] {
      check_graph(options.levels[i]);
      check_endpoints(options.levels[i], i == 0);
    });
  const GraphLevel& first = options.levels.front();
  require(first.endpoints[0] + first.given_endpoints.size() + (first.placement == EndpointPlacement::kTaproot) > 0,
          "level 1: b = 0 endpoints", "at least one, drawn or given");
  check_edges(options.edges);
  check_weights(options);
  validate_lifespan(options.lifespan);
  check_surroundings(options);
  naming("thickness", [&] { check_thickness(options.thickness); });
  require(options.smoothing >= 0 && options.smoothing <= 10'000, "smoothing = " + std::to_string(options.smoothing), "0 to 10000 passes");
  check_roots(options);
  check_growth(options);
}

}  // namespace cambium
