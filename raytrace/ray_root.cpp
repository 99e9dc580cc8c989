#include "raytrace/ray_root.h"

#include <array>
#include <cmath>

namespace cambium {
namespace {

constexpr double kToleranceRadii = 1e-6;
constexpr double kBlindRadii = 0.02;   // where a bend leaves slopes unknown (opposite its arc), a stretch so short is settled by its ends

/// Where the field is known on a ray.
struct Known {
  double t = 0, f = 0;
};

/// The most that f can be between two places, by what it is there and by its slopes between: the top of a tent.
double highest_between(const Known& from, const Known& to, const Course& course) {
  const double rise = course.slope.hi, fall = -course.slope.lo;
  if (!(rise > 0)) return from.f;
  if (!(fall > 0)) return to.f;
  if (!(rise + fall < kInfinity)) return course.value.hi;
  return (from.f * fall + to.f * rise + rise * fall * (to.t - from.t)) / (rise + fall);
}

class RootSearch {
 public:
  RootSearch(Evaluator& evaluator, const PrunedField& field, const Ray& ray)
      : evaluator_(evaluator), field_(field), ray_(ray), radius_(radius_in(field)), tolerance_(kToleranceRadii * radius_) {}

  /// Halves the way until what is nearest is empty or holds one root. What lies farther waits on a stack.
  std::optional<double> find(const RaySegment& segment, PlaceWanted wanted) {
    Course course = course_between(segment.begin, segment.end);
    if (course.value.hi < kIso) return std::nullopt;
    Known from = known(segment.begin);
    if (from.f >= kIso) return from.t;
    waiting_[0] = known(segment.end);
    std::size_t count = 1;
    for (;;) {
      const Known to = waiting_[count - 1];
      const double middle = 0.5 * (from.t + to.t);
      const bool blind = !(course.slope.hi - course.slope.lo < kInfinity);
      const bool shortest = to.t - from.t <= (blind && to.f < kIso ? kBlindRadii * radius_ : tolerance_) || !(middle > from.t && middle < to.t) || count == waiting_.size();
      if (to.f >= kIso) {
        if (shortest || wanted == PlaceWanted::kAny) return to.t;
        if (course.slope.lo > 0) return only_root(from, to, course.slope.lo);
      } else if (shortest || course.value.hi < kIso || highest_between(from, to, course) < kIso) {
        from = to;
        if (--count == 0) return std::nullopt;
        course = course_between(from.t, waiting_[count - 1].t);
        continue;
      }
      const Known at_middle = known(middle);
      if (at_middle.f >= kIso) count = 0;   // what is beyond does not matter any more
      waiting_[count++] = at_middle;
      course = course_between(from.t, middle);
    }
  }

 private:
  Known known(double t) { return {t, evaluator_.value(field_, ray_.at(t))}; }
  Course course_between(double begin, double end) {
    return evaluator_.course(field_, ray_.at(0.5 * (begin + end)), ray_.direction, 0.5 * (end - begin));
  }

  /// Newton kept inside a bracket in which f rises throughout, by `slope_lo` a metre at least.
  double only_root(Known outside, Known inside, double slope_lo) {
    double t = outside.t + (inside.t - outside.t) * (kIso - outside.f) / (inside.f - outside.f);
    for (int iteration = 0; iteration < 60; ++iteration) {
      const Sample sample = evaluator_.sample(field_, ray_.at(t));
      const double missing = kIso - sample.value;
      if (std::abs(missing) <= 0.5 * tolerance_ * slope_lo) return t;
      (missing > 0 ? outside : inside) = {t, sample.value};
      if (inside.t - outside.t <= tolerance_) return inside.t;
      const double slope = glm::dot(sample.gradient, ray_.direction);
      const double next = t + missing / slope;
      if (slope > 0 && std::abs(next - t) < 1e-3 * tolerance_) return next;   // converged, whatever the least slope is
      t = slope > 0 && next > outside.t && next < inside.t ? next : 0.5 * (outside.t + inside.t);
    }
    return inside.t;
  }

  static constexpr std::size_t kDeepest = 64;
  Evaluator& evaluator_;
  const PrunedField& field_;
  const Ray& ray_;
  double radius_, tolerance_;
  std::array<Known, kDeepest> waiting_;
};

}  // namespace

double radius_in(const PrunedField& field) {
  return field.smallest_radius() < kInfinity ? field.smallest_radius() : glm::length(field.box().size());
}

std::optional<double> first_root(Evaluator& evaluator, const PrunedField& field, const Ray& ray, const RaySegment& segment) {
  return RootSearch(evaluator, field, ray).find(segment, PlaceWanted::kFirst);
}

bool any_inside(Evaluator& evaluator, const PrunedField& field, const Ray& ray, const RaySegment& segment) {
  return RootSearch(evaluator, field, ray).find(segment, PlaceWanted::kAny).has_value();
}

}  // namespace cambium
