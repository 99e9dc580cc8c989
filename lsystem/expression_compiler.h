// Expressions and statements of the L-system language, from text to Code.
#pragma once

#include "lsystem/bytecode.h"
#include "lsystem/source_text.h"

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace cambium {

/// Names of one L-system's variables and arrays. Several L-systems of a file share tables and slots.
struct SystemNames {
  std::unordered_map<std::string, std::uint32_t> variables;  ///< to slots
  std::unordered_map<std::string, std::uint32_t> arrays;     ///< to numbers in tables.arrays
  CodeTables& tables;
  std::uint32_t& slots;                        ///< how many are taken, arrays' elements counted
};

/// Names that an expression may use. Locals shadow the L-system's, these the names of curves (which stand for their numbers).
struct Scope {
  std::unordered_map<std::string, std::uint32_t> locals;
  SystemNames* system = nullptr;
  bool assigns_globals = false;                ///< a new name becomes the L-system's (Start and End blocks), else a local
};

/// Appends to one Code. Precedence as in cpfg's grammar: `?:`, `||`, `&&`, equality, comparison, sums, products, `^` (power,
/// from the left as the others), and tightest the signs and `!`: -2^2 is 4. What is made of constants alone is worked out
/// here. Errors: InputError.
class ExpressionCompiler {
 public:
  ExpressionCompiler(Cursor& cursor, Scope& scope, Code& code) : cursor_(cursor), scope_(scope), code_(code) {}

  void expression();   ///< leaves one value
  void block();        ///< `{ statements }`, leaves nothing

 private:
  struct Nesting;

  void binary(int lowest);
  void lazy(Opcode op, int precedence, std::size_t at);
  void choice(std::size_t at);
  void unary();
  void primary();
  void call(const std::string& name, std::size_t begin);
  std::uint32_t arguments(std::size_t open);
  std::string quoted_text();
  void print_call(std::size_t begin);
  void file_call();

  void statement();
  void if_statement(std::size_t begin);
  void while_statement(std::size_t begin);
  void do_statement(std::size_t begin);
  void for_statement(std::size_t begin);
  bool is_assignment();
  void assignment();

  const std::uint32_t* array_named(const std::string& name) const;
  std::size_t dimensions(std::uint32_t array) const { return scope_.system->tables.arrays[array].sizes.size(); }
  void indices(std::uint32_t array);
  void load(const std::string& name, std::size_t begin);
  void store(const std::string& name, std::size_t at);
  std::size_t emit(Opcode op, std::uint32_t operand, int change, std::size_t at);
  void emit_constant(double value, std::size_t at);
  void emit_operator(Opcode op, std::uint32_t operand, std::size_t operands, std::size_t at);
  void fold(std::size_t operands);
  std::uint32_t here() const { return static_cast<std::uint32_t>(code_.instructions.size()); }
  void patch(std::size_t jump) { code_.instructions[jump].operand = unfolded_ = here(); }

  Cursor& cursor_;
  Scope& scope_;
  Code& code_;
  std::size_t depth_ = 0;      ///< of the stack
  std::uint32_t unfolded_ = 0; ///< no constant before this instruction may be folded with one behind it: jumps lead here
  int nesting_ = 0;
};

// One level deeper into the text; keeps hostile nesting off the call stack.
struct ExpressionCompiler::Nesting {
  explicit Nesting(ExpressionCompiler& of);
  ~Nesting() { --owner.nesting_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  ExpressionCompiler& owner;
};

/// Value of the decimal number at the head; InputError if it is none or too large.
double read_number(Cursor& cursor);

/// The value of the expression of constants that stands here; the cursor is left behind it. Errors: InputError.
double constant_expression(Cursor& cursor);

}  // namespace cambium
