// Points on creases: where the surface takes a choice on one side and another on the other (blobtree/choices.h).
#pragma once

#include "blobtree/choices.h"

#include <optional>
#include <span>
#include <vector>

namespace cambium {

enum class CreaseKind {
  kNone,      ///< the sides agree there, to 2 degrees: the surface is smooth
  kCurve,     ///< smooth sheets meet along a curve through this point
  kCorner     ///< they meet in this point alone
};

struct CreasePoint {
  CreaseKind kind = CreaseKind::kNone;
  Vec3 position{0.0};
  std::vector<Vec3> normals;      ///< outward, unit, of each side there, in the order given
  bool cusp = false;              ///< two of the normals are opposite to 10 degrees: the sheets close up without an angle
  double miss = 0;                ///< metres, of the farthest side's sheet: 0 but for rounding unless there are more than three sides
};

/// The crease between `sides` nearest to `start`: least-norm Newton steps on {f_side = kIso for all sides}. Where two sheets touch
/// without an angle, as contact ridges with a lip below 2 do, that is singular, and it is {f_k = m} for the children k that
/// meet, with the m (kIso, if nothing else adds to the contact) that puts the point on the surface.
/// `plane`, if set, keeps the point in the axis-aligned plane p[axis] = start[axis] (axis 0 to 2).
/// nullopt where that does not converge inside `within`, or where another choice hides the crease there; more than three sides need
/// not meet, and then it is the point of least squares. Position: to 1e-9 of within's size where the sheets have an angle or
/// a contact is alone, to 1e-5 of it where a cusp is only just opened by a blend; with several creases in reach it may be another
/// than the nearest. Where the sides agree it is a point of the surface, to 1e-3 of that size. Sides are of this field's tape
/// (errors: std::invalid_argument).
std::optional<CreasePoint> find_crease(ChoiceEvaluator& evaluator, const PrunedField& field, std::span<const Choices> sides,
                                       const Vec3& start, const Box& within, std::optional<int> plane = std::nullopt);

}  // namespace cambium
