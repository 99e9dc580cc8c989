// Whether triangles that change would cross others, while a mesh changes. Private to polygonize/.
#pragma once

#include "blobtree/float_box.h"

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
  FloatBox bounds_of(const Corners& corners) const;
  Vec3 area_of(const Corners& corners) const;
  void build();
  template <class Visit>
  void visit(const FloatBox& bounds, Visit&& visit) const;

  const std::vector<Vec3>& positions_;
  std::vector<Corners> triangles_;
  std::vector<glm::vec3> normals_;             // unit
  std::vector<std::uint8_t> gone_;
  std::size_t live_ = 0, built_ = 0;           // triangles now, and when the tree was built
  std::vector<FloatBox> nodes_, boxes_;        // a heap as in box_tree.h; and by slot
  std::vector<std::uint32_t> order_, slots_;   // triangle by slot, slot by triangle
  std::size_t leaves_ = 0;
  std::vector<std::uint32_t> near_;            // scratch
};

}  // namespace cambium
