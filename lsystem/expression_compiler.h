// Expressions and statements of the L-system language, from text to Code.
#pragma once

#include "lsystem/bytecode.h"
#include "lsystem/source_text.h"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace cambium {

/// Names that an expression may use. Locals shadow globals.
struct Scope {
  std::unordered_map<std::string, std::uint32_t> locals;
  std::unordered_map<std::string, std::uint32_t>* globals = nullptr;
  std::uint32_t* global_slots = nullptr;       ///< how many globals there are, arrays' elements counted
  std::vector<ArrayInfo>* arrays = nullptr;
  bool assigns_globals = false;                ///< a new name becomes a global (Start and End blocks), else a local
};

/// Appends to one Code. Precedence as in C; `^` is power, binds tighter than a sign, and to the right. Errors: InputError.
class ExpressionCompiler {
 public:
  ExpressionCompiler(Cursor& cursor, Scope& scope, Code& code) : cursor_(cursor), scope_(scope), code_(code) {}

  void expression();   ///< leaves one value
  void block();        ///< `{ statements }`, leaves nothing

 private:
  struct Nesting;

  void binary(int lowest);
  void unary();
  void primary();
  void call(const std::string& name, std::size_t begin);
  void statement();
  void assignment();
  void print_call();
  std::optional<std::uint32_t> array_named(const std::string& name) const;
  void indices(std::uint32_t array);
  void load(const std::string& name, std::size_t begin);
  void store(const std::string& name, std::size_t at);
  std::size_t emit(Op op, std::uint32_t operand, int change, std::size_t at);
  void patch(std::size_t jump) { code_.instructions[jump].operand = static_cast<std::uint32_t>(code_.instructions.size()); }

  Cursor& cursor_;
  Scope& scope_;
  Code& code_;
  std::size_t depth_ = 0;   ///< of the stack
  int nesting_ = 0;
};

/// Value of the decimal number at the head; InputError if it is none or too large.
double read_number(Cursor& cursor);

}  // namespace cambium
