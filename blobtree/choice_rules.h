// Rules for run_tape() that note what operators choose, or choose as they are told. Private to blobtree/.
#pragma once

#include "blobtree/choices.h"
#include "blobtree/interpreter.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace cambium {

/// How many entries a contact has in Choices: its leader, unless it has but one child, and of three or more the one that pushes.
inline std::uint32_t contact_entries(std::size_t n, bool with_zero) {
  return (n + (with_zero ? 1 : 0) >= 2 ? 1u : 0u) + (n >= 3 ? 1u : 0u);
}

/// The entries of one instruction in Choices::winners; of a fork those of its laterals come first, then the axis's.
struct ChoiceEntries {
  std::uint32_t count = 0;
  std::uint32_t contact = 0;        ///< how many of them are those of a contact, or of a fork's laterals
  std::uint32_t children = 0;       ///< of that contact
  bool has_axis = false;            ///< a fork's: 1 more entry
};
inline ChoiceEntries choice_entries(const Tape& tape, const Instruction& in) {
  switch (in.op) {
    case Op::kUnion:
    case Op::kIntersection:
    case Op::kDifference: return {1, 0, 0, false};
    case Op::kContact: {
      const std::uint32_t entries = contact_entries(in.count, in.with_zero);
      return {entries, entries, in.count, false};
    }
    case Op::kFork: {
      const bool has_axis = tape.slots()[in.first] == 0;
      const std::uint32_t laterals = in.count - (has_axis ? 1u : 0u), entries = contact_entries(laterals, in.with_zero);
      return {entries + (has_axis ? 1u : 0u), entries, laterals, has_axis};
    }
    case Op::kPrimitive:
    case Op::kHalfSpace:
    case Op::kChain:
    case Op::kFlare:
    case Op::kSum:
    case Op::kRicci:
    case Op::kScale:
    case Op::kWarp: break;
  }
  return {};
}

/// Every operator as it is; notes what it took.
class NotingRules {
 public:
  explicit NotingRules(std::vector<std::uint32_t>& winners) : winners_(winners) {}
  /// Whether an operator met so far takes one child and nothing of the others.
  bool selects() const { return selects_; }

  double unite(const Instruction&, const double* f, std::size_t n, bool with_zero) {
    const double value = max_of(f, n, with_zero);
    const auto best = static_cast<std::size_t>(std::max_element(f, f + n) - f);
    select_child(with_zero && f[best] < 0 ? n : best);
    return value;
  }
  double intersect(const Instruction&, const double* f, std::size_t n, bool with_zero) {
    const double value = min_of(f, n, with_zero);
    const auto best = static_cast<std::size_t>(std::min_element(f, f + n) - f);
    select_child(with_zero && f[best] > 0 ? n : best);
    return value;
  }
  double subtract(const Instruction&, double first, const double* taken, std::size_t n, bool capped) {
    std::size_t winner = 0;
    double best = first;
    for (std::size_t i = 0; i < n; ++i) {
      if (!(1 - taken[i] < best)) continue;
      best = 1 - taken[i];
      winner = i + 1;
    }
    select_child(capped && best > 1 ? n + 1 : winner);
    return difference_of(first, taken, n, capped);
  }
  double touch(const Instruction&, const double* f, std::size_t n, bool with_zero, const CompiledBlend& blend) {
    note_contact(f, n, with_zero, blend);
    return contact_of(f, n, with_zero, blend.width, blend.lip);
  }
  double fork(const Instruction&, bool has_axis, double axis, const double* f, const double* weights, std::size_t n, bool with_zero,
              const CompiledBlend& blend) {
    note_contact(f, n, with_zero, blend);
    if (has_axis) {
      const bool reached = std::any_of(f, f + n, [](double x) { return x > 0; });
      const double pair[2] = {std::max(axis, 0.0), reached ? contact_of(f, n, with_zero, blend.width, blend.lip) : 0};
      note(axis == 0 && reached ? 1 : leader_of(pair, 2, false, blend));
    }
    return fork_of(axis, f, weights, n, with_zero, blend.width, blend.lip);
  }

 private:
  void note(std::size_t winner) { winners_.push_back(static_cast<std::uint32_t>(winner)); }
  void select_child(std::size_t winner) {
    note(winner);
    selects_ = true;
  }
  void note_contact(const double* f, std::size_t n, bool with_zero, const CompiledBlend& blend) {
    if (contact_entries(n, with_zero) == 0) return;
    const std::size_t leader = leader_of(f, n, with_zero, blend);
    note(leader);
    if (n < 3) return;
    const std::size_t apart = leader & ~std::size_t{Choices::kBothInside};
    std::size_t next = apart == 0 ? 1 : 0;
    for (std::size_t i = next + 1; i < n; ++i)
      if (i != apart && f[i] > f[next]) next = i;
    note(next);
  }
  static std::size_t leader_of(const double* f, std::size_t n, bool with_zero, const CompiledBlend& blend) {
    const auto at = [&](std::size_t i) { return i < n ? f[i] : 0.0; };
    std::size_t first = 0, second = 1;
    if (at(1) > at(0)) std::swap(first, second);
    for (std::size_t i = 2; i < n + (with_zero ? 1 : 0); ++i) {
      if (at(i) > at(first)) {
        second = first;
        first = i;
      } else if (at(i) > at(second)) {
        second = i;
      }
    }
    if (at(second) >= kIso + Choices::kHardlyInside) return first | Choices::kBothInside;
    return meeting<double>(at(first), at(second), ContactShape<double>(blend.width, blend.lip)).first_leads ? first : second;
  }

