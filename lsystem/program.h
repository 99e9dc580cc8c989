// A parsed L-system: what derive() and interpret() run.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "lsystem/bytecode.h"
#include "lsystem/dialect_translation.h"
#include "lsystem/view.h"

namespace cambium {

/// A module of a context: symbol and number of parameters, which go to locals first_local onwards.
struct ContextModule {
  std::uint16_t symbol = 0;
  std::uint16_t arity = 0;
  std::uint32_t first_local = 0;
};

struct Successor {
  std::vector<std::uint16_t> symbols;
  std::vector<std::uint16_t> arities;
  std::vector<std::uint64_t> slots;  ///< see lineage.h
  Code parameters;                   ///< leaves all modules' parameters, in order
  std::size_t parameter_count = 0;
};

/// left < predecessor > right : {before} condition {after} --> successor : weight
struct Production {
  std::vector<ContextModule> left;  ///< nearest to the predecessor first
  std::vector<ContextModule> right;
  std::vector<ContextModule> predecessor;  ///< one or more modules in a row, all of which the successor replaces
  Code before, condition, after, weight;   ///< empty: none
  Successor successor;
  std::uint32_t local_count = 0;
  std::uint32_t group = 0;  ///< productions of one strict predecessor, among which weights draw
  Place place, weight_place;
};

/// Productions and, for each symbol, those whose predecessor begins with it, in the file's order.
struct RuleSet {
  std::vector<Production> productions;
  std::vector<std::vector<std::uint32_t>> of_symbol;
  int max_depth = 1;  ///< of decomposition and homomorphism
  bool has_context = false;
  bool in_order = false;  ///< modules have to be rewritten from left to right: see RewritingPass
  bool empty() const { return productions.empty(); }
};

/// Names of symbols and their numbers.
class SymbolTable {
 public:
  static constexpr std::size_t kMaxSymbols = std::numeric_limits<std::uint16_t>::max();

  std::uint16_t number(const std::string& name) {
    const auto [found, inserted] = numbers_.emplace(name, static_cast<std::uint16_t>(names_.size()));
    if (inserted) names_.push_back(name);
    return found->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::unordered_map<std::string, std::uint16_t> numbers_;
  std::vector<std::string> names_;
};

/// One `lsystem: label` ... `endlsystem`.
struct System {
  std::string label;
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> homomorphism_seed;
  int derivation_length = -1;  ///< -1: the file does not say
  bool ring = false;
  std::vector<bool> ignored;  ///< by symbol, as context sees it
  Code start, start_each, end_each, end;
  Successor axiom;
  RuleSet productions, decomposition, homomorphism;
  Place place;  ///< of `lsystem:`
};

/// All L-systems of a file. They share symbols, and the others are what the main one calls by `?(label)` ... `$`.
struct LSystemProgram {
  CodeTables tables;
  SymbolTable symbols;
  std::uint16_t open = 0, close = 0, cut = 0;  ///< `[`, `]`, `%`
  std::uint16_t call = 0, end_call = 0;        ///< `?`, `$`
  std::uint16_t rest = 0;                      ///< `=`: in a right context, all up to the end of the branch
  std::vector<double> initial_globals;         ///< of all systems
  std::uint32_t block_locals = 0;              ///< most locals of any block
  std::vector<System> systems;
  std::size_t main_index = 0;
  Dialect dialect = Dialect::kCpfg;            ///< whose turtle the symbols are for
  HoudiniValues houdini;
  View view;

  const System& main() const { return systems[main_index]; }
  /// The one whose label is this whole number; nullptr if there is none.
  const System* numbered(double label) const;
};

}  // namespace cambium
