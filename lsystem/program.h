// A parsed L-system: what derive() and interpret() run.
#pragma once

#include "lsystem/bytecode.h"

#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

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
  Code parameters;              ///< leaves all modules' parameters, in order
  std::size_t parameter_count = 0;
};

/// left < predecessor > right : {before} condition {after} --> successor : weight
struct Production {
  std::vector<ContextModule> left;   ///< nearest to the predecessor first
  std::vector<ContextModule> right;
  ContextModule predecessor;
  Code before, condition, after, weight;  ///< empty: none
  Successor successor;
  std::uint32_t local_count = 0;
  std::uint32_t group = 0;           ///< productions of one predecessor and contexts, among which weights draw
  Place place, weight_place;
};

/// Productions and, for each symbol, those that rewrite it, in the file's order.
struct RuleSet {
  std::vector<Production> productions;
  std::vector<std::vector<std::uint32_t>> of_symbol;
  int max_depth = 1;            ///< of decomposition and homomorphism
  bool has_context = false;
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

struct LSystemProgram {
  std::string label;
  std::vector<std::string> files;
  SymbolTable symbols;
  std::uint16_t open = 0, close = 0, cut = 0;   ///< `[`, `]`, `%`
  std::uint64_t seed = 0;
  int derivation_length = -1;                   ///< -1: the file does not say
  std::vector<bool> ignored;                    ///< by symbol, as context sees it
  std::vector<ArrayInfo> arrays;
  std::vector<double> initial_globals;
  Code start, start_each, end_each, end;
  std::uint32_t block_locals = 0;               ///< most locals of any of the blocks above
  Successor axiom;
  RuleSet productions, decomposition, homomorphism;
  Place place;                                  ///< of `lsystem:`
};

}  // namespace cambium
