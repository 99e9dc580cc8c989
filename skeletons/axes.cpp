#include "skeletons/axes.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace cambium {
namespace {

constexpr double kCoincident = 1e-6;  // of the radius: far below what a surface shows, far above rounding

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : fallback;
}

/// Children of every node in file order: first[i] .. first[i + 1) in `child`.
struct ChildLists {
  std::vector<std::uint32_t> first, child;

  explicit ChildLists(const std::vector<SkeletonNode>& nodes) : first(nodes.size() + 1, 0) {
    for (const SkeletonNode& node : nodes)
      if (node.parent >= 0) ++first[node.parent + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    child.resize(first.back());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].parent >= 0) child[next[nodes[i].parent]++] = static_cast<std::uint32_t>(i);
  }
};

bool all_finite(const std::vector<SkeletonNode>& nodes) {
  return std::all_of(nodes.begin(), nodes.end(), [](const SkeletonNode& node) {
    return finite(node.position) && std::isfinite(node.radius) && (!node.base_radius || std::isfinite(*node.base_radius));
  });
}

std::vector<SkeletonNode> with_finite_numbers(std::vector<SkeletonNode> nodes) {
  for (SkeletonNode& node : nodes) {
    if (!finite(node.position)) node.position = node.parent >= 0 ? nodes[node.parent].position : Vec3(0.0);
    if (!std::isfinite(node.radius)) node.radius = node.parent >= 0 ? nodes[node.parent].radius : 0;
    if (node.base_radius && !std::isfinite(*node.base_radius)) node.base_radius.reset();
  }
  return nodes;
}

std::int64_t continuation(const std::vector<SkeletonNode>& nodes, const ChildLists& lists, std::uint32_t at,
                          const Vec3& direction) {
  bool unbracketed = false;
  for (std::uint32_t k = lists.first[at]; k < lists.first[at + 1]; ++k)
    unbracketed = unbracketed || nodes[lists.child[k]].lateral == false;
  std::int64_t best = -1;
  double best_radius = 0, best_cosine = 0;
  for (std::uint32_t k = lists.first[at]; k < lists.first[at + 1]; ++k) {
    const SkeletonNode& node = nodes[lists.child[k]];
    if (unbracketed && node.lateral != false) continue;
    const double radius = node.base_radius.value_or(node.radius);
    const double cosine = glm::dot(direction, unit_or(node.position - nodes[at].position, Vec3(0.0)));
    const bool as_thick = best >= 0 && std::abs(radius - best_radius) <= 1e-9 * best_radius;
    if (best < 0 || (as_thick ? cosine > best_cosine + 1e-12 : radius > best_radius)) {
      best = lists.child[k];
      best_radius = radius;
      best_cosine = cosine;
    }
  }
  return best;
}

/// Appends the internode to `node`. A step in radius at its base becomes a taper over the internode, or is kept.
void append_internode(std::vector<AxisNode>& path, const SkeletonNode& node, bool first_of_lateral, RadiusSteps steps,
                      std::size_t& merged) {
  const AxisNode last = path.back();
  const double length = glm::distance(last.position, node.position);
  if (length <= kCoincident * std::max(last.radius, node.radius)) {
    ++merged;
    return;
  }
  const bool step = !first_of_lateral && node.base_radius && *node.base_radius < 0.98 * last.radius;
  path.push_back({node.position, node.radius, step && steps == RadiusSteps::kKeep ? *node.base_radius : 0});
}

}  // namespace

