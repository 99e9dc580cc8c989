// Expressions and statements of an L-system, compiled once and run on a small stack machine.
#pragma once

#include "lsystem/counter_random.h"
#include "lsystem/curve.h"
#include "lsystem/source_text.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

enum class Opcode : std::uint8_t {
  kConstant, kLocal, kGlobal, kStoreLocal, kStoreGlobal, kDrop,
  kNegate, kNot, kTruth,
  kAdd, kSubtract, kMultiply, kDivide, kModulo, kPower,
  kLess, kLessEqual, kGreater, kGreaterEqual, kEqual, kNotEqual,
  kAndJump, kOrJump,  ///< decided: leave the truth value and jump; undecided: drop it and go on
  kJump, kJumpIfZero,
  kCall,
  kElement, kStoreElement,  ///< of an array: its indices are on the stack
  kPrint                    ///< takes the values of one of Code::prints, leaves 0
};

enum class Function : std::uint8_t {
  kSin, kCos, kTan, kAsin, kAcos, kAtan, kAtan2, kExp, kLog, kSqrt, kFloor, kCeil, kTrunc, kFabs, kSign, kMin, kMax, kPow,
  kRan, kNran, kBran, kBiran, kSrand, kFunc
};

struct FunctionInfo {
  std::string_view name;
  Function function;
  int arity;
};

/// nullptr if there is none. Angles are in degrees, as in cpfg.
const FunctionInfo* find_function(std::string_view name);

struct CodeInstruction {
  Opcode op;
  std::uint32_t operand = 0;  ///< constant, variable, jump target, function or array
};

/// A call of printf: its format, and how many values it takes from the stack.
struct PrintCall {
  std::string format;
  std::uint32_t values = 0;
};

struct Code {
  std::vector<CodeInstruction> instructions;
  std::vector<double> constants;
  std::vector<Place> places;  ///< of each instruction
  std::vector<PrintCall> prints;
  std::size_t stack_size = 0;
  bool has_effects = false;   ///< outside of its module: it assigns to the L-system's variables, prints, or calls srand
  bool empty() const { return instructions.empty(); }
};

struct ArrayInfo {
  std::string name;
  std::uint32_t first = 0;  ///< among the globals
  std::vector<std::uint32_t> sizes;
};

/// What Code refers to by number, and the files that errors name.
struct CodeTables {
  std::vector<std::string> files;
  std::vector<ArrayInfo> arrays;
  std::vector<Curve> curves;   ///< number 1 first
};

using Printer = std::function<void(std::string_view)>;

/// Runs Code. Not shared by threads; several may share `globals` while none of them runs Code with effects.
class Machine {
 public:
  Machine(const CodeTables& tables, CounterRandom& random, std::vector<double>& globals, const Printer* printer = nullptr)
      : tables_(tables), random_(random), globals_(globals), printer_(printer) {}

  /// The values left on the stack, bottom first, valid until the next run. Errors: InputError at the instruction's place for a
  /// value that is not finite, an index out of range, or a loop of more than kMaxWork instructions.
  const double* run(const Code& code, double* locals);
  double value(const Code& code, double* locals) { return *run(code, locals); }

  std::uint64_t work = 0;  ///< instructions so far; the rewriter adds its own steps

  static constexpr std::uint64_t kMaxWork = 4'000'000;

 private:
  double call(Function function, const double* arguments);
  double& element(const ArrayInfo& array, const double* indices, const Place& place);
  void print(const PrintCall& call, const double* values);

  const CodeTables& tables_;
  CounterRandom& random_;
  std::vector<double>& globals_;
  const Printer* printer_;
  std::vector<double> stack_;
};

/// The value of Code that uses no variables and draws nothing.
double constant_value(const Code& code, const CodeTables& tables);

}  // namespace cambium
