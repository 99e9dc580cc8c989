#include "skeletons/foliage_follow.h"

namespace cambium {
namespace {

/// The smallest turn that takes one unit vector to another.
class Turn {
 public:
  Turn(const Vec3& from, const Vec3& to) : axis_(glm::cross(from, to)), cosine_(glm::dot(from, to)) {}

  /// Rodrigues' rotation. Directions that are nearly opposite have no smallest turn between them: then none.
  Vec3 operator()(const Vec3& v) const {
    if (cosine_ < -0.999999) return v;
    return cosine_ * v + glm::cross(axis_, v) + axis_ * (glm::dot(axis_, v) / (1 + cosine_));
  }

 private:
  Vec3 axis_;   // as long as the sine
  double cosine_;
};

OrganPlacement carried_along(OrganPlacement organ, const Vec3& node, const AxisRider& rider, const Axis& axis) {
  const Turn turn(rider.tangent, tangent_at(axis, rider.place));
  organ.position = position_at(axis, rider.place) + rider.offset + turn(organ.position - node);
  organ.left = turn(organ.left);
  organ.heading = turn(organ.heading);
  organ.up = turn(organ.up);
  return organ;
}

}  // namespace

std::vector<std::int32_t> nodes_ridden(const Foliage& foliage) {
  std::vector<std::int32_t> nodes;
  nodes.reserve(foliage.organs.size());
  for (const OrganPlacement& organ : foliage.organs) nodes.push_back(organ.node);
  return nodes;
}

void follow_wood(const Foliage& foliage, const Skeleton& before, const AxisTree& after, Surfaced& made) {
  made.foliage.shapes = foliage.shapes;
  made.foliage.organs.reserve(foliage.organs.size());
  for (std::size_t i = 0; i < foliage.organs.size(); ++i) {
    const OrganPlacement& organ = foliage.organs[i];
    const AxisRider& rider = after.riders[i];
    if (organ.node < 0) {
      made.foliage.organs.push_back(organ);
      made.organ_branches.push_back(0);
    } else if (rider.axis < 0) {
      ++made.report.organs_pruned;
    } else {
      const Axis& axis = after.axes[rider.axis];
      made.foliage.organs.push_back(carried_along(organ, before.nodes[organ.node].position, rider, axis));
      made.organ_branches.push_back(axis.branch);
    }
  }
}

}  // namespace cambium