AxisTree decompose_axes(const Skeleton& skeleton, RadiusSteps steps, std::size_t* merged, std::span<const std::int32_t> ridden) {
  struct Start { std::int32_t parent; AxisPlace attach; std::uint32_t from, first; };
  std::vector<SkeletonNode> repaired;  // a skeleton is large: copied only where there is something to repair
  if (!all_finite(skeleton.nodes)) repaired = with_finite_numbers(skeleton.nodes);
  const std::vector<SkeletonNode>& nodes = repaired.empty() ? skeleton.nodes : repaired;
  const ChildLists lists(nodes);
  std::size_t tips = 0;  // every axis ends in one
  for (std::size_t i = 0; i < nodes.size(); ++i) tips += lists.first[i] == lists.first[i + 1] ? 1 : 0;
  std::size_t merged_here = 0;
  std::vector<Start> starts;  // breadth first: worked off from the front
  starts.reserve(tips);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent < 0)
      starts.push_back({-1, {}, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i)});

  AxisTree tree;
  tree.axes.reserve(tips);
  std::vector<AxisRider> rider_of(ridden.empty() ? 0 : nodes.size());
  std::vector<AxisNode> path;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const Start start = starts[s];
    Axis axis;
    axis.branch = static_cast<std::uint32_t>(s);
    axis.parent = start.parent;
    axis.attach = start.attach;
    axis.order = start.parent < 0 ? 0 : tree.axes[start.parent].order + 1;
    const SkeletonNode& head = nodes[start.first];
    path.clear();
    path.push_back({nodes[start.from].position, head.base_radius.value_or(head.radius)});
    std::uint32_t at = start.first;
    if (start.parent >= 0) append_internode(path, head, true, steps, merged_here);
    Vec3 direction = unit_or(nodes[at].position - nodes[start.from].position, Vec3(0, 0, 1));
    while (true) {
      const std::int64_t next = continuation(nodes, lists, at, direction);
      const auto here = static_cast<std::uint32_t>(path.size() - 1);
      const AxisPlace place = here == 0 ? AxisPlace{0, 0} : AxisPlace{here - 1, 1};
      if (!rider_of.empty()) rider_of[at] = {static_cast<std::int32_t>(s), place};
      for (std::uint32_t k = lists.first[at]; k < lists.first[at + 1]; ++k)
        if (lists.child[k] != next) starts.push_back({static_cast<std::int32_t>(s), place, at, lists.child[k]});
      if (next < 0) break;
      direction = unit_or(nodes[next].position - nodes[at].position, direction);
      append_internode(path, nodes[next], false, steps, merged_here);
      at = static_cast<std::uint32_t>(next);
    }
    axis.nodes.assign(path.begin(), path.end());
    tree.axes.push_back(std::move(axis));
  }
  tree.branch_count = static_cast<std::uint32_t>(tree.axes.size());
  for (const std::int32_t node : ridden) {
    AxisRider& rider = tree.riders.emplace_back(node < 0 ? AxisRider{} : rider_of[node]);
    if (rider.axis >= 0) rider.tangent = tangent_at(tree.axes[rider.axis], rider.place);
  }
  if (merged) *merged += merged_here;
  return tree;
}

void remove_axes(AxisTree& tree, std::vector<bool> marked) {
  std::vector<std::int32_t> place(tree.axes.size(), -1);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tree.axes.size(); ++i) {
    const std::int32_t parent = tree.axes[i].parent;
    if (parent >= 0 && marked[parent]) marked[i] = true;
    if (marked[i]) continue;
    place[i] = static_cast<std::int32_t>(kept);
    if (parent >= 0) tree.axes[i].parent = place[parent];
    if (kept != i) tree.axes[kept] = std::move(tree.axes[i]);
    ++kept;
  }
  tree.axes.resize(kept);
  for (AxisRider& rider : tree.riders)
    if (rider.axis >= 0) rider.axis = place[rider.axis];
}

Vec3 position_at(const Axis& axis, const AxisPlace& place) {
  if (place.segment + 1 >= axis.nodes.size()) return axis.nodes.back().position;
  if (place.t >= 1) return axis.nodes[place.segment + 1].position;
  return glm::mix(axis.nodes[place.segment].position, axis.nodes[place.segment + 1].position, place.t);
}

double radius_at(const Axis& axis, const AxisPlace& place) {
  if (place.segment + 1 >= axis.nodes.size()) return axis.nodes.back().radius;
  if (place.t >= 1) return axis.nodes[place.segment + 1].radius;
  return glm::mix(axis.nodes[place.segment].radius, axis.nodes[place.segment + 1].radius, place.t);
}

