#include "skeletons/axis_frames.h"

#include <algorithm>

namespace cambium {

Vec3 segment_direction(const Axis& axis, std::size_t segment) {
  if (segment + 1 >= axis.nodes.size()) return {0, 0, 1};
  const Vec3 d = axis.nodes[segment + 1].position - axis.nodes[segment].position;
  const double length = glm::length(d);
  return length > 0 ? d / length : Vec3(0, 0, 1);
}

std::vector<Vec3> directions_along(const Axis& axis, const Vec3& first) {
  std::vector<Vec3> directions;
  directions.reserve(std::max<std::size_t>(axis.nodes.size(), 2) - 1);
  directions.push_back(first);
  for (std::size_t i = 1; i + 1 < axis.nodes.size(); ++i)
    directions.push_back(transported(directions.back(), segment_direction(axis, i - 1), segment_direction(axis, i)));
  return directions;
}

std::vector<AxisFrame> frames_of(const AxisTree& tree) {
  std::vector<AxisFrame> frames(tree.axes.size());
  const Laterals laterals(tree);
  for (std::size_t i = 0; i < tree.axes.size(); ++i) {
    const Axis& axis = tree.axes[i];
    if (axis.parent < 0) frames[i].u = across(segment_direction(axis, 0), Vec3(1, 0, 0));
    if (laterals[i].empty()) continue;
    const std::vector<double> lengths = lengths_along(axis);
    const std::vector<Vec3> directions = directions_along(axis, frames[i].u);
    for (const std::uint32_t k : laterals[i]) {
      const AxisPlace attach = tree.axes[k].attach;
      const std::size_t segment = std::min<std::size_t>(attach.segment, directions.size() - 1);
      const double length = segment + 1 < lengths.size() ? lengths[segment + 1] - lengths[segment] : 0;
      frames[k].v = frames[i].v + lengths[segment] + attach.t * length;
      frames[k].u = transported(directions[segment], segment_direction(axis, segment), segment_direction(tree.axes[k], 0));
    }
  }
  return frames;
}

}  // namespace cambium
