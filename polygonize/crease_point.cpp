#include "polygonize/crease_point.h"

#include "polygonize/symmetric_eigen.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr double kAgree = 0.99939;       // cos 2 degrees
constexpr double kOpposite = -0.98481;   // cos 170 degrees

/// One sheet that the point is to lie on: how far ahead it is along its unit normal, by its slope.
struct Sheet {
  double ahead = 0;
  Vec3 normal{0.0};                      ///< towards larger values
};

/// f = level; nothing to go by where the gradient is 0.
bool add_sheet(const Sample& f, double level, std::vector<Sheet>& sheets) {
  const double slope = glm::length(f.gradient);
  if (!(slope > 0) || !std::isfinite(slope)) return false;
  sheets.push_back({(level - f.value) / slope, f.gradient / slope});
  return true;
}

class CreaseSearch {
 public:
  CreaseSearch(ChoiceEvaluator& evaluator, const PrunedField& field, std::span<const Choices> sides, const Box& within,
               std::optional<int> plane)
      : evaluator_(evaluator), field_(field), sides_(sides), within_(within), plane_(plane),
        touching_(ChoiceEvaluator::touching(field, sides)) {
    const Vec3 size = within.size();
    size_ = std::max({size.x, size.y, size.z});
    const Vec3 far = glm::max(glm::abs(within.lo), glm::abs(within.hi));
    rounding_ = 4e-15 * std::max({far.x, far.y, far.z});
  }

  std::optional<CreasePoint> find(Vec3 start) {
    constexpr int kTries = 3;
    for (int turn = 0;; ++turn) {
      outside_.reset();
      const auto found = from(start);
      if (found || !outside_ || turn == kTries - 1) return found;
      start = glm::clamp(*outside_, within_.lo, within_.hi);   // the crease may run through a corner of the box
      if (plane_) start[*plane_] = (*outside_)[*plane_];
      if (glm::length(*outside_ - start) > 0.25 * size_) return std::nullopt;
    }
  }

 private:
  std::optional<CreasePoint> from(const Vec3& start) {
    // Sheets that turn their backs on each other are likely to be about to touch: look for that first. Elsewhere it is the
    // exception, and the sides by themselves mislead only to where no surface is.
    const bool touch = !touching_.children.empty();
    if (touch && face_apart(start)) {
      const auto found = where_children_meet(start);
      return found || outside_ ? found : where_sides_meet(start);
    }
    const auto found = where_sides_meet(start);
    if (!touch || outside_ || (found && !found->cusp)) return found;
    const auto closer = where_children_meet(found ? found->position : start);   // sheets that touch do not tell well where
    return closer ? closer : found;
  }

  struct Met {
    Vec3 point{0.0};
    int rank = 0;                        ///< directions that the sheets determine
  };

  bool all_sides(const Vec3& p, std::vector<Sheet>& sheets) {
    for (const Choices& side : sides_)
      if (!add_sheet(evaluator_.sample_as(field_, side, p), kIso, sheets)) return false;
    return true;
  }

