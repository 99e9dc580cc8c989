// Points on creases: where the surface takes a choice on one side and another on the other (blobtree/choices.h).
#pragma once

#include "blobtree/choices.h"

#include <optional>
#include <span>

namespace cambium {

enum class CreaseKind {
  kNone,      ///< the sides agree there: the surface is smooth
  kCurve,     ///< two smooth sheets meet
  kCorner     ///< three or more
};

struct CreasePoint {
  CreaseKind kind = CreaseKind::kNone;
  Vec3 position{0.0};
  std::vector<Vec3> normals;      ///< outward, unit, of each side there, in the order given
};

/// The crease between `sides` nearest to `start` (least-norm Newton steps on {f_side = kIso for all sides}; where two sheets
/// touch without an angle, as contact ridges with a small lip do, on {f_i = f_j = kIso} of the children that meet).
/// `plane`, if set, keeps the point in the axis-aligned plane p[axis] = start[axis] (axis 0 to 2).
/// nullopt where it does not converge inside `within`. Position: to 1e-9 of within's size.
std::optional<CreasePoint> find_crease(ChoiceEvaluator& evaluator, const PrunedField& field, std::span<const Choices> sides,
                                       const Vec3& start, const Box& within, std::optional<int> plane = std::nullopt);

}  // namespace cambium
