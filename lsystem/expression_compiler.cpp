#include "lsystem/expression_compiler.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <system_error>

namespace cambium {
namespace {

constexpr int kMaxNesting = 200;

struct BinaryOperator {
  std::string_view text;
  int precedence;
  Opcode op;
};

// Longer spellings first, so that `<=` is not read as `<`.
constexpr BinaryOperator kBinary[] = {
    {"||", 1, Opcode::kOrJump},   {"&&", 2, Opcode::kAndJump},   {"==", 3, Opcode::kEqual},        {"!=", 3, Opcode::kNotEqual},
    {"<>", 3, Opcode::kNotEqual}, {"<=", 4, Opcode::kLessEqual}, {">=", 4, Opcode::kGreaterEqual}, {"<", 4, Opcode::kLess},
    {">", 4, Opcode::kGreater},   {"+", 5, Opcode::kAdd},        {"-", 5, Opcode::kSubtract},      {"*", 6, Opcode::kMultiply},
    {"/", 6, Opcode::kDivide},    {"%", 6, Opcode::kModulo},     {"^", 7, Opcode::kPower},
};

const BinaryOperator* binary_operator_at(const Cursor& cursor) {
  if (cursor.looking_at("-->") || cursor.looking_at("-o>")) return nullptr;
  for (const BinaryOperator& candidate : kBinary)
    if (cursor.looking_at(candidate.text)) return &candidate;
  return nullptr;
}

// What cpfg's language has for its window, files and sounds. They change nothing of the string: their arguments are read, no
// more.
constexpr std::string_view kFileFunctions[] = {"fopen", "fclose", "fflush", "fprintf", "play", "stop", "Display"};

bool draws_or_looks_up(Function function) {
  return function == Function::kRan || function == Function::kNran || function == Function::kBran ||
         function == Function::kBiran || function == Function::kSrand || function == Function::kFunc;
}

}  // namespace

double read_number(Cursor& cursor) {
  const std::string& text = cursor.source().text;
  const std::size_t begin = cursor.position();
  if (!is_digit(cursor.peek()) && !(cursor.peek() == '.' && is_digit(cursor.peek(1)))) cursor.fail("a number");
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  const auto length = static_cast<std::size_t>(end - (text.data() + begin));
  if (error == std::errc::result_out_of_range)
    cursor.fail_at(begin, "'" + text.substr(begin, length < 40 ? length : 40) + "'",
                   "a number within the range of a double");
  cursor.advance(length);
  return value;
}

ExpressionCompiler::Nesting::Nesting(ExpressionCompiler& of) : owner(of) {
  if (++owner.nesting_ > kMaxNesting)
    owner.cursor_.fail_at(owner.cursor_.position(), "nesting deeper than 200", "a simpler expression");
}

std::size_t ExpressionCompiler::emit(Opcode op, std::uint32_t operand, int change, std::size_t at) {
  code_.instructions.push_back({op, operand});
  code_.places.push_back(cursor_.place_of(at));
  depth_ = static_cast<std::size_t>(static_cast<long>(depth_) + change);
  if (depth_ > code_.stack_size) code_.stack_size = depth_;
  return code_.instructions.size() - 1;
}

void ExpressionCompiler::emit_constant(double value, std::size_t at) {
  code_.constants.push_back(value);
  emit(Opcode::kConstant, static_cast<std::uint32_t>(code_.constants.size() - 1), 1, at);
}

void ExpressionCompiler::emit_operator(Opcode op, std::uint32_t operand, std::size_t operands, std::size_t at) {
  emit(op, operand, 1 - static_cast<int>(operands), at);
  fold(operands);
}

// Macros make expressions of constants (ABOP's #defines do): the last operator and its operands become one constant, unless
// that fails: then it fails where and when it is needed.
void ExpressionCompiler::fold(std::size_t operands) {
  const std::size_t count = operands + 1;
  if (code_.instructions.size() < count || code_.instructions.size() - count < unfolded_) return;
  const auto first = code_.instructions.end() - static_cast<std::ptrdiff_t>(count);
  if (!std::all_of(first, code_.instructions.end() - 1, [](const CodeInstruction& i) { return i.op == Opcode::kConstant; })) return;
  Code piece;
  piece.instructions.assign(first, code_.instructions.end());
  piece.places.assign(code_.places.end() - static_cast<std::ptrdiff_t>(count), code_.places.end());
  piece.constants = {code_.constants.end() - static_cast<std::ptrdiff_t>(operands), code_.constants.end()};
  for (std::uint32_t i = 0; i < operands; ++i) piece.instructions[i].operand = i;
  piece.stack_size = operands;
  double value = 0;
  try {
    value = constant_value(piece, {});
  } catch (const InputError&) {
    return;
  }
  code_.constants.resize(code_.constants.size() - operands);
  code_.constants.push_back(value);
  code_.instructions.resize(code_.instructions.size() - count);
  code_.instructions.push_back({Opcode::kConstant, static_cast<std::uint32_t>(code_.constants.size() - 1)});
  const Place place = code_.places.back();
  code_.places.resize(code_.instructions.size());
  code_.places.back() = place;
}

void ExpressionCompiler::expression() {
  const Nesting nesting(*this);
  binary(1);
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  if (cursor_.peek() == '?') choice(at);
}

// Behind the condition of `a ? b : c`.
void ExpressionCompiler::choice(std::size_t at) {
  cursor_.advance();
  const std::size_t otherwise = emit(Opcode::kJumpIfZero, 0, -1, at);
  expression();
  const std::size_t end = emit(Opcode::kJump, 0, -1, at);
  cursor_.expect(':', "of '?'");
  patch(otherwise);
  expression();
  patch(end);
}

void ExpressionCompiler::lazy(Opcode op, int precedence, std::size_t at) {
  if (op == Opcode::kAndJump) emit(Opcode::kTruth, 0, 0, at);
  const std::size_t jump = emit(op, 0, -1, at);
  binary(precedence + 1);
  emit(Opcode::kTruth, 0, 0, at);
  patch(jump);
}

void ExpressionCompiler::binary(int lowest) {
  const Nesting nesting(*this);
  unary();
  while (true) {
    cursor_.skip_space();
    const BinaryOperator* found = binary_operator_at(cursor_);
    if (!found || found->precedence < lowest) return;
    const std::size_t at = cursor_.position();
    cursor_.advance(found->text.size());
    if (found->op == Opcode::kAndJump || found->op == Opcode::kOrJump) {
      lazy(found->op, found->precedence, at);
    } else {
      binary(found->precedence + 1);
      emit_operator(found->op, 0, 2, at);
    }
  }
}

void ExpressionCompiler::unary() {
  const Nesting nesting(*this);
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  const char c = cursor_.peek();
  if ((c == '-' && !cursor_.looking_at("-->")) || c == '+' || (c == '!' && cursor_.peek(1) != '=')) {
    cursor_.advance();
    unary();
    if (c == '-') emit_operator(Opcode::kNegate, 0, 1, at);
    if (c == '!') emit_operator(Opcode::kNot, 0, 1, at);
    return;
  }
  primary();
}

void ExpressionCompiler::primary() {
  const std::size_t at = cursor_.position();
  if (cursor_.peek() == '(') {
    cursor_.advance();
    const Cursor::LineEnds inside(cursor_, true);
    expression();
    cursor_.expect_close(at, "or an operator");
    return;
  }
  if (is_digit(cursor_.peek()) || (cursor_.peek() == '.' && is_digit(cursor_.peek(1))))
    return emit_constant(read_number(cursor_), at);
  if (cursor_.peek() == '"') {  // of a label, which only is drawn: `@L("%g",x)`
    quoted_text();
    return emit_constant(0, at);
  }
  const std::string name = cursor_.word();
  if (name.empty()) cursor_.fail("an expression");
  cursor_.skip_space();
  if (cursor_.peek() == '(') return call(name, at);
  load(name, at);
}

// From the '(' at `open` to its ')'; how many there were.
std::uint32_t ExpressionCompiler::arguments(std::size_t open) {
  cursor_.advance();
  const Cursor::LineEnds inside(cursor_, true);
  std::uint32_t count = 0;
  cursor_.skip_space();
  if (cursor_.peek() != ')') {
    do {
      expression();
      ++count;
    } while (cursor_.accept(','));
  }
  cursor_.expect_close(open, "or ','");
  return count;
}

void ExpressionCompiler::call(const std::string& name, std::size_t begin) {
  if (name == "printf") return print_call(begin);
  if (std::find(std::begin(kFileFunctions), std::end(kFileFunctions), name) != std::end(kFileFunctions)) {
    file_call();
    return emit_constant(0, begin);
  }
  const FunctionInfo* function = find_function(name);
  if (!function) cursor_.fail_at(begin, "'" + name + "'", "the name of a function");
  if (function->function == Function::kFunc && (!scope_.system || scope_.system->tables.curves.empty()))
    cursor_.fail_at(begin, "'func' without curves", "a .v, .fset or .func file beside the model");
  const std::uint32_t count = arguments(cursor_.position());
  if (static_cast<int>(count) != function->arity)
    cursor_.fail_at(begin, "'" + name + "' with " + std::to_string(count) + (count == 1 ? " argument" : " arguments"),
                    std::to_string(function->arity));
  const std::uint32_t operand = static_cast<std::uint32_t>(function->function) | count << 8;
  if (function->function == Function::kSrand) code_.has_effects = true;
  if (draws_or_looks_up(function->function))
    emit(Opcode::kCall, operand, 1 - function->arity, begin);
  else
    emit_operator(Opcode::kCall, operand, count, begin);
}

std::string ExpressionCompiler::quoted_text() {
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  cursor_.expect('"', "before a text");
  std::string text;
  while (cursor_.peek() != '"') {
    if (cursor_.at_line_end()) cursor_.fail_at(begin, "a text without an end", "'\"'");
    const bool escape = cursor_.peek() == '\\' && cursor_.peek(1) != '\n' && cursor_.peek(1) != '\0';
    for (int i = escape ? 2 : 1; i > 0; --i) {
      text += cursor_.peek();
      cursor_.advance();
    }
  }
  cursor_.advance();
  return text;
}

void ExpressionCompiler::print_call(std::size_t begin) {
  const std::size_t open = cursor_.position();
  cursor_.advance();
  const Cursor::LineEnds inside(cursor_, true);
  PrintCall print;
  print.format = quoted_text();
  for (; cursor_.accept(','); ++print.values) expression();
  cursor_.expect_close(open, "or ','");
  code_.has_effects = true;
  const int change = 1 - static_cast<int>(print.values);
  code_.prints.push_back(std::move(print));
  emit(Opcode::kPrint, static_cast<std::uint32_t>(code_.prints.size() - 1), change, begin);
}

// The arguments are checked, and that is all.
void ExpressionCompiler::file_call() {
  const std::size_t open = cursor_.position();
  cursor_.advance();
  const Cursor::LineEnds inside(cursor_, true);
  Code unused;
  cursor_.skip_space();
  while (cursor_.peek() != ')') {
    if (cursor_.peek() == '"')
      quoted_text();
    else
      ExpressionCompiler(cursor_, scope_, unused).expression();
    if (!cursor_.accept(',')) break;
    cursor_.skip_space();
  }
  cursor_.expect_close(open, "or ','");
}

const std::uint32_t* ExpressionCompiler::array_named(const std::string& name) const {
  if (!scope_.system) return nullptr;
  const auto found = scope_.system->arrays.find(name);
  return found == scope_.system->arrays.end() ? nullptr : &found->second;
}

// Both `a[i][j]` and `a[i,j]`.
void ExpressionCompiler::indices(std::uint32_t array) {
  const std::size_t wanted = dimensions(array);
  for (std::size_t given = 0; given < wanted;) {
    cursor_.expect('[', "and an index");
    const Cursor::LineEnds inside(cursor_, true);
    do {
      if (given == wanted) cursor_.fail("']'");
      expression();
      ++given;
    } while (cursor_.accept(','));
    cursor_.expect(']', "after the index");
  }
}

void ExpressionCompiler::load(const std::string& name, std::size_t begin) {
  if (const auto local = scope_.locals.find(name); local != scope_.locals.end()) {
    emit(Opcode::kLocal, local->second, 1, begin);
    return;
  }
  if (const std::uint32_t* array = array_named(name)) {
    indices(*array);
    emit(Opcode::kElement, *array, 1 - static_cast<int>(dimensions(*array)), begin);
    return;
  }
  if (scope_.system) {
    const auto& variables = scope_.system->variables;
    if (const auto global = variables.find(name); global != variables.end()) {
      emit(Opcode::kGlobal, global->second, 1, begin);
      return;
    }
    const auto& curves = scope_.system->tables.curves;
    for (std::size_t i = 0; i < curves.size(); ++i)
      if (curves[i].name() == name) return emit_constant(static_cast<double>(i + 1), begin);
  }
  cursor_.fail_at(begin, "'" + name + "'", "a number, or the name of a parameter or variable");
}

void ExpressionCompiler::store(const std::string& name, std::size_t at) {
  if (const auto local = scope_.locals.find(name); local != scope_.locals.end()) {
    emit(Opcode::kStoreLocal, local->second, -1, at);
    return;
  }
  if (scope_.system) {
    auto& variables = scope_.system->variables;
    const auto global = variables.find(name);
    if (global != variables.end() || scope_.assigns_globals) {
      const std::uint32_t slot = global != variables.end() ? global->second : scope_.system->slots++;
      variables.emplace(name, slot);
      code_.has_effects = true;
      emit(Opcode::kStoreGlobal, slot, -1, at);
      return;
    }
  }
  const auto slot = static_cast<std::uint32_t>(scope_.locals.size());
  scope_.locals.emplace(name, slot);
  emit(Opcode::kStoreLocal, slot, -1, at);
}

double constant_expression(Cursor& cursor) {
  Scope none;
  Code code;
  ExpressionCompiler(cursor, none, code).expression();
  CodeTables tables;
  tables.files = cursor.source().files;
  return constant_value(code, tables);
}

}  // namespace cambium
