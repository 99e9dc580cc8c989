#include "skeletons/graph/mesh_closing.h"

#include "blobtree/input_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

namespace cambium {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// One side of a triangle, by its edge's vertices, lower one first.
struct Side {
  std::uint32_t low, high;
  std::uint32_t triangle;
  bool upwards;                    // from low to high as the triangle winds
};

/// The lines that triangles have in common, each a run of sides.
struct Edge {
  std::size_t begin, end;
  std::size_t count() const { return end - begin; }
};

void require_sound(const std::vector<Vec3>& positions, const std::vector<Corners>& triangles) {
  if (triangles.empty()) throw InputError({}, "a mesh without triangles", "a closed mesh");
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!std::isfinite(positions[i].x + positions[i].y + positions[i].z))
      throw InputError({}, "mesh: vertex " + std::to_string(i + 1) + " is not finite", "finite coordinates");
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t v : triangles[i])
      if (v >= positions.size())
        throw InputError({}, "mesh: triangle " + std::to_string(i + 1) + " has vertex " + std::to_string(v + std::uint64_t{1}),
                         "one of the " + std::to_string(positions.size()) + " there are");
}

/// Of each vertex the first at its place.
std::vector<std::uint32_t> welded(const std::vector<Vec3>& positions) {
  const auto key = [&](std::uint32_t v) { return std::tuple(positions[v].x, positions[v].y, positions[v].z, v); };
  std::vector<std::uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && positions[order[i]] == positions[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

std::vector<Corners> with_common_vertices(const std::vector<Corners>& triangles, const std::vector<std::uint32_t>& first) {
  std::vector<Corners> joined;
  for (const Corners& t : triangles) {
    const Corners j = {first[t[0]], first[t[1]], first[t[2]]};
    if (j[0] != j[1] && j[1] != j[2] && j[2] != j[0]) joined.push_back(j);
  }
  return joined;
}

/// Without pairs at the same corners that wind opposite ways: a sheet with two sides encloses nothing.
std::vector<Corners> without_doubled(std::vector<Corners> triangles) {
  for (Corners& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  const auto key = [](const Corners& t) { return Corners{t[0], std::min(t[1], t[2]), std::max(t[1], t[2])}; };
  std::sort(triangles.begin(), triangles.end(), [&](const Corners& a, const Corners& b) { return key(a) < key(b); });
  std::vector<Corners> left;
  for (const Corners& t : triangles) {
    const auto opposite = [&](const Corners& other) { return other[0] == t[0] && other[1] == t[2] && other[2] == t[1]; };
    if (!left.empty() && opposite(left.back())) {
      left.pop_back();
    } else {
      left.push_back(t);
    }
  }
  return left;
}

std::vector<Side> sides_of(const std::vector<Corners>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles[t][i], to = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle); });
  return sides;
}

std::vector<Edge> edges_of(const std::vector<Side>& sides) {
  std::vector<Edge> edges;
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    for (end = begin + 1; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high;) ++end;
    edges.push_back({begin, end});
  }
  return edges;
}

bool balanced(const std::vector<Side>& sides, const Edge& edge) {
  std::ptrdiff_t sum = 0;
  for (std::size_t i = edge.begin; i < edge.end; ++i) sum += sides[i].upwards ? 1 : -1;
  return sum == 0;
}

std::string text_of(const Vec3& p) { return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")"; }

/// What is wrong where edges with other than two triangles cannot be balanced by turning any.
[[noreturn]] void refuse_open(const std::vector<Side>& sides, const std::vector<Edge>& edges, const std::vector<Vec3>& positions) {
  const auto lone = [](const Edge& edge) { return edge.count() == 1; };
  const auto odd = [&](const Edge& edge) { return edge.count() > 2 && !balanced(sides, edge); };
  const auto place = [&](const Edge& edge) {
    return ", the first from " + text_of(positions[sides[edge.begin].low]) + " to " + text_of(positions[sides[edge.begin].high]);
  };
  const auto some = [](std::ptrdiff_t count) { return std::to_string(count) + (count == 1 ? " edge has " : " edges have "); };
  const auto first = std::find_if(edges.begin(), edges.end(), lone);
  if (first != edges.end())
    throw InputError({}, "an open mesh: " + some(std::count_if(edges.begin(), edges.end(), lone)) + "one triangle" + place(*first),
                     "a closed mesh, two triangles at each edge");
  throw InputError({}, "a mesh with walls in it: " + some(std::count_if(edges.begin(), edges.end(), odd)) + "more than two triangles" +
                           place(*std::find_if(edges.begin(), edges.end(), odd)),
                   "a closed mesh, two triangles at each edge");
}

