#include "skeletons/graph/endpoints.h"

#include "blobtree/place_hash.h"

#include <algorithm>

namespace cambium {
namespace {

/// Takes `count` of the nodes at random, in the order drawn, and leaves the others.
std::vector<std::uint32_t> draw_some(std::vector<std::uint32_t>& nodes, std::size_t count, StreamDraws& draws) {
  count = std::min(count, nodes.size());
  for (std::size_t i = 0; i < count; ++i) std::swap(nodes[i], nodes[i + draws.below(nodes.size() - i)]);
  const auto end = nodes.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<std::uint32_t> drawn(nodes.begin(), end);
  nodes.erase(nodes.begin(), end);
  return drawn;
}

/// Nodes that may be drawn, by subvolume; subvolumes without any are left out.
std::vector<std::vector<std::uint32_t>> choose_from(const GraphVolume& volume, std::span<const Vec3> positions,
                                                    const EndpointChoice& choice) {
  std::vector<std::vector<std::uint32_t>> by_part(volume.parts());
  for (std::size_t i = choice.taken; i < positions.size(); ++i) {
    if (!volume.bears_endpoints(positions[i])) continue;
    if (choice.shell > 0 && volume.depth(positions[i]) > choice.shell) continue;
    by_part[choice.parts.empty() ? 0 : choice.parts[i]].push_back(static_cast<std::uint32_t>(i));
  }
  std::erase_if(by_part, [](const auto& nodes) { return nodes.empty(); });
  return by_part;
}

}  // namespace

std::vector<std::uint32_t> draw_endpoints(const GraphVolume& volume, std::span<const Vec3> positions, const EndpointChoice& choice,
                                          std::size_t count, std::uint64_t stream) {
  auto by_part = choose_from(volume, positions, choice);
  StreamDraws draws(stream);
  std::vector<std::uint32_t> endpoints;
  while (endpoints.size() < count && !by_part.empty()) {
    const std::size_t wanted = count - endpoints.size(), parts = by_part.size();
    for (std::size_t k = 0; k < parts; ++k) {
      const auto drawn = draw_some(by_part[k], wanted / parts + (k < wanted % parts), draws);
      endpoints.insert(endpoints.end(), drawn.begin(), drawn.end());
    }
    std::erase_if(by_part, [](const auto& nodes) { return nodes.empty(); });
  }
  return endpoints;
}

std::vector<std::uint32_t> draw_endpoints_around(std::span<const Vec3> positions, std::span<const std::uint32_t> path, double reach,
                                                 std::size_t count, std::uint64_t stream) {
  std::vector<bool> on_path(positions.size(), false);
  for (const std::uint32_t node : path) on_path[node] = true;
  const auto is_near = [&](const Vec3& p) {
    return std::any_of(path.begin(), path.end(), [&](std::uint32_t node) {
      const Vec3 d = positions[node] - p;
      return glm::dot(d, d) <= reach * reach;
    });
  };
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t i = 1; i < positions.size(); ++i)
    if (!on_path[i] && is_near(positions[i])) nodes.push_back(i);
  StreamDraws draws(stream);
  return draw_some(nodes, count, draws);
}

}  // namespace cambium
