#include "blobtree/node_rules.h"

#include "blobtree/degrees.h"
#include "blobtree/flare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cambium {
namespace {

std::string show(double v) { return fmt::format("{}", v); }
std::string show(const Vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
std::string at(const char* list, std::size_t i) { return fmt::format("{}[{}]", list, i); }

double degrees(double radians) { return static_cast<double>(degrees_from_radians(radians)); }
constexpr double kSmallestGap = 1e-6;    // radians: between prongs that are nearer there is nothing to see
constexpr double kLargestSpread = 1000;

using Key = std::string_view;

[[noreturn]] void refuse(Key key, std::string found, std::string expected) {
  throw InvalidNode(std::string(key), std::move(found), std::move(expected));
}

bool within(double v, double largest) { return std::abs(v) <= largest; }  // false for NaN

void check_finite(Key key, double v) {
  if (!within(v, kLargestLength)) refuse(key, show(v), "a finite number of at most 1e9 in size");
}

void check_point(Key key, const Vec3& p) {
  if (!within(p.x, kLargestLength) || !within(p.y, kLargestLength) || !within(p.z, kLargestLength))
    refuse(key, show(p), "finite coordinates in metres, at most 1e9 in size");
}

void check_positive(Key key, double v) {
  if (!(v >= kSmallestLength && v <= kLargestLength)) refuse(key, show(v), "a positive length in metres, 1e-9 to 1e9");
}

void check_direction(Key key, const Vec3& d) {
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  const bool finite = std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z);
  if (!finite || !(largest >= kSmallestLength && largest <= kLargestLength))
    refuse(key, show(d), "a direction: three finite numbers, not all zero");
}

void check_at_least_one(Key key, std::size_t count) {
  if (count == 0) refuse(key, "none", "at least one");
}

void check_contact(double width, double lip) {
  if (!(width > 0 && width <= kIso)) refuse("width", show(width), "a number above 0, at most 0.5");
  if (!(lip >= 0 && lip <= 4)) refuse("lip", show(lip), "a number from 0 to 4");
}

void check(const Cone& n) {
  check_point("base", n.base);
  check_point("tip", n.tip);
  check_positive("radius_base", n.radius_base);
  check_positive("radius_tip", n.radius_tip);
}

void check(const RoundCone& n) {
  check_point("base", n.base);
  check_point("tip", n.tip);
  check_positive("radius_base", n.radius_base);
  check_positive("radius_tip", n.radius_tip);
}

void check_chain_nodes(const std::vector<ChainNode>& nodes) {
  check_at_least_one("nodes", nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& [p, radius] = nodes[i];
    const bool legal = within(p.x, kLargestLength) && within(p.y, kLargestLength) && within(p.z, kLargestLength) &&
                       radius >= kSmallestLength && radius <= kLargestLength;
    if (!legal)  // the key is only built when it is needed: chains are long
      refuse(at("nodes", i), fmt::format("[{}, {}, {}, {}]", p.x, p.y, p.z, radius),
             "finite x, y, z and a positive radius in metres, at most 1e9");
  }
}

void check(const Chain& n) { check_chain_nodes(n.nodes); }

void check_prongs(const std::vector<Prong>& prongs) {
  check_at_least_one("prongs", prongs.size());
  std::vector<std::pair<double, std::size_t>> around;   // by angle in [0, 2 pi)
  for (std::size_t i = 0; i < prongs.size(); ++i) {
    const auto& [angle, length] = prongs[i];
    if (!within(angle, kLargestLength)) refuse(at("prongs", i) + ".angle_degrees", show(degrees(angle)), "a finite number");
    if (!(length >= 0 && length <= kLargestLength)) refuse(at("prongs", i) + ".length", show(length), "a number from 0 to 1e9");
    around.emplace_back(wrapped_angle(angle), i);
  }
  std::sort(around.begin(), around.end());
  for (std::size_t k = 0; k < around.size() && around.size() > 1; ++k) {
    const bool last = k + 1 == around.size();
    const auto& [from, i] = around[k];
    const auto& [to, j] = around[last ? 0 : k + 1];
    if (to + (last ? 2 * std::numbers::pi : 0.0) - from < kSmallestGap)
      refuse(at("prongs", std::max(i, j)) + ".angle_degrees", show(degrees(prongs[std::max(i, j)].angle)),
             fmt::format("an angle other than that of prongs[{}]", std::min(i, j)));
  }
}

void check(const Flare& n) {
  check_chain_nodes(n.nodes);
  check_point("base", n.base);
  check_direction("axis", n.axis);
  check_positive("height", n.height);
  if (!(n.spread >= 0 && n.spread <= kLargestSpread)) refuse("spread", show(n.spread), "a number from 0 to 1000");
  if (!(n.sharpness >= 0 && n.sharpness <= kSharpest)) refuse("sharpness", show(n.sharpness), "a number from 0 to 0.95");
  check_prongs(n.prongs);
}

void check(const Sphere& n) {
  check_point("center", n.center);
  check_positive("radius", n.radius);
}

void check(const Capsule& n) {
  check_point("a", n.a);
  check_point("b", n.b);
  check_positive("radius", n.radius);
}

void check(const Disc& n) {
  check_point("center", n.center);
  check_direction("normal", n.normal);
  check_positive("disc_radius", n.disc_radius);
  check_positive("radius", n.radius);
}

void check(const Torus& n) {
  check_point("center", n.center);
  check_direction("normal", n.normal);
  check_positive("ring_radius", n.ring_radius);
  check_positive("radius", n.radius);
}

void check(const RotatedBox& n) {
  check_point("center", n.center);
  check_point("half_size", n.half_size);
  if (!(n.half_size.x >= 0 && n.half_size.y >= 0 && n.half_size.z >= 0))
    refuse("half_size", show(n.half_size), "three lengths in metres, none negative");
  const auto& q = n.rotation;
  const double largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  const bool finite = std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) && std::isfinite(q.w);
  if (!finite || !(largest >= kSmallestLength && largest <= kLargestLength))
    refuse("rotation", fmt::format("[{}, {}, {}, {}]", q.x, q.y, q.z, q.w),
           "a quaternion: four finite numbers, not all zero");
  check_positive("radius", n.radius);
}

