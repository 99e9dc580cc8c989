// The organs that the turtle meets, each as a shape that it may share with others and a place.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "blobtree/run_options.h"
#include "lsystem/patch_surface.h"
#include "skeletons/foliage.h"

namespace cambium {

class FoliageCollector {
 public:
  using Surfaces = std::map<std::string, PatchSurface>;

  /// `surfaces`: those whose shapes are known; outlives the collector.
  explicit FoliageCollector(const Surfaces& surfaces) : surfaces_(surfaces) {}

  /// Where an organ is: all of a placement but its shape and scale.
  using Site = OrganPlacement;
  enum class Outcome { kAdded, kNothing, kCancelled };

  /// The inside of a closed outline, corners in the site's coordinates, metres. Outlines that are multiples of each other
  /// share a shape: 10^5 leaves may be one shape and 10^5 places. kNothing: an outline without an area.
  Outcome add_outline(const Site& site, const std::vector<Vec3>& corners, const RunOptions& run);
  /// A named surface, stretched along left, heading and up. Where only the name is known, it has no triangles and is scaled
  /// by the largest of the three. kNothing: stretched by 0.
  Outcome add_surface(const Site& site, const std::string& name, const Vec3& stretch);
  Outcome add_sphere(const Site& site, double diameter);
  Outcome add_disc(const Site& site, double diameter);  ///< in the plane of heading and left

  Foliage take() && { return std::move(foliage_); }

 private:
  /// What a shape is found by: a name, and rounded numbers.
  struct Key {
    std::string name;
    std::vector<std::int32_t> numbers;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  std::uint32_t numbered(OrganShape shape);
  Outcome add_round(const Site& site, OrganShape (*make)(), const char* name, double diameter);
  Outcome place(const Site& site, std::uint32_t shape, double scale);

  const Surfaces& surfaces_;
  Foliage foliage_;
  std::unordered_map<Key, std::uint32_t, KeyHash> shapes_;  // kNoShape: of outlines without an area
  std::uint32_t outlines_ = 0;
};

}  // namespace cambium
