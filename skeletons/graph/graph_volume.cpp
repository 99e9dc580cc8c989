#include "skeletons/graph/graph_volume.h"

#include "blobtree/input_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cambium {
namespace {

/// The rotation that takes unit z to unit `axis` the shortest way; about x where it is -z.
Mat3 turn_to(const Vec3& axis) {
  const Vec3 z = glm::normalize(axis);
  if (z.z < -1 + 1e-12) return Mat3(Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, -1});
  const double k = 1 / (1 + z.z);
  return Mat3(Vec3{1 - k * z.x * z.x, -k * z.x * z.y, -z.x}, Vec3{-k * z.x * z.y, 1 - k * z.y * z.y, -z.y}, z);
}

Box turned(const Box& box, const Mat3& to_world, double scale, const Vec3& origin) {
  const Vec3 middle = origin + scale * (to_world * box.center());
  Vec3 half{0.0};
  for (int i = 0; i < 3; ++i) half += glm::abs(to_world[i]) * (0.5 * scale * box.size()[i]);
  return {middle - half, middle + half};
}

void validate_placement(const PlacedSolid& placed) {
  validate(placed.solid);
  if (!(placed.scale > 0) || !std::isfinite(placed.scale))
    throw InputError({}, "scale = " + std::to_string(placed.scale), "a finite scale above 0");
  const double length = glm::length(placed.axis);
  if (!(length > 0) || !std::isfinite(length)) throw InputError({}, "an axis without a direction", "an axis that is not 0");
  if (!std::isfinite(glm::dot(placed.origin, placed.origin))) throw InputError({}, "an origin that is not finite", "a finite origin");
}

std::vector<SolidFrame> frames_of(const std::vector<PlacedSolid>& solids) {
  std::vector<SolidFrame> frames;
  for (const PlacedSolid& placed : solids) validate_placement(placed), frames.emplace_back(placed);
  return frames;
}

bool holds_place(const PlacedSolid& placed, const SolidFrame& frame, const Vec3& p) {
  return frame.world.contains(p) && contains(placed.solid, frame.local(p));
}

/// The i-th place of the additive sequence in three dimensions (Roberts 2018), in the unit cube.
Vec3 spread_place(std::size_t i) {
  constexpr double kStep[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019702};
  Vec3 p;
  for (int k = 0; k < 3; ++k) p[k] = 0.5 + kStep[k] * static_cast<double>(i), p[k] -= std::floor(p[k]);
  return p;
}

}  // namespace

SolidFrame::SolidFrame(const PlacedSolid& placed) : origin(placed.origin), scale(placed.scale) {
  const Mat3 to_world = turn_to(placed.axis);
  to_local = glm::transpose(to_world);
  const Box box = turned(bounds(placed.solid), to_world, scale, origin);
  world = box.padded(1e-12 * glm::length(box.size()));
}

Obstacles::Obstacles(std::vector<PlacedSolid> solids, std::vector<HalfSpaceObstacle> half_spaces)
    : solids_(std::move(solids)), frames_(frames_of(solids_)), half_spaces_(std::move(half_spaces)) {
  for (HalfSpaceObstacle& half : half_spaces_) {
    const double length = glm::length(half.normal);
    if (!(length > 0) || !std::isfinite(length)) throw InputError({}, "a normal without a direction", "a normal that is not 0");
    half.normal /= length;
  }
}

bool Obstacles::holds(const Vec3& p) const {
  for (const HalfSpaceObstacle& half : half_spaces_)
    if (glm::dot(p - half.point, half.normal) < 0) return true;
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (holds_place(solids_[i], frames_[i], p)) return true;
  return false;
}

bool Obstacles::crossed(const Vec3& a, const Vec3& b) const {
  constexpr int kSteps = 8;
  for (int i = 0; i <= kSteps; ++i)
    if (holds(glm::mix(a, b, i / double(kSteps)))) return true;
  return false;
}

GraphVolume::GraphVolume(std::vector<PlacedSolid> solids, std::shared_ptr<const Obstacles> obstacles)
    : solids_(std::move(solids)), frames_(frames_of(solids_)), obstacles_(std::move(obstacles)) {
  if (solids_.empty()) throw InputError({}, "no volume", "at least one");
  for (const SolidFrame& frame : frames_) bounds_.extend(frame.world);
  for (const PlacedSolid& placed : solids_) parts_ = std::max<std::size_t>(parts_, placed.part + std::size_t{1});
}

bool GraphVolume::contains(const Vec3& p) const {
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (holds_place(solids_[i], frames_[i], p)) return !blocked(p);
  return false;
}

bool GraphVolume::bears_endpoints(const Vec3& p) const {
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (solids_[i].endpoints && holds_place(solids_[i], frames_[i], p)) return !blocked(p);
  return false;
}

double GraphVolume::depth(const Vec3& p) const {
  double deepest = 0;
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (solids_[i].endpoints && holds_place(solids_[i], frames_[i], p))
      deepest = std::max(deepest, frames_[i].scale * cambium::depth(solids_[i].solid, frames_[i].local(p)));
  return deepest;
}

std::uint16_t GraphVolume::part_of(const Vec3& p) const {
  double deepest = -1;
  std::uint16_t part = 0;
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    if (!holds_place(solids_[i], frames_[i], p)) continue;
    const double d = frames_[i].scale * cambium::depth(solids_[i].solid, frames_[i].local(p));
    if (d > deepest) deepest = d, part = solids_[i].part;
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
