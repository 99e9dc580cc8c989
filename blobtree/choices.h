// Where a field is not smooth: the operators that take the larger or smaller of their children, and which child each of them
// takes at a point. Between points of different choices lies a crease.
#pragma once

#include "blobtree/field.h"

#include <cstdint>
#include <span>
#include <vector>

namespace cambium {

/// The winner of every union, intersection, difference, contact and fork of a tape at one point, in tape order. Of a contact or
/// a fork's contact it is the child with the largest value. An operator whose runner-up makes no difference at the point (it is
/// beyond the contact's width, say) still has a winner: two choices may differ and the field be smooth between them.
struct Choices {
  std::vector<std::uint8_t> winners;
  bool operator==(const Choices&) const = default;
};

/// Scratch, one per thread; the Evaluator's fields and the same values to the last bit.
class ChoiceEvaluator {
 public:
  ChoiceEvaluator();
  ~ChoiceEvaluator();
  ChoiceEvaluator(const ChoiceEvaluator&) = delete;
  ChoiceEvaluator& operator=(const ChoiceEvaluator&) = delete;

  /// No operator of this field chooses: it is smooth wherever falloffs are.
  static bool smooth(const PrunedField& field);
  /// The value, and what was chosen.
  double choose(const PrunedField& field, const Vec3& p, Choices& out);
  /// The field as it would be if every operator took the given winners: smooth across the crease.
  /// Where `choices` are those of p it is the field.
  Sample sample_as(const PrunedField& field, const Choices& choices, const Vec3& p);

  struct Scratch;  ///< private to blobtree/

 private:
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace cambium
