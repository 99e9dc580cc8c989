#include "polygonize/annulus.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace cambium {
namespace {

using Point = glm::dvec2;
using Triangle = std::array<std::uint32_t, 3>;

double doubled_area(const Point& a, const Point& b, const Point& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Area for the squares of its sides: largest of an equilateral triangle.
double roundness(const Point& a, const Point& b, const Point& c) {
  return doubled_area(a, b, c) / (glm::dot(b - a, b - a) + glm::dot(c - b, c - b) + glm::dot(a - c, a - c));
}

bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  return (doubled_area(a, b, c) > 0) != (doubled_area(a, b, d) > 0) && (doubled_area(c, d, a) > 0) != (doubled_area(c, d, b) > 0);
}

/// d is inside of the circle through a, b and c, by more than rounding.
bool in_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point p = a - d, q = b - d, r = c - d;
  const double pp = glm::dot(p, p), qq = glm::dot(q, q), rr = glm::dot(r, r);
  const double found = pp * (q.x * r.y - q.y * r.x) - qq * (p.x * r.y - p.y * r.x) + rr * (p.x * q.y - p.y * q.x);
  return found > 1e-9 * std::max({pp, qq, rr}) * std::abs(doubled_area(a, b, c));
}

/// The annulus cut open along a chord: a simple polygon.
class OpenedAnnulus {
 public:
  OpenedAnnulus(const std::vector<Point>& lower, const std::vector<Point>& upper, double girth) 
      : girth_(girth), lower_(lower.size()), line_points_(lower.size() + upper.size()) {
    const auto highest = static_cast<std::size_t>(
        std::max_element(lower.begin(), lower.end(), [](const Point& a, const Point& b) { return a.y < b.y; }) - lower.begin());
    // From the highest point nothing is in the way of a chord upwards.
    std::size_t nearest = 0;
    double shift = 0, least = -1;
    for (std::size_t k = 0; k < upper.size(); ++k) {
      const double around = lower[highest].x - upper[k].x, turns = girth * std::round(around / girth);
      if (least < 0 || std::abs(around - turns) < least) least = std::abs(around - turns), nearest = k, shift = turns;
    }
    add(lower, 0, highest, 0, girth);
    const auto back = static_cast<std::ptrdiff_t>(points_.size());
    add(upper, static_cast<std::uint32_t>(lower.size()), nearest, shift, girth);
    std::reverse(points_.begin() + back, points_.end());
    std::reverse(names_.begin() + back, names_.end());
  }

  std::optional<AnnulusTriangles> triangulate(const ChordExcess& excess) {
    if (!is_simple() || !clip_ears()) return std::nullopt;
    flip();
    // Each point added halves a chord, and flips shorten others.
    for (std::size_t most = kMostAdded * line_points_, added = 0; added < most && halve_worst(excess); ++added) flip();
    AnnulusTriangles result;
    for (const Triangle& triangle : triangles_) result.triangles.push_back({names_[triangle[0]], names_[triangle[1]], names_[triangle[2]]});
    result.added.assign(points_.begin() + static_cast<std::ptrdiff_t>(line_points_ + 2), points_.end());
    return result;
  }

 private:
  // A line from its point `first` once around and back to it.
  void add(const std::vector<Point>& line, std::uint32_t first_name, std::size_t first, double shift, double girth) {
    for (std::size_t i = 0; i <= line.size(); ++i) {
      const std::size_t k = (first + i) % line.size();
      points_.push_back({line[k].x + shift + (first + i >= line.size() ? girth : 0), line[k].y});
      names_.push_back(first_name + static_cast<std::uint32_t>(k));
    }
  }

