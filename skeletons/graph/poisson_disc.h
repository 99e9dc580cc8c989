// Nodes strewn at random in a volume, none nearer to another than a given distance.
#pragma once

#include "blobtree/run_options.h"
#include "skeletons/graph/graph_volume.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

struct PoissonDiscOptions {
  /// Nodes wanted, those given included; unset: as many as fit. Fewer come out where no more fit at `spacing`; where more would, they
  /// are drawn from as many as fit, or from eight times as many.
  std::optional<std::size_t> count{};
  /// The least distance between any two nodes, metres; unset: chosen so that `count` nodes fill the volume. One of the two is set.
  std::optional<double> spacing{};
  std::uint64_t seed = 0;
};

struct PoissonDiscNodes {
  std::vector<Vec3> positions;       ///< the given ones first, then the others in an order that keeps neighbours near each other
  double spacing = 0;                ///< that holds between all pairs but those of two given ones
};

/// `given`: nodes that are there in any case, in the volume or not.
/// Darts are thrown at cells of space: where a count chooses the spacing, four at each, so that a place is mostly within one and a half
/// spacings of a node; where the spacing is given, also at the parts of cells that are still free, until every place is within 1.25
/// spacings of a node, but for slivers along the volume's surface.
/// The same at any thread count. nullopt if cancelled. Cost: linear in the nodes, one to four microseconds each, and, for a volume that
/// fills little of its bounds, in the bounds' size in cells of `spacing`.
/// A volume without room for any more gives the given nodes alone.
/// Errors: InputError (no location) where the nodes would be more than 2^31.
std::optional<PoissonDiscNodes> poisson_disc(const GraphVolume& volume, std::span<const Vec3> given, const PoissonDiscOptions& options,
                                             const RunOptions& run);

}  // namespace cambium
