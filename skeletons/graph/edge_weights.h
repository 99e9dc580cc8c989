// What an edge of the graph costs (Xu and Mould 2012, section 3.1; painting is the paper's future work).
#pragma once

#include "blobtree/geometry.h"
#include "blobtree/place_hash.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace cambium {

/// A soft ball: edges in its middle cost `factor` times as much, at its rim and beyond what they did.
struct WeightBall {
  Vec3 center{0.0};
  double radius = 1;                 ///< metres, > 0
  double factor = 1;                 ///< > 0; below 1 it draws branches, above 1 it turns them away
};

/// Scales edges by where they are. Used by threads at once.
class WeightPaint {
 public:
  WeightPaint() = default;
  /// grid: a factor by place, > 0, for example read from a volume; null: 1 everywhere.
  WeightPaint(std::vector<WeightBall> balls, std::function<double(const Vec3&)> grid);

  bool empty() const { return balls_.empty() && !grid_; }
  double factor(const Vec3& p) const;

 private:
  std::vector<WeightBall> balls_;
  std::function<double(const Vec3&)> grid_;
};

struct EdgeWeights {
  double low = 0.0, high = 1.0;      ///< weights are drawn evenly between; 0 <= low <= high, high > 0
  bool times_length = false;         ///< multiplied by the edge's length, metres
  const WeightPaint* paint = nullptr;

  /// Of the edge between nodes u and v of the graph that `seed` tells from others; the same both ways.
  float of(std::uint64_t seed, std::uint32_t u, std::uint32_t v, const Vec3& pu, const Vec3& pv) const {
    const std::uint64_t bits = hash_of(seed, std::min(u, v), std::max(u, v));
    double weight = low + (high - low) * (1.0 - unit_of(bits));   // never 0
    if (times_length) weight *= glm::length(pv - pu);
    if (paint && !paint->empty()) weight *= paint->factor(0.5 * (pu + pv));
    return static_cast<float>(weight);
  }
};

}  // namespace cambium