  std::vector<std::uint32_t>& winners_;
  bool selects_ = false;
};

/// A child of a watched contact, as that contact saw it.
struct WatchedChild {
  Dual<double> value;
  std::uint16_t frame = 0;
};

/// Every operator as the choices say, but contacts that are watched as they are. Errors: std::invalid_argument.
class GivenRules {
 public:
  using N = Dual<double>;
  explicit GivenRules(const Choices& choices) : winners_(choices.winners) {}
  GivenRules(const ChoiceEvaluator::Touching& touching, std::vector<WatchedChild>& seen)
      : winners_(touching.choices.winners), watched_(touching.children), seen_(&seen) {
    seen.assign(watched_.size(), {});
  }

  N unite(const Instruction&, const N* f, std::size_t n, bool with_zero) { return taken(f, n, with_zero); }
  N intersect(const Instruction&, const N* f, std::size_t n, bool with_zero) { return taken(f, n, with_zero); }
  N subtract(const Instruction&, const N& first, const N* taken, std::size_t n, bool capped) {
    const std::size_t winner = next(n + 1 + (capped ? 1 : 0));
    if (winner == 0) return first;
    return winner <= n ? N(1) - taken[winner - 1] : N(1);
  }
  N touch(const Instruction& in, const N* f, std::size_t n, bool with_zero, const CompiledBlend& blend) {
    const std::uint32_t entries = contact_entries(n, with_zero);
    if (entries == 0) return f[0];
    if (watches(in, f, n)) {
      at_ += entries;
      return contact_of(f, n, with_zero, blend.width, blend.lip);
    }
    bool both_inside = false;
    const std::size_t leader = next(n + (with_zero ? 1 : 0), &both_inside);
    std::size_t pusher = leader == 0 ? 1 : 0;   // of two, the other
    if (n >= 3) pusher = next(n);
    if (n == 2 && leader == 2 && f[1].f > f[0].f) pusher = 1;
    const N led = leader < n ? f[leader] : N(0);
    return both_inside || pusher >= n ? led : led + push(f[pusher], blend);
  }
  N fork(const Instruction& in, bool has_axis, const N& axis, const N* f, const N* weights, std::size_t n, bool with_zero,
         const CompiledBlend& blend) {
    const N joined = touch(in, f, n, with_zero, blend);
    if (!has_axis) return any_positive(f, n) ? joined : axis;
    const N pair[2] = {axis.f > 0 ? axis : N(0), joined};
    N touching(0);
    if (watches(in, pair, 2)) {
      ++at_;
      touching = contact_of(pair, 2, false, blend.width, blend.lip);
    } else {
      bool both_inside = false;
      const std::size_t leader = next(2, &both_inside);
      touching = both_inside ? pair[leader] : pair[leader] + push(pair[1 - leader], blend);
    }
    if (!any_positive(f, n)) return axis;
    N total(0), weighted(0);
    for (std::size_t k = 0; k < n; ++k) {
      if (!(f[k].f > 0)) continue;
      total = total + f[k];
      weighted = weighted + f[k] * weights[k];
    }
    const N share = weighted / total, negative = axis - pair[0];
    return (N(1) - share) * (axis + joined) + share * (touching + negative);
  }
  /// After the last operator.
  void finish() const {
    if (at_ != winners_.size()) refuse();
  }
  static void check_size(const Choices& choices, std::size_t entries) {
    if (choices.winners.size() != entries) refuse();
  }

 private:
  [[noreturn]] static void refuse() { throw std::invalid_argument("choices of another tape"); }
  std::size_t next(std::size_t limit, bool* both_inside = nullptr) {
    if (at_ >= winners_.size()) refuse();
    std::uint32_t winner = winners_[at_++];
    if (winner == Choices::kDoesNotMatter) return 0;
    if (both_inside) {
      *both_inside = (winner & Choices::kBothInside) != 0;
      winner &= ~Choices::kBothInside;
    }
    if (winner >= limit) refuse();
    return winner;
  }
  N taken(const N* f, std::size_t n, bool with_zero) {
    const std::size_t winner = next(n + (with_zero ? 1 : 0));
    return winner < n ? f[winner] : N(0);
  }
  /// Whether the contact whose entries come next is watched.
  bool watches(const Instruction& in, const N* f, std::size_t n) {
    bool any = false;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
      if (watched_[i].contact != at_) continue;
      if (watched_[i].child >= n) refuse();
      (*seen_)[i] = {f[watched_[i].child], in.frame};
      any = true;
    }
    return any;
  }
  static bool any_positive(const N* f, std::size_t n) {
    return std::any_of(f, f + n, [](const N& x) { return x.f > 0; });
  }
  /// D(f) of field.md section 4, also where the leader is not the larger one.
  static N push(const N& other, const CompiledBlend& blend) {
    if (other.f >= kIso) return N(kIso) - other;
    if (other.f <= kIso - blend.width) return N(0);
    const double u = (kIso - other.f) / blend.width, v = 1 - u, q = 1 + u * blend.lip;
    return {u * v * v * q * blend.width, v * (2 * q * (u - v) + v) * other.g};
  }

  std::span<const std::uint32_t> winners_;
  std::span<const ChoiceEvaluator::Touching::Child> watched_;
  std::vector<WatchedChild>* seen_ = nullptr;
  std::size_t at_ = 0;
};

}  // namespace cambium