void check(const HalfSpace& n) {
  check_point("point", n.point);
  check_direction("normal", n.normal);
  check_positive("width", n.width);
}

void check(const Sum& n) { check_at_least_one("children", n.children.size()); }
void check(const Union& n) { check_at_least_one("children", n.children.size()); }
void check(const Intersection& n) { check_at_least_one("children", n.children.size()); }
void check(const Difference& n) { check_at_least_one("children", n.children.size()); }

void check(const Ricci& n) {
  check_at_least_one("children", n.children.size());
  if (!(n.exponent >= 1 && n.exponent <= kLargestLength)) refuse("exponent", show(n.exponent), "a number from 1 to 1e9");
}

void check(const Contact& n) {
  check_at_least_one("children", n.children.size());
  check_contact(n.width, n.lip);
}

void check(const Fork& n) {
  check_at_least_one("laterals", n.laterals.size());
  check_contact(n.width, n.lip);
  for (std::size_t i = 0; i < n.laterals.size(); ++i) {
    const auto prefix = at("laterals", i);
    check_point(prefix + ".point", n.laterals[i].point);
    check_direction(prefix + ".direction", n.laterals[i].direction);
    check_positive(prefix + ".softness", n.laterals[i].softness);
    check_positive(prefix + ".reach", n.laterals[i].reach);
  }
}

void check(const ScaleField& n) { check_finite("factor", n.factor); }

void check(const Transform& n) {
  const auto illegal = [](const std::string& found) {
    refuse("matrix", found, "16 numbers, row-major: a rotation times one positive scale, a translation, last row 0 0 0 1");
  };
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!within(n.matrix[c][r], kLargestLength)) illegal("the number " + show(n.matrix[c][r]));
  if (n.matrix[0][3] != 0 || n.matrix[1][3] != 0 || n.matrix[2][3] != 0 || n.matrix[3][3] != 1)
    illegal(fmt::format("last row {} {} {} {}", n.matrix[0][3], n.matrix[1][3], n.matrix[2][3], n.matrix[3][3]));
  const Vec3 x(n.matrix[0]), y(n.matrix[1]), z(n.matrix[2]);
  const double scale = glm::length(x);
  if (!(scale >= kSmallestLength)) illegal("a first column of length " + show(scale));
  constexpr double kSlack = 1e-6;  // matrices typed by hand carry six or seven digits
  if (std::abs(glm::length(y) / scale - 1) > kSlack || std::abs(glm::length(z) / scale - 1) > kSlack)
    illegal(fmt::format("column lengths {}, {}, {}", scale, glm::length(y), glm::length(z)));
  const double square = scale * scale;
  if (std::abs(glm::dot(x, y)) > kSlack * square || std::abs(glm::dot(y, z)) > kSlack * square ||
      std::abs(glm::dot(z, x)) > kSlack * square)
    illegal("columns that are not at right angles");
  if (glm::dot(glm::cross(x, y), z) < 0) illegal("a mirrored matrix");
}

void check(const Bend& n) {
  check_point("from", n.from);
  check_point("to", n.to);
  check_direction("direction", n.direction);
  if (!(std::abs(n.angle) < 2 * std::numbers::pi))
    refuse("angle_degrees", show(degrees(n.angle)), "an angle between -360 and 360 degrees");
  const Vec3 along = n.to - n.from;
  const double length = glm::length(along);
  if (!(length >= kSmallestLength)) refuse("to", show(n.to), "a point other than `from`");
  const Vec3 d = glm::normalize(n.direction);
  if (!(glm::length(glm::cross(d, along / length)) >= 1e-6))
    refuse("direction", show(n.direction), "a direction that is not along the segment");
}

void check(const Twist& n) {
  check_point("point", n.point);
  check_direction("axis", n.axis);
  if (!within(n.rate, kLargestLength)) refuse("rate_degrees_per_metre", show(degrees(n.rate)), "a finite number");
}

void check(const Taper& n) {
  check_point("point", n.point);
  check_direction("axis", n.axis);
  check_finite("from[0]", n.from_height);
  check_finite("to[0]", n.to_height);
  const auto legal_scale = [](double v) { return v >= kSmallestLength && v <= kLargestLength; };
  if (!legal_scale(n.from_scale)) refuse("from[1]", show(n.from_scale), "a positive scale");
  if (!legal_scale(n.to_scale)) refuse("to[1]", show(n.to_scale), "a positive scale");
  if (!(n.to_height - n.from_height >= kSmallestLength))
    refuse("to[0]", show(n.to_height), fmt::format("a height above that of `from`, {}", n.from_height));
}

}  // namespace

void check_numbers(const Node& node) {
  std::visit(
      [](const auto& n) {
        check(n);
        if constexpr (requires { n.strength; }) check_finite("strength", n.strength);
      },
      node);
}

}  // namespace cambium