  bool is_simple() const {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 2; j < n; ++j) {
        if (i == 0 && j + 1 == n) continue;
        if (cross(points_[i], points_[i + 1], points_[j], points_[(j + 1) % n])) return false;
      }
    const Point around(girth_, 0);   // where the lower line leans beyond the chord it meets its next turn
    for (std::size_t i = 0; i < lower_; ++i)
      for (std::size_t j = 0; j < lower_; ++j) {
        const bool neighbours = i + 1 == lower_ && j == 0;
        if (!neighbours && cross(points_[i], points_[i + 1], points_[j] + around, points_[j + 1] + around)) return false;
      }
    return true;
  }

  bool is_ear(const std::vector<std::uint32_t>& left, std::size_t i) const {
    const std::uint32_t before = left[(i + left.size() - 1) % left.size()], at = left[i], after = left[(i + 1) % left.size()];
    const Point &a = points_[before], &b = points_[at], &c = points_[after];
    return std::none_of(left.begin(), left.end(), [&](std::uint32_t other) {
      if (other == before || other == at || other == after) return false;
      const Point& p = points_[other];
      return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
    });
  }

  // The roundest ear first.
  bool clip_ears() {
    std::vector<std::uint32_t> left(points_.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<std::pair<double, std::size_t>> order;
    while (left.size() > 3) {
      order.clear();
      const std::size_t n = left.size();
      for (std::size_t i = 0; i < n; ++i) {
        const double round = roundness(points_[left[(i + n - 1) % n]], points_[left[i]], points_[left[(i + 1) % n]]);
        if (round > 0) order.emplace_back(-round, i);
      }
      std::sort(order.begin(), order.end());
      const auto ear = std::find_if(order.begin(), order.end(), [&](const auto& candidate) { return is_ear(left, candidate.second); });
      if (ear == order.end()) return false;
      const std::size_t i = ear->second;
      put(static_cast<std::uint32_t>(triangles_.size()), {left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    }
    put(static_cast<std::uint32_t>(triangles_.size()), {left[0], left[1], left[2]});
    return doubled_area(points_[left[0]], points_[left[1]], points_[left[2]]) > 0;
  }

  // Lawson's flips: each lowers the triangles' circles, so they come to an end.
  void flip() {
    for (std::size_t most = triangles_.size() * triangles_.size(), rounds = 0; rounds < most && flip_some(); ++rounds) {}
  }

  bool flip_some() {
    bool any = false;
    find_chord([&](std::uint32_t s, std::uint32_t t, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      if (!in_circle(points_[a], points_[b], points_[c], points_[d])) return false;
      if (!(doubled_area(points_[c], points_[a], points_[d]) > 0 && doubled_area(points_[d], points_[b], points_[c]) > 0)) return false;
      drop_chord(a, b);
      put(s, {c, a, d});
      put(t, {d, b, c});
      any = true;
      return false;
    });
    return any;
  }

  /// Sides of the polygon stay.
  bool is_side(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t n = static_cast<std::uint32_t>(line_points_) + 2, apart = a < b ? b - a : a - b;
    return a < n && b < n && (apart == 1 || apart == n - 1);
  }

  double excess_between(const ChordExcess& excess, std::uint32_t a, std::uint32_t b) {
    const auto [known, is_new] = excess_of_.try_emplace(key_of(std::min(a, b), std::max(a, b)));
    if (is_new) known->second = excess(points_[a], points_[b]);
    return known->second;
  }

  // Not beside a side that is worse: points would pile up along it.
  bool halve_worst(const ChordExcess& excess) {
    double most = 1;
    Triangle worst{};
    find_chord([&](std::uint32_t, std::uint32_t, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      const double here = excess_between(excess, a, b);
      const auto worse = [&](std::uint32_t i, std::uint32_t j) { return is_side(i, j) && excess_between(excess, i, j) >= here; };
      if (here > most && !worse(b, c) && !worse(c, a) && !worse(a, d) && !worse(d, b)) most = here, worst = {a, b, c};
      return false;
    });
    if (!(most > 1)) return false;
    return find_chord([&](std::uint32_t s, std::uint32_t t, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      if (worst != Triangle{a, b, c}) return false;
      const auto middle = static_cast<std::uint32_t>(points_.size());
      points_.push_back((points_[a] + points_[b]) / 2.0);
      names_.push_back(middle - 2);   // the two points where it was cut open are here twice
      drop_chord(a, b);
      put(s, {a, middle, c});
      put(t, {b, middle, d});
      put(static_cast<std::uint32_t>(triangles_.size()), {middle, b, c});
      put(static_cast<std::uint32_t>(triangles_.size()), {middle, a, d});
      return true;
    });
  }

  /// try_on(s, t, a, b, c, d) for the chord from a to b between triangles s = abc and t = bad, each once, until one returns true.
  template <class TryOn>
  bool find_chord(TryOn&& try_on) {
    for (std::uint32_t s = 0; s < triangles_.size(); ++s)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = triangles_[s][i], b = triangles_[s][(i + 1) % 3], c = triangles_[s][(i + 2) % 3];
        const auto beyond = triangle_on_.find(key_of(b, a));
        if (beyond == triangle_on_.end() || beyond->second < s) continue;
        const Triangle& bad = triangles_[beyond->second];
        const std::uint32_t d = bad[0] + bad[1] + bad[2] - a - b;
        if (try_on(s, beyond->second, a, b, c, d)) return true;
      }
    return false;
  }

  static std::uint64_t key_of(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; }
  void put(std::uint32_t t, const Triangle& corners) {
    if (t == triangles_.size()) triangles_.emplace_back();
    triangles_[t] = corners;
    for (int i = 0; i < 3; ++i) triangle_on_[key_of(corners[i], corners[(i + 1) % 3])] = t;
  }
  void drop_chord(std::uint32_t a, std::uint32_t b) {
    triangle_on_.erase(key_of(a, b));
    triangle_on_.erase(key_of(b, a));
  }

  static constexpr std::size_t kMostAdded = 4;   // for every point of the lines
  double girth_;
  std::size_t lower_, line_points_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> names_;
  std::vector<Triangle> triangles_;
  std::unordered_map<std::uint64_t, std::uint32_t> triangle_on_;   // by its sides, in its own direction
  std::unordered_map<std::uint64_t, double> excess_of_;            // by chords and sides, lower end first
};

}  // namespace

std::optional<AnnulusTriangles> triangulate_annulus(const std::vector<glm::dvec2>& lower, const std::vector<glm::dvec2>& upper,
                                                    double girth, const ChordExcess& excess) {
  const auto below = [](const Point& a, const Point& b) { return a.y < b.y; };
  if (std::max_element(lower.begin(), lower.end(), below)->y >= std::min_element(upper.begin(), upper.end(), below)->y) return std::nullopt;
  return OpenedAnnulus(lower, upper, girth).triangulate(excess);
}

}  // namespace cambium
