#include "skeletons/axis_shaping.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kReversal = 3.0;       // radians: beyond, a corner has no plane to be rounded in
constexpr double kSlack = 1 + 1e-7;     // of max_turn, for rounding errors

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

int steps_for(double angle, double max_turn) {
  return std::max(1, static_cast<int>(std::ceil(angle / (max_turn * kSlack))));
}

struct Corner { Vec3 in, out; double length_in, length_out; };

Corner corner_at(const Path& path, std::size_t i) {
  const PathNode &a = path[i - 1], &c = path[i], &b = path[i + 1];
  const double length_in = glm::distance(a.position, c.position), length_out = glm::distance(c.position, b.position);
  return {(c.position - a.position) / length_in, (b.position - c.position) / length_out, length_in, length_out};
}

double mix_at(double a, double b, double t) { return a + t * (b - a); }

}  // namespace

Path path_of(const Axis& axis) {
  Path path;
  path.reserve(axis.nodes.size());
  for (const AxisNode& node : axis.nodes) 
    path.push_back({node.position, node.radius, static_cast<double>(path.size()), node.base_radius});
  return path;
}

AxisPlace place_of(const Path& path, double at) {
  if (path.size() < 2) return {};
  const auto above = std::upper_bound(path.begin() + 1, path.end() - 1, at,
                                      [](double value, const PathNode& node) { return value < node.at; });
  const auto segment = static_cast<std::uint32_t>(above - path.begin() - 1);
  const double begin = path[segment].at, end = path[segment + 1].at;
  return {segment, end > begin ? std::clamp((at - begin) / (end - begin), 0.0, 1.0) : 0.0};
}

double diffuse(Path& path, double smooth) {
  const std::size_t count = path.size();
  if (count < 3 || !(smooth > 0)) return 0;
  // Implicit steps, each one tridiagonal solve: unconditionally stable, so the cost does not grow as steps shorten. Four of
  // them come near a Gaussian with a standard deviation of half of `smooth` radii, which leaves 1 % of a wave that long.
  constexpr int kPasses = 4;
  std::vector<Vec3> before(count);
  for (std::size_t i = 0; i < count; ++i) before[i] = path[i].position;
  std::vector<double> h(count), upper(count);
  std::vector<Vec3> right(count);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t i = 0; i + 1 < count; ++i)
      h[i] = std::max(glm::distance(path[i].position, path[i + 1].position), 1e-9 * path[i].radius);
    upper[0] = 0;
    right[0] = path[0].position;
    for (std::size_t i = 1; i + 1 < count; ++i) {
      const double sigma = 0.5 * smooth * path[i].radius, spread = 0.5 * sigma * sigma / kPasses;
      const double mass = 0.5 * (h[i - 1] + h[i]);
      const double to_last = spread / (mass * h[i - 1]), to_next = spread / (mass * h[i]);
      const double pivot = 1 + to_last + to_next - to_last * upper[i - 1];
      upper[i] = to_next / pivot;
      right[i] = (path[i].position + to_last * right[i - 1]) / pivot;
    }
    for (std::size_t i = count - 2; i > 0; --i) path[i].position = right[i] + upper[i] * path[i + 1].position;
  }
  double farthest = 0;
  for (std::size_t i = 0; i < count; ++i)
    farthest = std::max(farthest, glm::distance(before[i], path[i].position));
  return farthest;
}

std::size_t merge_short(Path& path, double spacing) {
  const std::size_t count = path.size();
  if (count < 3) return 0;
  const auto too_near = [&](const PathNode& a, const PathNode& b) {
    return glm::distance(a.position, b.position) < spacing * a.radius;
  };
  std::size_t kept = 1;
  double base = 0;                         // where the internode after the last node kept began; 0 before it is known
  const auto begin_with = [&](double radius, double before) { base = base > 0 ? base : radius > 0 ? radius : before; };
  for (std::size_t i = 1; i + 1 < count; ++i) {
    begin_with(path[i].base_radius, path[kept - 1].radius);
    if (too_near(path[kept - 1], path[i])) continue;
    path[kept] = path[i];
    path[kept++].base_radius = base;
    base = 0;
  }
  PathNode last = path.back();
  begin_with(last.base_radius, path[kept - 1].radius);
  while (kept > 1 && too_near(path[kept - 1], last)) base = path[--kept].base_radius;
  last.base_radius = base;
  path[kept++] = last;
  path.resize(kept);
  return count - kept;
}

