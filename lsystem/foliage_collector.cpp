#include "lsystem/foliage_collector.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "lsystem/outline_triangles.h"
#include "lsystem/round_shapes.h"

namespace cambium {
namespace {

constexpr std::uint32_t kNoShape = 0xffffffff;

// Numbers about 1 are equal if they are in one cell of this size: rounding along a walk is far below it, what is to be seen
// far above. Cells are shifted so that round numbers lie well inside of one.
constexpr double kCell = 1e-5;
constexpr double kShift = 0.318;

void append_rounded(const Vec3& v, std::vector<std::int32_t>& out) {
  for (glm::length_t axis = 0; axis < 3; ++axis)
    out.push_back(static_cast<std::int32_t>(std::floor(v[axis] / kCell + kShift)));
}

double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// How far the outline reaches from where it is held.
double reach(const std::vector<Vec3>& corners) {
  double out = 0;
  for (const Vec3& corner : corners) out = std::max(out, glm::length(corner));
  return out;
}

/// With a reach of 1, and a corner that was recorded several times in a row once.
std::vector<Vec3> normalized_outline(const std::vector<Vec3>& corners, double scale) {
  const auto same = [](const Vec3& a, const Vec3& b) { return largest(a - b) < 1e-9; };
  std::vector<Vec3> out;
  out.reserve(corners.size());
  for (const Vec3& corner : corners)
    if (const Vec3 unit = corner / scale; out.empty() || !same(unit, out.back())) out.push_back(unit);
  while (out.size() > 1 && same(out.front(), out.back())) out.pop_back();
  return out;
}

}  // namespace

std::size_t FoliageCollector::KeyHash::operator()(const Key& key) const {
  std::size_t hash = std::hash<std::string>()(key.name);
  for (const std::int32_t number : key.numbers) hash = (hash ^ static_cast<std::uint32_t>(number)) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 32;
}

std::uint32_t FoliageCollector::numbered(OrganShape shape) {
  foliage_.shapes.push_back(std::move(shape));
  return static_cast<std::uint32_t>(foliage_.shapes.size() - 1);
}

FoliageCollector::Outcome FoliageCollector::place(const Site& site, std::uint32_t shape, double scale) {
  if (shape == kNoShape || !(scale > 0)) return Outcome::kNothing;
  OrganPlacement& placed = foliage_.organs.emplace_back(site);
  placed.shape = shape;
  placed.scale = scale;
  return Outcome::kAdded;
}

FoliageCollector::Outcome FoliageCollector::add_outline(const Site& site, const std::vector<Vec3>& corners,
                                                        const RunOptions& run) {
  const double scale = reach(corners);
  if (!(scale > 0)) return Outcome::kNothing;
  std::vector<Vec3> outline = normalized_outline(corners, scale);
  Key key;
  key.numbers.reserve(3 * outline.size());
  for (const Vec3& corner : outline) append_rounded(corner, key.numbers);
  const auto [found, is_new] = shapes_.try_emplace(std::move(key), kNoShape);
  if (is_new) {
    auto triangles = triangulated(outline, run);
    if (!triangles) return Outcome::kCancelled;
    if (!triangles->empty())
      found->second = numbered({"polygon" + std::to_string(++outlines_), std::move(outline), std::move(*triangles)});
  }
  return place(site, found->second, scale);
}

FoliageCollector::Outcome FoliageCollector::add_surface(const Site& site, const std::string& name, const Vec3& stretch) {
  const double scale = largest(stretch);
  if (!(scale > 0)) return Outcome::kNothing;
  const auto known = surfaces_.find(name);
  const Vec3 shares = known == surfaces_.end() ? Vec3(1.0) : stretch / scale;  // of the scale
  Key key{name, {}};
  if (shares != Vec3(1.0)) append_rounded(shares, key.numbers);
  const auto [found, is_new] = shapes_.try_emplace(std::move(key), kNoShape);
  if (is_new) {
    OrganShape shape = known == surfaces_.end() ? OrganShape{name, {}, {}} : known->second.shape;
    for (Vec3& vertex : shape.vertices) vertex *= shares;
    found->second = numbered(std::move(shape));
  }
  return place(site, found->second, scale);
}

FoliageCollector::Outcome FoliageCollector::add_round(const Site& site, OrganShape (*make)(), const char* name,
                                                      double diameter) {
  const auto [found, is_new] = shapes_.try_emplace(Key{name, {}}, kNoShape);
  if (is_new) found->second = numbered(make());
  return place(site, found->second, diameter);
}

// Names of surfaces begin with another sign.
FoliageCollector::Outcome FoliageCollector::add_sphere(const Site& site, double diameter) {
  return add_round(site, unit_sphere, "@O", diameter);
}
FoliageCollector::Outcome FoliageCollector::add_disc(const Site& site, double diameter) {
  return add_round(site, unit_disc, "@c", diameter);
}

}  // namespace cambium
