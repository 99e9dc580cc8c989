#include "skeletons/graph/graph_volume.h"

#include "blobtree/input_error.h"
#include "skeletons/graph/spread_places.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

/// The rotation that takes unit z to unit `axis` the shortest way; about x where it is -z.
Mat3 turn_to(const Vec3& axis) {
  const Vec3 z = glm::normalize(axis);
  const double lean2 = z.x * z.x + z.y * z.y;
  if (z.z < 0 && !(lean2 > 1e-300)) return Mat3(Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1});
  const double k = z.z < 0 ? (1 - z.z) / lean2 : 1 / (1 + z.z);   // both are the same, but for digits
  return Mat3(Vec3{1 - k * z.x * z.x, -k * z.x * z.y, -z.x}, Vec3{-k * z.x * z.y, 1 - k * z.y * z.y, -z.y}, z);
}

Box turned(const Box& box, const Mat3& to_world, double scale, const Vec3& origin) {
  const Vec3 middle = origin + scale * (to_world * box.center());
  Vec3 half{0.0};
  for (int i = 0; i < 3; ++i) half += glm::abs(to_world[i]) * (0.5 * scale * box.size()[i]);
  return {middle - half, middle + half};
}

/// The same, if it can be placed.
const PlacedSolid& sound(const PlacedSolid& placed) {
  validate(placed.solid);
  if (!(placed.scale > 0) || !std::isfinite(placed.scale))
    throw InputError({}, "scale = " + std::to_string(placed.scale), "a finite scale above 0");
  const double length = glm::length(placed.axis);
  if (!(length > 0) || !std::isfinite(length)) throw InputError({}, "an axis without a direction", "an axis that is not 0");
  if (!std::isfinite(glm::dot(placed.origin, placed.origin))) throw InputError({}, "an origin that is not finite", "a finite origin");
  return placed;
}

std::vector<SolidFrame> frames_of(const std::vector<PlacedSolid>& solids) {
  std::vector<SolidFrame> frames;
  frames.reserve(solids.size());
  for (const PlacedSolid& placed : solids) frames.emplace_back(placed);
  return frames;
}

}  // namespace

SolidFrame::SolidFrame(const PlacedSolid& placed)
    : origin_(sound(placed).origin), scale_(placed.scale), solid_(placed.solid) {
  const Mat3 to_world = turn_to(placed.axis);
  to_local_ = glm::transpose(to_world) / scale_;
  const Box box = turned(bounds(placed.solid), to_world, scale_, origin_);
  world_ = box.padded(1e-12 * glm::length(box.size()));
}

bool SolidFrame::meets(const Vec3& a, const Vec3& b) const {
  Box way;
  way.extend(a), way.extend(b);
  return world_.intersects(way) && solid_.meets(local(a), local(b));
}

Obstacles::Obstacles(const std::vector<PlacedSolid>& solids, std::vector<HalfSpaceObstacle> half_spaces)
    : solids_(frames_of(solids)), half_spaces_(std::move(half_spaces)) {
  for (HalfSpaceObstacle& half : half_spaces_) {
    const double length = glm::length(half.normal);
    if (!(length > 0) || !std::isfinite(length)) throw InputError({}, "a normal without a direction", "a normal that is not 0");
    half.normal /= length;
  }
}

bool Obstacles::holds(const Vec3& p) const {
  for (const HalfSpaceObstacle& half : half_spaces_)
    if (glm::dot(p - half.point, half.normal) < 0) return true;
  return std::any_of(solids_.begin(), solids_.end(), [&](const SolidFrame& solid) { return solid.contains(p); });
}

bool Obstacles::crossed(const Vec3& a, const Vec3& b) const {
  for (const HalfSpaceObstacle& half : half_spaces_)   // it is straight: if neither end is beyond, nothing is
    if (glm::dot(a - half.point, half.normal) < 0 || glm::dot(b - half.point, half.normal) < 0) return true;
  return std::any_of(solids_.begin(), solids_.end(), [&](const SolidFrame& solid) { return solid.meets(a, b); });
}

GraphVolume::GraphVolume(std::vector<PlacedSolid> solids, std::shared_ptr<const Obstacles> obstacles)
    : solids_(std::move(solids)), frames_(frames_of(solids_)), obstacles_(std::move(obstacles)) {
  if (solids_.empty()) throw InputError({}, "no volume", "at least one");
  for (const SolidFrame& frame : frames_) bounds_.extend(frame.world());
  for (const PlacedSolid& placed : solids_) parts_ = std::max<std::size_t>(parts_, placed.part + std::size_t{1});
}

bool GraphVolume::contains(const Vec3& p) const {
  for (const SolidFrame& frame : frames_)
    if (frame.contains(p)) return !blocked(p);
  return false;
}

bool GraphVolume::bears_endpoints(const Vec3& p) const {
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (solids_[i].endpoints && frames_[i].contains(p)) return !blocked(p);
  return false;
}

double GraphVolume::depth(const Vec3& p) const {
  double deepest = 0;
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (solids_[i].endpoints && frames_[i].contains(p)) deepest = std::max(deepest, frames_[i].depth(p));
  return deepest;
}

std::uint16_t GraphVolume::part_of(const Vec3& p) const {
  if (parts_ == 1) return 0;
  double most = -1;
  std::uint16_t part = 0;
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    if (!frames_[i].contains(p)) continue;
    const double middleness = frames_[i].middleness(p);
    if (middleness > most) most = middleness, part = solids_[i].part;
  }
  return part;
}

double GraphVolume::volume() const {
  constexpr std::size_t kPlaces = std::size_t{1} << 18;
  std::size_t inside = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) inside += contains(bounds_.lo + bounds_.size() * spread_place(i));
  const Vec3 size = bounds_.size();
  return size.x * size.y * size.z * static_cast<double>(inside) / kPlaces;
}

}  // namespace cambium
