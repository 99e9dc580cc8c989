#include "skeletons/graph/edge_weights.h"

#include "blobtree/input_error.h"
#include "skeletons/number_checks.h"

#include <cmath>
#include <string>
#include <utility>

namespace cambium {
namespace {

/// 1 in the middle, 0 from the rim on, smooth at both; t: the distance from the middle in radii.
double softness(double t) {
  const double rest = 1 - t * t;
  return t < 1 ? rest * rest : 0.0;
}

}  // namespace

WeightPaint::WeightPaint(std::vector<WeightBall> balls, std::function<double(const Vec3&)> grid)
    : balls_(std::move(balls)), grid_(std::move(grid)) {
  for (const WeightBall& ball : balls_) {
    require_positive(ball.radius, "radius");
    require_positive(ball.factor, "factor");
    if (!std::isfinite(glm::dot(ball.center, ball.center))) throw InputError({}, "a center that is not finite", "a finite center");
  }
}

double WeightPaint::factor(const Vec3& p) const {
  double factor = grid_ ? grid_(p) : 1.0;
  // By powers: a factor of 2 and one of 1/2 at the same place make 1 all the way to the rim.
  for (const WeightBall& ball : balls_)
    if (const double t = glm::length(p - ball.center) / ball.radius; t < 1) factor *= std::pow(ball.factor, softness(t));
  return factor;
}

}  // namespace cambium