Vec3 tangent_at(const Axis& axis, const AxisPlace& place) {
  const std::size_t count = axis.nodes.size();
  if (count < 2) return {0, 0, 1};
  const auto direction = [&](std::size_t segment) {
    return unit_or(axis.nodes[segment + 1].position - axis.nodes[segment].position, Vec3(0, 0, 1));
  };
  const std::size_t segment = std::min<std::size_t>(place.segment, count - 2);
  const Vec3 here = direction(segment);
  if (place.t >= 1 && segment + 2 < count) return unit_or(here + direction(segment + 1), here);
  if (place.t <= 0 && segment > 0) return unit_or(here + direction(segment - 1), here);
  return here;
}

std::vector<double> lengths_along(const Axis& axis) {
  std::vector<double> lengths(axis.nodes.size(), 0);
  for (std::size_t i = 1; i < lengths.size(); ++i)
    lengths[i] = lengths[i - 1] + glm::distance(axis.nodes[i - 1].position, axis.nodes[i].position);
  return lengths;
}

double length_of(const Axis& axis) {
  double length = 0;
  for (std::size_t i = 1; i < axis.nodes.size(); ++i)
    length += glm::distance(axis.nodes[i - 1].position, axis.nodes[i].position);
  return length;
}

AxisPlace place_at_length(const std::vector<double>& lengths, double along) {
  if (lengths.size() < 2) return {};
  const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, along);
  const auto segment = static_cast<std::uint32_t>(above - lengths.begin() - 1);
  const double length = lengths[segment + 1] - lengths[segment];
  return {segment, length > 0 ? std::clamp((along - lengths[segment]) / length, 0.0, 1.0) : 0.0};
}

namespace {

/// Nearest t on a segment and the squared distance there.
std::pair<double, double> nearest_on_segment(const Axis& axis, std::size_t segment, const Vec3& p) {
  const Vec3 a = axis.nodes[segment].position, d = axis.nodes[segment + 1].position - a;
  const double dd = glm::dot(d, d);
  const double t = dd > 0 ? std::clamp(glm::dot(p - a, d) / dd, 0.0, 1.0) : 0.0;
  const Vec3 off = p - a - t * d;
  return {t, glm::dot(off, off)};
}

}  // namespace

AxisPlace nearest_place(const Axis& axis, const Vec3& p) {
  AxisPlace best;
  double best_distance = kInfinity;
  for (std::size_t i = 0; i + 1 < axis.nodes.size(); ++i) {
    const auto [t, distance] = nearest_on_segment(axis, i, p);
    if (distance < best_distance) best = {static_cast<std::uint32_t>(i), t}, best_distance = distance;
  }
  return best;
}

AxisPlace walk_to_nearest(const Axis& axis, AxisPlace from, const Vec3& p) {
  if (axis.nodes.size() < 2) return {};
  const std::size_t last = axis.nodes.size() - 2;
  AxisPlace best{static_cast<std::uint32_t>(std::min<std::size_t>(from.segment, last)), 0};
  double best_distance = 0;
  std::tie(best.t, best_distance) = nearest_on_segment(axis, best.segment, p);
  for (const int step : {1, -1}) {
    for (std::int64_t i = static_cast<std::int64_t>(best.segment) + step; i >= 0 && i <= static_cast<std::int64_t>(last);
         i += step) {
      const auto [t, distance] = nearest_on_segment(axis, static_cast<std::size_t>(i), p);
      if (distance > best_distance) break;
      best = {static_cast<std::uint32_t>(i), t};
      best_distance = distance;
    }
  }
  return best;
}

Vec3 across(const Vec3& t, const Vec3& wanted) {
  const Vec3 v = wanted - glm::dot(wanted, t) * t;
  if (glm::length(v) > 1e-6 * glm::length(wanted)) return glm::normalize(v);
  const Vec3 a = glm::abs(t);
  const Vec3 other = a.x <= a.y && a.x <= a.z ? Vec3(1, 0, 0) : a.y <= a.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  return glm::normalize(other - glm::dot(other, t) * t);
}

Vec3 transported(const Vec3& u, const Vec3& from, const Vec3& to) {
  const double cosine = glm::dot(from, to);
  if (cosine < -0.999999) return across(to, u);  // turned back: any half turn will do
  const Vec3 w = glm::cross(from, to);           // Rodrigues' rotation with sine |w| and cosine
  return across(to, u * cosine + glm::cross(w, u) + w * (glm::dot(w, u) / (1 + cosine)));
}

}  // namespace cambium
