// Whether triangles that change would cross others, while a mesh changes. Private to polygonize/.
#pragma once

#include "blobtree/geometry.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// A tree of boxes over the triangles, whose boxes grow as these do; built anew when half of them are gone.
class CrossingGuard {
 public:
  using Corners = std::array<std::uint32_t, 3>;

  /// `positions` outlives it and stays. Cost: n log n.
  CrossingGuard(const std::vector<Vec3>& positions, std::vector<Corners> triangles);

  /// Whether any triangle of `fan` would meet another of it, or one that is not in `star`, beyond what they share
  /// (triangle_contact.h, exactly). They are the triangles around a vertex and what fills their outline in their place.
  /// Cost: a search of the tree; exact tests only where the surface near by does not face one way.
  bool crosses(std::span<const std::uint32_t> star, std::span<const Corners> fan);

  void change(std::uint32_t triangle, const Corners& corners);
  void remove(std::uint32_t triangle);

 private:
  struct Bounds {   // floats rounded outwards
    std::array<float, 3> lo, hi;
    bool overlaps(const Bounds& b) const {
      return (lo[0] <= b.hi[0]) & (b.lo[0] <= hi[0]) & (lo[1] <= b.hi[1]) & (b.lo[1] <= hi[1]) & (lo[2] <= b.hi[2]) &
             (b.lo[2] <= hi[2]);
    }
    void join(const Bounds& b);
    bool contains(const Bounds& b) const;
  };
  static const Bounds kNothing;
  Bounds bounds_of(const Corners& corners) const;
  Vec3 area_of(const Corners& corners) const;
  void build();
  template <class Visit>
  void visit(const Bounds& bounds, Visit&& visit) const;

  const std::vector<Vec3>& positions_;
  std::vector<Corners> triangles_;
  std::vector<glm::vec3> normals_;             // unit
  std::vector<std::uint8_t> gone_;
  std::size_t live_ = 0, built_ = 0;           // triangles now, and when the tree was built
  std::vector<Bounds> nodes_, boxes_;          // a heap as in box_tree.h; and by slot
  std::vector<std::uint32_t> order_, slots_;   // triangle by slot, slot by triangle
  std::size_t leaves_ = 0;
  std::vector<std::uint32_t> near_;            // scratch
};

}  // namespace cambium
