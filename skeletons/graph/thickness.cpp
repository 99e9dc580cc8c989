#include "skeletons/graph/thickness.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace cambium {
namespace {

constexpr double kNoWay = -1;

/// s: of each node the longest way on to one of the endpoints marked; kNoWay where none is beyond.
std::vector<double> ways_onward(const PathNodes& nodes, std::span<const std::uint32_t> endpoints) {
  std::vector<double> way(nodes.positions.size(), kNoWay);
  for (const std::uint32_t endpoint : endpoints) way[endpoint] = 0;
  for (std::size_t i = way.size(); i-- > 1;) {
    if (way[i] == kNoWay) continue;
    const std::uint32_t parent = nodes.parents[i];
    way[parent] = std::max(way[parent], way[i] + glm::length(nodes.positions[i] - nodes.positions[parent]));
  }
  return way;
}

/// The endpoints that count, by the zeta that they count with.
std::map<double, std::vector<std::uint32_t>> endpoints_by_zeta(const PathNodes& nodes, bool every_level, std::span<const double> zetas) {
  std::uint8_t last = 0;
  for (const std::uint8_t level : nodes.endpoint_levels) last = std::max(last, level);
  std::map<double, std::vector<std::uint32_t>> by_zeta;
  for (std::size_t i = 0; i < nodes.endpoints.size(); ++i) {
    const std::size_t level = nodes.endpoint_levels[i];
    if (every_level || level == last) by_zeta[zetas[std::min(level, zetas.size()) - 1]].push_back(nodes.endpoints[i]);
  }
  return by_zeta;
}

/// w = s^zeta, the largest over levels; in no particular unit.
PathRadii path_thickness(const PathNodes& nodes, const GraphThickness& thickness, std::span<const double> zetas) {
  const double unit = thickness.unit.value_or(0.001 * std::max(0.0, ways_onward(nodes, nodes.endpoints)[0]));
  PathRadii w{std::vector(nodes.positions.size(), 0.0), std::vector(nodes.positions.size(), 0.0)};
  if (!(unit > 0)) return w;
  for (const auto& [zeta, endpoints] : endpoints_by_zeta(nodes, thickness.every_level, zetas)) {
    const std::vector<double> way = ways_onward(nodes, endpoints);
    for (std::size_t i = 1; i < way.size(); ++i) {
      if (way[i] == kNoWay) continue;
      const std::uint32_t parent = nodes.parents[i];
      const double edge = glm::length(nodes.positions[i] - nodes.positions[parent]);
      w.base[i] = std::max(w.base[i], std::pow((way[i] + edge) / unit, zeta));
      w.tip[parent] = std::max(w.tip[parent], w.base[i]);
    }
  }
  return w;
}

/// Ends of paths that are beyond each node.
std::vector<double> tips_beyond(const PathNodes& nodes) {
  std::vector<double> tips(nodes.positions.size(), 0.0);
  for (std::size_t i = tips.size(); i-- > 0;) {
    if (tips[i] == 0) tips[i] = 1;
    if (i > 0) tips[nodes.parents[i]] += tips[i];
  }
  return tips;
}

/// Every tip alike: r = tips^(1/e), in tips' radii; an edge is as thick all along.
PathRadii pipe_thickness(const PathNodes& nodes, const GraphThickness& thickness) {
  std::vector<double> w = tips_beyond(nodes);
  const double ratio = std::log(thickness.trunk_radius / thickness.tip_radius);
  const double inverse = thickness.exponent ? 1 / *thickness.exponent : w[0] > 1 ? ratio / std::log(w[0]) : 0.0;
  for (double& r : w) r = std::pow(r, inverse);
  return {w, w};
}

}  // namespace

PathRadii path_radii(const PathNodes& nodes, const GraphThickness& thickness, std::span<const double> zetas) {
  PathRadii radii = thickness.rule == ThicknessRule::kPipe ? pipe_thickness(nodes, thickness) : path_thickness(nodes, thickness, zetas);
  const double scale = radii.tip[0] > 0 ? thickness.trunk_radius / radii.tip[0] : 0.0;
  for (std::vector<double>* ends : {&radii.tip, &radii.base})
    for (double& radius : *ends) radius = std::max(scale * radius, thickness.tip_radius);
  return radii;
}

}  // namespace cambium
