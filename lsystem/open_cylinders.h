// Generalized cylinders under way, as brackets nest them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lsystem/generalized_cylinder.h"
#include "lsystem/skeleton_pen.h"

namespace cambium {

struct OpenCylinder {
  GeneralizedCylinder axis;
  SkeletonPen::Place pen;
  std::size_t depth = 0;          ///< in brackets
  bool steps_are_points = false;  ///< F and f end in control points
};

/// At most one is open at each depth of brackets; in deeper ones the turtle is in it too, until they have one of their own.
class OpenCylinders {
 public:
  /// The one that the turtle is in, which it saves and restores at brackets.
  using Number = std::int32_t;
  static constexpr Number kNone = -1;

  OpenCylinder& operator[](Number number) { return open_[static_cast<std::size_t>(number)]; }
  const OpenCylinder& operator[](Number number) const { return open_[static_cast<std::size_t>(number)]; }

  /// Whether the wood at `depth` is the cylinder's. What is drawn in brackets inside of @Gs and @Ge is a branch like others,
  /// until it has a control point of its own.
  bool hold(Number number, std::size_t depth) const {
    return number != kNone && (open_[static_cast<std::size_t>(number)].steps_are_points || is_at(number, depth));
  }
  /// Begins one, in place of one that is open at its depth.
  Number open(OpenCylinder cylinder, Number present);
  /// `number` if it is at this depth, else a copy that goes on from it as its lateral.
  Number branch(Number number, std::size_t depth);
  void close(Number number) { shrink(static_cast<std::size_t>(number)); }

  std::size_t size() const { return open_.size(); }
  /// Closes those that were opened since there were `size`.
  void shrink(std::size_t size) { open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(size), open_.end()); }

 private:
  bool is_at(Number number, std::size_t depth) const { return open_[static_cast<std::size_t>(number)].depth == depth; }
  Number append(OpenCylinder cylinder);

  std::vector<OpenCylinder> open_;
};

}  // namespace cambium
