// Expressions and statements of an L-system, compiled once and run on a small stack machine.
#pragma once

#include "lsystem/counter_random.h"
#include "lsystem/source_text.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

enum class Op : std::uint8_t {
  kConstant, kLocal, kGlobal, kStoreLocal, kStoreGlobal, kDrop,
  kNegate, kNot, kTruth,
  kAdd, kSubtract, kMultiply, kDivide, kModulo, kPower,
  kLess, kLessEqual, kGreater, kGreaterEqual, kEqual, kNotEqual,
  kAndJump, kOrJump,  ///< decided: leave the truth value and jump; undecided: drop it and go on
  kJump, kJumpIfZero,
  kCall,
  kElement, kStoreElement  ///< of an array: the flat index is on the stack
};

enum class Function : std::uint8_t {
  kSin, kCos, kTan, kAsin, kAcos, kAtan, kAtan2, kExp, kLog, kSqrt, kFloor, kCeil, kTrunc, kFabs, kSign, kMin, kMax, kPow,
  kRan, kNran, kBran, kSrand
};

struct FunctionInfo {
  std::string_view name;
  Function function;
  int arity;
};

/// nullptr if there is none. Angles are in degrees, as in cpfg.
const FunctionInfo* find_function(std::string_view name);

struct Instruction {
  Op op;
  std::uint32_t operand = 0;  ///< constant, variable, jump target, function or array
};

struct Code {
  std::vector<Instruction> instructions;
  std::vector<double> constants;
  std::vector<Place> places;  ///< of each instruction
  std::size_t stack_size = 0;
  bool empty() const { return instructions.empty(); }
};

struct ArrayInfo {
  std::string name;
  std::uint32_t first = 0;  ///< among the globals
  std::vector<std::uint32_t> sizes;
};

/// Runs Code. One per derivation; not shared by threads.
class Machine {
 public:
  Machine(const std::vector<std::string>& files, const std::vector<ArrayInfo>& arrays, CounterRandom& random)
      : files_(files), arrays_(arrays), random_(random) {}

  /// The values left on the stack, bottom first, valid until the next run. Errors: InputError at the instruction's place for a
  /// value that is not finite, an index out of range, or a loop of more than kMaxWork instructions.
  const double* run(const Code& code, double* locals);
  double value(const Code& code, double* locals) { return *run(code, locals); }

  std::vector<double> globals;
  std::uint64_t work = 0;  ///< instructions so far; the rewriter adds its own steps

  static constexpr std::uint64_t kMaxWork = 4'000'000;

 private:
  double call(Function function, const double* arguments);

  const std::vector<std::string>& files_;
  const std::vector<ArrayInfo>& arrays_;
  CounterRandom& random_;
  std::vector<double> stack_;
};

}  // namespace cambium
