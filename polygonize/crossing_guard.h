// Whether triangles that change would cross others, while a mesh changes. Private to polygonize/.
#pragma once

#include "blobtree/float_box.h"
#include "blobtree/run_options.h"

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

  /// `positions` and `run` outlive it and stay. Cancelled, here or in remove(), it is of no use. In the current arena. Cost: n log n.
  CrossingGuard(const std::vector<Vec3>& positions, const std::vector<Corners>& triangles, const RunOptions& run);

  /// Whether any triangle of `fan` would meet another of it, or one that is not in `star`, beyond what they share
  /// (triangle_contact.h, exactly). They are the triangles around a vertex and what fills their outline in their place.
  /// Cost: a search of the tree; exact tests only where the surface near by does not face one way.
  bool crosses(std::span<const std::uint32_t> star, std::span<const Corners> fan);

  void change(std::uint32_t triangle, const Corners& corners);
  void remove(std::uint32_t triangle);

 private:
  struct Slot {                                // what is known of a triangle, beside its neighbours'
    FloatBox box;                              // none: the triangle is gone
    glm::vec3 normal;                          // unit
    std::uint32_t triangle;
    Corners corners;
  };
  FloatBox bounds_of(const Corners& corners) const;
  Vec3 area_of(const Corners& corners) const;
  void build(std::vector<Slot> triangles);
  std::size_t first(std::size_t leaf) const { return (slots_.size() * leaf) >> depth_; }
  template <class Visit>
  void visit(const FloatBox& bounds, Visit&& visit) const;

  const std::vector<Vec3>& positions_;
  const RunOptions run_;
  std::size_t live_ = 0, built_ = 0;           // triangles now, and when the tree was built
  std::vector<FloatBox> nodes_;                // a heap as in box_tree.h
  std::vector<Slot> slots_;                    // in the order of its leaves
  std::vector<std::uint32_t> slot_of_;         // by triangle
  std::size_t leaves_ = 0;                     // two to the power of depth_
  int depth_ = 0;
  std::vector<std::uint32_t> near_, star_;     // scratch: slots
};

}  // namespace cambium
