// Where a field is not smooth: the operators that take the larger or smaller of their children, and which child each of them
// takes at a point. Between points of different choices lies a crease.
#pragma once

#include "blobtree/field.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace cambium {

/// What every union, intersection, difference, contact and fork of a tape takes at one point, in tape order.
///   union, intersection   the child
///   difference            0 the first, k the k-th active one taken away, or the cap 2 kIso after them
///   contact               the child that leads: the others push it. It is the one with the largest value, but for lips near 4
///                         where the next one may rise above it. Of three or more children also which of the others pushes
///   fork                  the same of its laterals, then whether the axis (0) or the laterals (1) lead
/// An operator that a child is left out of because it is 0 has that child after its active ones.
/// Where the runner-up of a contact makes no difference (it is beyond the contact's width, say) there still is one, and so with
/// the axis of a fork where all melts into it: two choices may differ and the field be smooth between them.
/// They speak of one tape: those of two fields, or of cells that do not share their tape, cannot be compared.
struct Choices {
  std::vector<std::uint32_t> winners;
  bool operator==(const Choices&) const = default;

  /// Of an operator below a child that was not taken.
  static constexpr std::uint32_t kDoesNotMatter = 0xffffffffu;
  /// Added to the leader of a contact where the next child is inside its own solid too: there nothing pushes. Such points are
  /// inside wherever the contact by itself makes the surface. By no more than kHardlyInside it is taken for outside: points found
  /// on the surface in floating point, where two sheets close up, are then of one of the two.
  static constexpr std::uint32_t kBothInside = 0x80000000u;
  static constexpr double kHardlyInside = 1e-6;
};

/// Scratch, one per thread; the Evaluator's fields and the same values to the last bit.
/// Not counted as choices: the nearest segment of a chain (its kink lies at a concave bend, where segments of equal distance
/// meet), the ends of a half-space's ramp, and the signs that a ricci or a fork looks at, which only matter to dents.
class ChoiceEvaluator {
 public:
  ChoiceEvaluator();
  ~ChoiceEvaluator();
  ChoiceEvaluator(const ChoiceEvaluator&) = delete;
  ChoiceEvaluator& operator=(const ChoiceEvaluator&) = delete;

  /// No operator of this field chooses: it is smooth wherever falloffs are.
  static bool smooth(const PrunedField& field);
  /// The value, and what was chosen. Cost: a little above that of Evaluator::value().
  double choose(const PrunedField& field, const Vec3& p, Choices& out);
  /// The field as it would be if every operator took the given winners: smooth across the crease. A contact is
  /// leader + D(the other) everywhere, or the leader alone where both were inside.
  /// Where `choices` are those of p it is the field, but for rounding and kHardlyInside. Errors: std::invalid_argument for
  /// choices that cannot be this tape's. Cost: that of Evaluator::sample().
  Sample sample_as(const PrunedField& field, const Choices& choices, const Vec3& p);

  /// The contacts (those of forks too) in which some sides differ, and the children that these sides name.
  struct Touching {
    struct Child {
      std::uint32_t contact = 0, child = 0;   ///< the contact by the place of its leader in Choices::winners
      bool operator==(const Child&) const = default;
    };
    Choices choices;                          ///< for all other operators: those of the first side to which such a contact matters
    std::vector<Child> children;              ///< none: the sides differ in no contact
    std::vector<std::size_t> apart;           ///< sides to which no such contact matters
  };
  /// Errors: std::invalid_argument.
  static Touching touching(const PrunedField& field, std::span<const Choices> sides);
  /// Values and gradients (1/m, in the world) of touching.children at p, as many as it has. Returns the field with those contacts
  /// choosing for themselves and all else as touching.choices.
  double sample_children(const PrunedField& field, const Touching& touching, const Vec3& p, std::vector<Sample>& children);

  struct Scratch;  ///< private to blobtree/

 private:
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace cambium
