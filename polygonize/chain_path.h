// A chain as a way through space: points, radii and the swept surface around it by length along it. Private to polygonize/.
#pragma once

#include "blobtree/nodes.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

/// A piece of a way, metres along it.
struct Stretch {
  double begin = 0, end = 0;
  bool empty() const { return !(begin < end); }
};

/// Of one segment, metres from its first node: all from which its swept surface reaches into the box, and not much more.
std::optional<Stretch> reaching(const ChainNode& from, const ChainNode& to, const Box& box);

class ChainPath {
 public:
  /// Of at least two nodes, which outlive it.
  explicit ChainPath(std::span<const ChainNode> nodes);

  std::size_t segment_count() const { return nodes_.size() - 1; }
  std::span<const ChainNode> nodes() const { return nodes_; }
  double length() const { return at_.back(); }
  double node_at(std::size_t node) const { return at_[node]; }
  /// Unit; of a segment without length, its neighbour's.
  const Vec3& direction(std::size_t segment) const { return directions_[segment]; }
  /// The segment that holds s; at a node the one after it.
  std::size_t segment_at(double s) const;
  Vec3 point(double s) const;
  double radius(double s) const;
  /// Of a ring's plane at s: along the segment, or halfway between two where they meet.
  Vec3 tangent(double s) const;
  /// Where the axis is nearest to p, among the segments first to last.
  double nearest(const Vec3& p, std::size_t first, std::size_t last) const;

  /// Holds all of those segments' parts from which the swept surface reaches into the box, and not much more; none if none does.
  std::optional<Stretch> reaching(const Box& box, std::size_t first, std::size_t last) const;

  struct SurfacePoint {
    Vec3 position{0.0}, normal{0.0};
  };
  /// Where a ray from the axis at s, along a unit vector, leaves the swept surface of what is within a few radii of s.
  SurfacePoint surface(double s, const Vec3& direction) const;
  /// How far p is outside of that surface, metres; negative inside, to first order.
  double distance(double s, const Vec3& p) const;
  /// How far a triangle near s is from that surface either way: at its middle and the middles of its sides, metres.
  double distance_of(const Vec3& a, const Vec3& b, const Vec3& c, double s) const;

 private:
  struct Segments {
    std::size_t first = 0, last = 0;
  };
  Segments near(double s) const;
  struct Ratio {
    double value = 0, radius = 0;
    Vec3 away{0.0};
  };
  Ratio swept_ratio(const Segments& segments, const Vec3& p) const;

  std::span<const ChainNode> nodes_;
  std::vector<double> at_;
  std::vector<Vec3> directions_;
};

}  // namespace cambium
