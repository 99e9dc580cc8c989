#include "lsystem/outline_triangles.h"

#include <cmath>

namespace cambium {
namespace {

using Vec2 = glm::dvec2;

constexpr double kNoArea = 1e-12;  // of outlines of a size about 1: far above rounding, far below what is to be seen
constexpr std::size_t kEarsBetweenPolls = 256;

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

Vec3 newell_normal(const std::vector<Vec3>& outline) {
  Vec3 normal(0.0);
  for (std::size_t i = 0; i < outline.size(); ++i) normal += glm::cross(outline[i], outline[(i + 1) % outline.size()]);
  return normal;
}

/// Of outlines whose areas cancel each other, an eight say: across the widest triangle on the first corner and the one
/// farthest from it.
Vec3 widest_normal(const std::vector<Vec3>& outline) {
  const Vec3 first = outline[0];
  Vec3 far(0.0), normal(0.0);
  for (const Vec3& corner : outline)
    if (glm::length(corner - first) > glm::length(far)) far = corner - first;
  for (const Vec3& corner : outline) {
    const Vec3 candidate = glm::cross(far, corner - first);
    if (glm::length(candidate) > glm::length(normal)) normal = candidate;
  }
  return normal;
}

/// The outline in its plane, counterclockwise where it has an inside at all. Empty if it has no plane.
std::vector<Vec2> flattened(const std::vector<Vec3>& outline) {
  Vec3 normal = newell_normal(outline);
  if (glm::length(normal) <= kNoArea) normal = widest_normal(outline);
  if (glm::length(normal) <= kNoArea) return {};
  normal = glm::normalize(normal);
  const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 u = glm::normalize(glm::cross(axis, normal));
  const Vec3 v = glm::cross(normal, u);
  std::vector<Vec2> flat;
  for (const Vec3& corner : outline) flat.emplace_back(glm::dot(corner, u), glm::dot(corner, v));
  return flat;
}

/// What is left of an outline while its ears are cut off: a ring of corners.
class EarClipping {
 public:
  explicit EarClipping(std::vector<Vec2> flat) : flat_(std::move(flat)), next_(flat_.size()), previous_(flat_.size()) {
    const auto count = static_cast<std::uint32_t>(flat_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
    left_ = count;
  }

  std::optional<OutlineTriangles> clip(const RunOptions& run) {
    std::uint32_t at = 0;
    std::size_t tried = 0;  // corners in a row that are no ears
    for (std::size_t looks = 1; left_ > 2; ++looks) {
      if (looks % kEarsBetweenPolls == 0 && run.cancelled()) return std::nullopt;
      const double turn = turn_at(at);
      // Once around without an ear, edges cross: any corner has to do.
      const bool stuck = tried >= left_;
      if (std::abs(turn) <= kNoArea || stuck || (turn > 0 && !holds_another(at))) {
        if (turn > kNoArea) triangles_.push_back({previous_[at], at, next_[at]});
        at = without(at);
        tried = 0;
      } else {
        at = next_[at];
        ++tried;
      }
    }
    return std::move(triangles_);
  }

 private:
  double turn_at(std::uint32_t i) const { return cross(flat_[i] - flat_[previous_[i]], flat_[next_[i]] - flat_[i]); }

  /// Takes the corner out of the ring; the one before it may be an ear now.
  std::uint32_t without(std::uint32_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    --left_;
    return previous_[i];
  }

  /// Whether another corner lies in the triangle at i. Only corners that turn inwards can.
  bool holds_another(std::uint32_t i) const {
    const Vec2 a = flat_[previous_[i]], b = flat_[i], c = flat_[next_[i]];
    for (std::uint32_t k = next_[next_[i]]; k != previous_[i]; k = next_[k]) {
      const Vec2 p = flat_[k];
      if (p == a || p == b || p == c || turn_at(k) > 0) continue;
      if (cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0) return true;
    }
    return false;
  }

  std::vector<Vec2> flat_;
  std::vector<std::uint32_t> next_, previous_;
  std::uint32_t left_ = 0;
  OutlineTriangles triangles_;
};

}  // namespace

std::optional<OutlineTriangles> triangulated(const std::vector<Vec3>& outline, const RunOptions& run) {
  if (outline.size() < 3) return OutlineTriangles{};
  std::vector<Vec2> flat = flattened(outline);
  if (flat.empty()) return OutlineTriangles{};
  return EarClipping(std::move(flat)).clip(run);
}

}  // namespace cambium