/// Turns triangles so that they agree with those at their edges, two at each. A part where some did not is then turned outwards.
class Turning {
 public:
  Turning(std::vector<Corners>& triangles, const std::vector<Side>& sides, const std::vector<Edge>& edges)
      : triangles_(triangles), around_(triangles.size()), turned_(triangles.size(), 0), seen_(triangles.size(), 0),
        filled_(triangles.size(), 0) {
    for (const Edge& edge : edges) link(sides[edge.begin], sides[edge.begin + 1]);
  }

  void run(const std::vector<Vec3>& positions) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      if (!seen_[t]) turn_part(t, positions);
  }

 private:
  struct Neighbour {
    std::uint32_t triangle;
    bool agrees;
  };

  void link(const Side& a, const Side& b) {
    const bool agrees = a.upwards != b.upwards;
    around_[a.triangle][filled_[a.triangle]++] = {b.triangle, agrees};
    around_[b.triangle][filled_[b.triangle]++] = {a.triangle, agrees};
  }

  void turn_part(std::uint32_t first, const std::vector<Vec3>& positions) {
    std::vector<std::uint32_t> part = {first};
    seen_[first] = 1;
    bool disagreed = false;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const auto& [other, agrees] : around_[part[i]]) {
        const std::uint8_t wanted = turned_[part[i]] ^ (agrees ? 0 : 1);
        disagreed = disagreed || !agrees;
        if (!seen_[other]) {
          seen_[other] = 1, turned_[other] = wanted;
          part.push_back(other);
        } else if (turned_[other] != wanted) {
          throw InputError({}, "a mesh with one side only, at " + text_of(positions[triangles_[other][0]]), "a mesh with an inside");
        }
      }
    if (!disagreed) return;
    for (const std::uint32_t t : part)
      if (turned_[t]) std::swap(triangles_[t][1], triangles_[t][2]);
    const Vec3 origin = positions[triangles_[first][0]];
    double volume = 0;
    for (const std::uint32_t t : part) {
      const auto at = [&](std::size_t k) { return positions[triangles_[t][k]] - origin; };
      volume += glm::dot(at(0), glm::cross(at(1), at(2)));
    }
    if (volume < 0)
      for (const std::uint32_t t : part) std::swap(triangles_[t][1], triangles_[t][2]);
  }

  std::vector<Corners>& triangles_;
  std::vector<std::array<Neighbour, 3>> around_;
  std::vector<std::uint8_t> turned_, seen_, filled_;
};

void require_volume(const std::vector<std::array<Vec3, 3>>& triangles) {
  Box box;
  double area = 0, volume = 0;
  const Vec3 origin = triangles[0][0];
  for (const auto& [a, b, c] : triangles) {
    box.extend(a), box.extend(b), box.extend(c);
    area += 0.5 * glm::length(glm::cross(b - a, c - a));
    volume += std::abs(glm::dot(a - origin, glm::cross(b - origin, c - origin))) / 6;
  }
  if (!(volume > 1e-12 * area * glm::length(box.size()))) throw InputError({}, "a mesh without volume", "a closed mesh around a solid");
}

}  // namespace

std::vector<std::array<Vec3, 3>> closed_triangles(const std::vector<Vec3>& positions, const std::vector<Corners>& given) {
  require_sound(positions, given);
  std::vector<Corners> triangles = without_doubled(with_common_vertices(given, welded(positions)));
  if (triangles.empty()) throw InputError({}, "a mesh without volume", "a closed mesh around a solid");
  const std::vector<Side> sides = sides_of(triangles);
  const std::vector<Edge> edges = edges_of(sides);
  if (!std::all_of(edges.begin(), edges.end(), [&](const Edge& edge) { return balanced(sides, edge); })) {
    const bool paired = std::all_of(edges.begin(), edges.end(), [](const Edge& edge) { return edge.count() == 2; });
    if (!paired) refuse_open(sides, edges, positions);
    Turning(triangles, sides, edges).run(positions);
  }
  std::vector<std::array<Vec3, 3>> closed;
  closed.reserve(triangles.size());
  for (const Corners& t : triangles) closed.push_back({positions[t[0]], positions[t[1]], positions[t[2]]});
  require_volume(closed);
  return closed;
}

}  // namespace cambium
