#include "skeletons/graph/solids.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/closed_mesh.h"
#include "skeletons/graph/prepared_solid.h"
#include "skeletons/graph/revolution.h"
#include "skeletons/number_checks.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

template <class... Cases>
struct Match : Cases... { using Cases::operator()...; };
template <class... Cases>
Match(Cases...) -> Match<Cases...>;

}  // namespace

Box bounds(const Solid& solid) {
  return std::visit(Match{
    [](const BallSolid& s) {
      const double side = s.angle >= 0.5 * kPi ? s.radius : s.radius * std::sin(s.angle);
      const double low = s.angle >= 0.5 * kPi ? s.radius * std::cos(s.angle) : 0.0;
      return Box{{-side, -side, low}, {side, side, s.radius}};
    },
    [](const EllipsoidSolid& s) { return Box{-s.half_size, s.half_size}; },
    [](const CylinderSolid& s) { return Box{{-s.radius, -s.radius, 0}, {s.radius, s.radius, s.height}}; },
    [](const ConeSolid& s) {
      const double side = std::max(s.radius_base, s.radius_tip);
      return Box{{-side, -side, 0}, {side, side, s.height}};
    },
    [](const RevolutionSolid& s) {
      Box box;
      for (const glm::dvec2& p : s.stroke) box.extend(Vec3{-p.x, -p.x, p.y}), box.extend(Vec3{p.x, p.x, p.y});
      return box;
    },
    [](const MeshSolid& s) { return s.mesh->bounds(); },
  }, solid);
}

void validate(const Solid& solid) {
  std::visit(Match{
    [](const BallSolid& s) {
      require_positive(s.radius, "radius");
      require_positive(s.angle, "alpha");
      if (s.angle > kPi * (1 + 1e-12)) throw InputError({}, "alpha = " + std::to_string(s.angle / kPi) + " pi", "an alpha of at most pi");
    },
    [](const EllipsoidSolid& s) {
      for (int i = 0; i < 3; ++i) require_positive(s.half_size[i], "half_size");
    },
    [](const CylinderSolid& s) { require_positive(s.radius, "radius"), require_positive(s.height, "height"); },
    [](const ConeSolid& s) {
      require_positive(s.height, "height");
      if (s.radius_base < 0) require_positive(s.radius_base, "radius_base");
      if (s.radius_tip < 0) require_positive(s.radius_tip, "radius_tip");
      require_positive(s.radius_base + s.radius_tip, "radius_base");
    },
    [](const RevolutionSolid& s) { validate_stroke(s.stroke); },
    [](const MeshSolid& s) {
      if (!s.mesh) throw InputError({}, "mesh: none", "a closed mesh");
    },
  }, solid);
}

bool contains(const Solid& solid, const Vec3& p) { return PreparedSolid(solid).contains(p); }

double depth(const Solid& solid, const Vec3& p) { return PreparedSolid(solid).depth(p); }

}  // namespace cambium