  bool face_apart(const Vec3& p) {
    sheets_.clear();
    if (!all_sides(p, sheets_)) return true;
    for (std::size_t i = 0; i < sheets_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (glm::dot(sheets_[i].normal, sheets_[j].normal) < -0.5) return true;
    return false;
  }

  /// The children at `level`, and the sides that have nothing to do with them; `together_` is the field there.
  bool children_at(double level, const Vec3& p, std::vector<Sheet>& sheets) {
    together_ = evaluator_.sample_children(field_, touching_, p, children_);
    for (const Sample& child : children_)
      if (!add_sheet(child, level, sheets)) return false;
    for (const std::size_t side : touching_.apart)
      if (!add_sheet(evaluator_.sample_as(field_, sides_[side], p), kIso, sheets)) return false;
    return true;
  }

  /// Gauss-Newton with steps of least length: to where all sheets meet, or to the point of least squares.
  template <class SheetsAt>
  std::optional<Met> converge(Vec3 p, SheetsAt&& sheets_at) {
    constexpr int kSteps = 40;
    const Box reach = within_.padded(size_);
    for (int turn = 0; turn < kSteps; ++turn) {
      sheets_.clear();
      if (!sheets_at(p, sheets_)) return std::nullopt;
      Mat3 square(0.0);
      Vec3 pull(0.0);
      for (Sheet sheet : sheets_) {
        if (plane_) sheet.normal[*plane_] = 0;
        square += glm::outerProduct(sheet.normal, sheet.normal);
        pull += sheet.ahead * sheet.normal;
      }
      Vec3 strength;
      Mat3 axes;
      symmetric_eigen(square, strength, axes);
      const double strongest = std::max({strength.x, strength.y, strength.z});
      if (!(strongest > 1e-6)) return std::nullopt;   // all of them parallel to the plane
      Vec3 step(0.0);
      for (int a = 0; a < 3; ++a) {
        if (strength[a] < 1e-6 * strongest) continue;   // sheets at a tenth of a degree are one
        step += glm::dot(axes[a], pull) / strength[a] * axes[a];
      }
      if (plane_) step[*plane_] = 0;
      const double length = glm::length(step), most = 0.5 * size_;
      if (length > most) step *= most / length;
      p += step;
      if (!reach.contains(p)) return std::nullopt;
      if (length < 1e-12 * size_ + rounding_) return Met{p, directions()};
    }
    return std::nullopt;
  }

  /// How many directions the last sheets determine, to 2 degrees.
  int directions() const {
    Mat3 square(0.0);
    for (const Sheet& sheet : sheets_) square += glm::outerProduct(sheet.normal, sheet.normal);
    Vec3 strength;
    Mat3 axes;
    symmetric_eigen(square, strength, axes);
    const double enough = 3e-4 * std::max({strength.x, strength.y, strength.z});
    return (strength.x > enough ? 1 : 0) + (strength.y > enough ? 1 : 0) + (strength.z > enough ? 1 : 0);
  }

  std::optional<CreasePoint> where_sides_meet(const Vec3& start) {
    const auto met = converge(start, [this](const Vec3& p, std::vector<Sheet>& sheets) { return all_sides(p, sheets); });
    return met ? crease_at(*met) : std::nullopt;
  }

  std::optional<Met> children_meet(const Vec3& start, double level) {
    return converge(start, [&](const Vec3& p, std::vector<Sheet>& sheets) { return children_at(level, p, sheets); });
  }

  /// Along the way on which the children stay equal the field falls from inside to outside: at kIso if nothing adds to the contact
  /// and its lip is below 2, else at a lower level; the closer to kIso, the sharper the angle of the sheets.
  std::optional<CreasePoint> where_children_meet(const Vec3& start) {
    const std::optional<Met> touching = children_meet(start, kIso);
    if (!touching || together_ < kIso - 1e-6) return std::nullopt;
    const bool pure = pure_contact();
    const std::optional<CreasePoint> cusp = pure ? crease_at(*touching) : std::nullopt;
    double inside = kIso, outside = kIso - 1e-4;
    std::optional<Met> met = touching;
    for (;;) {
      met = children_meet(met->point, outside);
      if (!met) return cusp;
      if (together_ < kIso) break;
      inside = outside;
      outside = kIso - 3 * (kIso - outside);
      if (outside < 0.1) return std::nullopt;
    }
    if (pure && inside == kIso) return cusp;   // else it was a pocket of no width: the lip is above 2
    outside_.reset();
    for (int turn = 0; turn < 40; ++turn) {
      if (turn == 0 || turn == 8) {   // close enough for the sides themselves, if they have an angle
        const auto found = where_sides_meet(met->point);
        if (found || outside_) return found;
      }
      const double level = 0.5 * (inside + outside);
      met = children_meet(met->point, level);
      if (!met) return std::nullopt;
      (together_ > kIso ? inside : outside) = level;
    }
    return crease_at(*met);
  }

  /// With the children at kIso: nothing adds to what they make.
  bool pure_contact() const {
    double slope = 0;
    for (const Sample& child : children_) slope = std::max(slope, glm::length(child.gradient));
    return std::abs(together_ - kIso) < 1e-11 + 8 * rounding_ * slope;
  }

  std::optional<CreasePoint> crease_at(const Met& met) {
    CreasePoint found;
    found.position = glm::clamp(met.point, within_.lo, within_.hi);
    double slope = 0;
    bool agree = true;
    for (const Choices& side : sides_) {
      const Sample sheet = evaluator_.sample_as(field_, side, met.point);
      const double steep = glm::length(sheet.gradient);
      if (!(steep > 0)) return std::nullopt;
      slope = std::max(slope, steep);
      found.miss = std::max(found.miss, std::abs(sheet.value - kIso) / steep);
      const Vec3 normal = sheet.gradient / -steep;
      for (const Vec3& other : found.normals) {
        const double turn = glm::dot(normal, other);
        agree = agree && turn > kAgree;
        found.cusp = found.cusp || turn < kOpposite;
      }
      found.normals.push_back(normal);
    }
    // Where the sheets are as good as one it does not matter much.
    const double nearly = (agree ? 1e-3 : 1e-10) * size_ + 8 * rounding_;
    if (found.miss > nearly && sides_.size() <= 3) return std::nullopt;
    if (found.miss <= nearly && std::abs(evaluator_.choose(field_, met.point, own_) - kIso) > nearly * slope) return std::nullopt;
    if (!within_.padded(1e-9 * size_).contains(met.point)) {
      outside_ = met.point;
      return std::nullopt;
    }
    found.kind = agree ? CreaseKind::kNone : met.rank >= 3 ? CreaseKind::kCorner : CreaseKind::kCurve;
    return found;
  }

  ChoiceEvaluator& evaluator_;
  const PrunedField& field_;
  std::span<const Choices> sides_;
  const Box& within_;
  std::optional<int> plane_;
  ChoiceEvaluator::Touching touching_;
  double size_ = 0, rounding_ = 0;       ///< metres: of within, and of what is computed so far from the origin
  Choices own_;
  std::vector<Sheet> sheets_;
  std::vector<Sample> children_;
  double together_ = 0;
  std::optional<Vec3> outside_;           ///< where sheets met last, but not within
};

}  // namespace

std::optional<CreasePoint> find_crease(ChoiceEvaluator& evaluator, const PrunedField& field, std::span<const Choices> sides,
                                       const Vec3& start, const Box& within, std::optional<int> plane) {
  if (field.empty() || sides.empty()) return std::nullopt;
  return CreaseSearch(evaluator, field, sides, within, plane).find(start);
}

}  // namespace cambium
