#include "skeletons/scars.h"

#include "blobtree/input_error.h"
#include "skeletons/branch_edits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

/// Draw `place` of a stream, in [0, 1): the splitmix64 finaliser over seed and place.
double draw(std::uint64_t seed, std::uint64_t place) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ull + (place + 1) * 0xd1b54a32d192ed03ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

void check(const Scar& scar) {
  if (scar.radius && !(*scar.radius > 0 && std::isfinite(*scar.radius)))
    throw InputError({}, "a scar of radius " + std::to_string(*scar.radius), "a radius above 0");
  if (!(scar.depth > 0 && std::isfinite(scar.depth)))
    throw InputError({}, "a scar of depth " + std::to_string(scar.depth), "a depth above 0");
  if (!std::isfinite(scar.along) || !std::isfinite(scar.angle))
    throw InputError({}, "a scar at a place that is no number", "finite along and angle");
}

PlacedScar place_one(const AxisTree& tree, const std::vector<AxisFrame>& frames, const Scar& scar, std::size_t index) {
  const Axis& axis = tree.axes[index];
  PlacedScar placed{index, {}, scar.angle, scar.radius, scar.depth};
  if (scar.where.branch) {
    placed.place = place_at_length(lengths_along(axis), scar.along);
    return placed;
  }
  placed.place = nearest_place(axis, *scar.where.position);
  const Vec3 tangent = segment_direction(axis, placed.place.segment);
  const Vec3 off = *scar.where.position - position_at(axis, placed.place);
  const Vec3 outward = off - glm::dot(off, tangent) * tangent;
  if (glm::length(outward) > 1e-3 * radius_at(axis, placed.place)) {
    const Vec3 u = directions_along(axis, frames[index].u)[placed.place.segment];
    placed.angle = std::atan2(glm::dot(outward, glm::cross(tangent, u)), glm::dot(outward, u));
  }
  return placed;
}

/// Pieces of axis on which a random scar may lie, with the metres before each.
struct Ground {
  struct Piece { std::size_t axis; double begin, length; };
  std::vector<Piece> pieces;
  std::vector<double> before{0.0};
};

Ground scar_ground(const AxisTree& tree, double min_radius) {
  Ground ground;
  for (std::size_t i = 0; i < tree.axes.size(); ++i) {
    const Axis& axis = tree.axes[i];
    if (axis.nodes[0].radius < min_radius || axis.nodes.size() < 2) continue;
    const std::vector<double> lengths = lengths_along(axis);
    const double end_length = axis.cut ? axis.cut->along : lengths.back();
    const double first = length_inside_parent(tree, i) + axis.nodes[0].radius;
    const double last = end_length - radius_at(axis, place_at_length(lengths, end_length));
    for (std::size_t k = 1; k < axis.nodes.size() && axis.nodes[k].radius >= min_radius; ++k) {
      const double begin = std::max(lengths[k - 1], first), end = std::min(lengths[k], last);
      if (!(end > begin)) continue;
      ground.pieces.push_back({i, begin, end - begin});
      ground.before.push_back(ground.before.back() + end - begin);
    }
  }
  return ground;
}

void place_random(const AxisTree& tree, const SurfaceOptions& options, std::vector<PlacedScar>& scars,
                  SurfaceReport& report) {
  if (options.random_scars.count <= 0) return;
  const Ground ground = scar_ground(tree, options.random_scars.min_axis_radius);
  if (ground.pieces.empty()) {
    report.notes.push_back("No wood is thick enough for the random scars.");
    return;
  }
  for (int i = 0; i < options.random_scars.count; ++i) {
    const auto place = static_cast<std::uint64_t>(i);
    const double target = draw(options.seed, 2 * place) * ground.before.back();
    const auto above = std::upper_bound(ground.before.begin() + 1, ground.before.end() - 1, target);
    const auto k = static_cast<std::size_t>(above - ground.before.begin() - 1);
    const Ground::Piece& piece = ground.pieces[k];
    PlacedScar scar;
    scar.axis = piece.axis;
    scar.place = place_at_length(lengths_along(tree.axes[piece.axis]), piece.begin + target - ground.before[k]);
    scar.angle = 2 * std::numbers::pi * draw(options.seed, 2 * place + 1);
    scars.push_back(scar);
  }
}

}  // namespace

std::vector<PlacedScar> place_scars(const AxisTree& tree, const std::vector<AxisFrame>& frames,
                                    const SurfaceOptions& options, SurfaceReport& report) {
  std::vector<PlacedScar> scars;
  for (const Scar& scar : options.scars) {
    check(scar);
    if (const auto axis = select_axis(tree, scar.where, "a scar")) {
      scars.push_back(place_one(tree, frames, scar, *axis));
    } else {
      report.notes.push_back("A scar on branch " + std::to_string(*scar.where.branch) + " was left out: the branch is gone.");
    }
  }
  place_random(tree, options, scars, report);
  std::stable_sort(scars.begin(), scars.end(), [](const PlacedScar& a, const PlacedScar& b) {
    return a.axis != b.axis ? a.axis < b.axis : a.place.segment + a.place.t < b.place.segment + b.place.t;
  });
  return scars;
}

ScarPrimitives scar_primitives(const PlacedScar& scar, const Vec3& center, const Vec3& tangent, const Vec3& u,
                               double axis_radius) {
  // Larger than 0.7 of the axis it would reach round to the far side.
  const double radius = std::min(scar.radius.value_or(0.4 * axis_radius), 0.7 * axis_radius);
  const Vec3 side = glm::cross(tangent, u);
  const auto on_surface = [&](double metres_around) {
    const double angle = scar.angle + metres_around / axis_radius;
    return center + axis_radius * (std::cos(angle) * u + std::sin(angle) * side);
  };
  // Both lie across the stem, so the scar is wider than high. The stub raises the surface, the narrower and stronger dent
  // takes its middle away again, and the rim is what is left. The axis's own field falls by about 0.78 per axis radius at the
  // surface, so strengths in proportion to radius / axis_radius give every size of scar the same shape.
  const double relative = radius / axis_radius;
  ScarPrimitives made;
  made.stub = {on_surface(-0.5 * radius), on_surface(0.5 * radius), 0.55 * radius, 0.6 * relative};
  made.dent = {on_surface(-0.45 * radius), on_surface(0.45 * radius), 0.38 * radius, -1.05 * relative * scar.depth};
  return made;
}

}  // namespace cambium
