// Left and right contexts in a bracketed string, as cpfg matches them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lsystem/lsystem.h"
#include "lsystem/program.h"

namespace cambium {

/// Where the partners of a string's brackets stand; the string's size for one without a partner.
class BracketPairs {
 public:
  /// False if cancelled. Linear.
  bool link(const Modules& string, std::uint16_t open, std::uint16_t close, const RunOptions& run);
  std::size_t partner(std::size_t bracket) const { return partner_[bracket]; }

 private:
  std::vector<std::uint32_t> partner_;
};

/// Matches contexts of one pass's string, whose brackets are linked.
///  - Leftwards branches are stepped over and an opening bracket leads on to the parent axis; only ignored symbols are
///  skipped.
///  - Rightwards a branch is stepped over unless the context has a `[` there, and then the next module has to be that
///  bracket;
///    a `]` in the context has to come right behind what was matched, unless `=` stands before it, which takes the rest of
///    the branch.
///  - Brackets that `consider:` leaves out are seen through by right contexts, like any ignored symbol.
///  - In a ring the string's ends meet.
class ContextMatcher {
 public:
  ContextMatcher(const LSystemProgram& program, const Modules& string, const BracketPairs& brackets)
      : program_(program), string_(string), brackets_(brackets) {}

  /// Whether `left` ends before the module at `end`; parameters go to `locals`.
  bool left(const std::vector<ContextModule>& left, std::size_t end, const System& system, double* locals);
  /// Whether `right` begins at the module at `begin`.
  bool right(const std::vector<ContextModule>& right, std::size_t begin, const System& system, double* locals);
  /// The `]` of the branch that `at` is in, or the string's size.
  std::size_t end_of_branch(std::size_t at);

  std::uint64_t work = 0;  ///< modules stepped over so far

 private:
  const LSystemProgram& program_;
  const Modules& string_;
  const BracketPairs& brackets_;
};

/// Whether the module is one of `wanted`: same symbol, same number of parameters; then these go to `locals`.
bool take_module(const ContextModule& wanted, const Modules& string, std::size_t at, double* locals);

}  // namespace cambium