BendPlan plan_bend(const Vec3& before, const Vec3& along, double angle) {
  const double turn = angle_between(before, along);
  const double limited = std::min({std::abs(angle), 2 * turn, 2.5});
  if (!(turn > 1e-3) || !(limited > 1e-4) || turn > kReversal) return {};
  const Vec3 away = across(along, -before);
  return {limited, angle < 0 ? -away : away};
}

void bend_internodes(Path& path, const Vec3& bearing, double angle, double max_turn) {
  if (path.size() < 2 || angle == 0) return;
  Path bent{path[0]};
  Vec3 before = bearing;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const PathNode &a = path[i - 1], &b = path[i];
    const double length = glm::distance(a.position, b.position);
    if (!(length > 0)) {
      bent.push_back(b);
      continue;
    }
    const Vec3 along = (b.position - a.position) / length;
    const BendPlan plan = before == Vec3(0.0) ? BendPlan{} : plan_bend(before, along, angle);
    if (plan.angle > 0) {
      const double half = 0.5 * plan.angle, rho = 0.5 * length / std::sin(half);
      const Vec3 center = 0.5 * (a.position + b.position) - rho * std::cos(half) * plan.direction;
      const int steps = steps_for(plan.angle, max_turn);
      for (int k = 1; k < steps; ++k) {
        const double t = static_cast<double>(k) / steps, phi = plan.angle * (t - 0.5);
        bent.push_back({center + rho * (std::sin(phi) * along + std::cos(phi) * plan.direction),
                        mix_at(a.radius, b.radius, t), mix_at(a.at, b.at, t)});
      }
    }
    bent.push_back(b);
    before = along;
  }
  path = std::move(bent);
}

void round_corners(Path& path, double extent, double max_turn) {
  if (path.size() < 3) return;
  // Turns first, so that the path that comes out, which may be many times as long, is never moved to make room.
  std::vector<double> turns(path.size(), 0);
  std::size_t size = path.size();
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const Corner corner = corner_at(path, i);
    const double turn = angle_between(corner.in, corner.out);
    if (!(turn > max_turn * kSlack) || turn > kReversal) continue;
    turns[i] = turn;
    size += static_cast<std::size_t>(steps_for(turn, max_turn));
  }
  Path rounded;
  rounded.reserve(size);
  rounded.push_back(path[0]);
  const auto append = [&](const PathNode& node) {
    const PathNode& last = rounded.back();
    if (glm::distance(last.position, node.position) > 1e-6 * last.radius) rounded.push_back(node);
  };
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const PathNode &a = path[i - 1], &c = path[i], &b = path[i + 1];
    const double turn = turns[i];
    if (turn == 0) {
      append(c);
      continue;
    }
    const auto [in, out, length_in, length_out] = corner_at(path, i);
    const double reach = std::min({extent * c.radius, 0.5 * length_in, 0.5 * length_out});
    const double rho = reach / std::tan(0.5 * turn);
    const Vec3 start = c.position - reach * in, inward = across(in, out);
    const double t_in = 1 - reach / length_in, t_out = reach / length_out;
    const int steps = steps_for(turn, max_turn);
    for (int k = 0; k <= steps; ++k) {
      const double s = static_cast<double>(k) / steps, phi = turn * s;
      const bool first_half = s <= 0.5;
      const double t = first_half ? mix_at(t_in, 1, 2 * s) : mix_at(0, t_out, 2 * s - 1);
      const PathNode &from = first_half ? a : c, &to = first_half ? c : b;
      append({start + rho * (std::sin(phi) * in + (1 - std::cos(phi)) * inward), mix_at(from.radius, to.radius, t),
              mix_at(from.at, to.at, t)});
    }
  }
  if (rounded.size() > 1 &&
      glm::distance(rounded.back().position, path.back().position) <= 1e-6 * rounded.back().radius)
    rounded.pop_back();
  rounded.push_back(path.back());
  path = std::move(rounded);
}

}  // namespace cambium
