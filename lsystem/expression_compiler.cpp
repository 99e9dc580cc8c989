#include "lsystem/expression_compiler.h"

#include <charconv>
#include <system_error>

namespace cambium {
namespace {

constexpr int kMaxNesting = 200;

struct BinaryOperator {
  std::string_view text;
  int precedence;
  Op op;
};

// Longer spellings first, so that `<=` is not read as `<`.
constexpr BinaryOperator kBinary[] = {
    {"||", 1, Op::kOrJump}, {"&&", 2, Op::kAndJump},      {"==", 3, Op::kEqual}, {"!=", 3, Op::kNotEqual},
    {"<=", 4, Op::kLessEqual}, {">=", 4, Op::kGreaterEqual}, {"<", 4, Op::kLess},  {">", 4, Op::kGreater},
    {"+", 5, Op::kAdd},     {"-", 5, Op::kSubtract},      {"*", 6, Op::kMultiply}, {"/", 6, Op::kDivide},
    {"%", 6, Op::kModulo},
};

const BinaryOperator* binary_operator_at(const Cursor& cursor) {
  if (cursor.looking_at("-->")) return nullptr;
  for (const BinaryOperator& candidate : kBinary)
    if (cursor.looking_at(candidate.text)) return &candidate;
  return nullptr;
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
    cursor.fail_at(begin, "'" + text.substr(begin, length < 40 ? length : 40) + "'", "a number within the range of a double");
  cursor.advance(length);
  return value;
}

// One level deeper into the text; keeps hostile nesting off the call stack.
struct ExpressionCompiler::Nesting {
  explicit Nesting(ExpressionCompiler& of) : owner(of) {
    if (++owner.nesting_ > kMaxNesting)
      owner.cursor_.fail_at(owner.cursor_.position(), "nesting deeper than 200", "a simpler expression");
  }
  ~Nesting() { --owner.nesting_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  ExpressionCompiler& owner;
};

std::size_t ExpressionCompiler::emit(Op op, std::uint32_t operand, int change, std::size_t at) {
  code_.instructions.push_back({op, operand});
  code_.places.push_back(cursor_.place_of(at));
  depth_ = static_cast<std::size_t>(static_cast<long>(depth_) + change);
  if (depth_ > code_.stack_size) code_.stack_size = depth_;
  return code_.instructions.size() - 1;
}

void ExpressionCompiler::expression() { binary(1); }

void ExpressionCompiler::binary(int lowest) {
  const Nesting nesting(*this);
  unary();
  while (true) {
    cursor_.skip_space();
    const BinaryOperator* found = binary_operator_at(cursor_);
    if (!found || found->precedence < lowest) return;
    const std::size_t at = cursor_.position();
    cursor_.advance(found->text.size());
    if (found->op == Op::kAndJump || found->op == Op::kOrJump) {
      if (found->op == Op::kAndJump) emit(Op::kTruth, 0, 0, at);
      const std::size_t jump = emit(found->op, 0, -1, at);
      binary(found->precedence + 1);
      emit(Op::kTruth, 0, 0, at);
      patch(jump);
    } else {
      binary(found->precedence + 1);
      emit(found->op, 0, -1, at);
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
    if (c == '-') emit(Op::kNegate, 0, 0, at);
    if (c == '!') emit(Op::kNot, 0, 0, at);
    return;
  }
  primary();
  cursor_.skip_space();
  if (cursor_.peek() == '^') {
    const std::size_t power = cursor_.position();
    cursor_.advance();
    unary();
    emit(Op::kPower, 0, -1, power);
  }
}

void ExpressionCompiler::primary() {
  const std::size_t at = cursor_.position();
  if (cursor_.peek() == '(') {
    cursor_.advance();
    const Cursor::LineEnds inside(cursor_, true);
    binary(1);
    cursor_.expect_close(at, "or an operator");
    return;
  }
  if (is_digit(cursor_.peek()) || (cursor_.peek() == '.' && is_digit(cursor_.peek(1)))) {
    code_.constants.push_back(read_number(cursor_));
    emit(Op::kConstant, static_cast<std::uint32_t>(code_.constants.size() - 1), 1, at);
    return;
  }
  const std::string name = cursor_.word();
  if (name.empty()) cursor_.fail("an expression");
  cursor_.skip_space();
  if (cursor_.peek() == '(') return call(name, at);
  load(name, at);
}

void ExpressionCompiler::call(const std::string& name, std::size_t begin) {
  const FunctionInfo* function = find_function(name);
  if (!function) {
    if (name == "func") cursor_.fail_at(begin, "'func'", "no .func curves, which are not supported yet");
    cursor_.fail_at(begin, "'" + name + "'", "the name of a function");
  }
  const std::size_t open = cursor_.position();
  cursor_.advance();
  const Cursor::LineEnds inside(cursor_, true);
  int count = 0;
  cursor_.skip_space();
  if (cursor_.peek() != ')') {
    do {
      binary(1);
      ++count;
    } while (cursor_.accept(','));
  }
  cursor_.expect_close(open, "or ','");
  if (count != function->arity)
    cursor_.fail_at(begin, "'" + name + "' with " + std::to_string(count) + (count == 1 ? " argument" : " arguments"),
                    std::to_string(function->arity));
  emit(Op::kCall, static_cast<std::uint32_t>(function->function) | static_cast<std::uint32_t>(count) << 8, 1 - count, begin);
}

std::optional<std::uint32_t> ExpressionCompiler::array_named(const std::string& name) const {
  if (scope_.arrays)
    for (std::size_t i = 0; i < scope_.arrays->size(); ++i)
      if ((*scope_.arrays)[i].name == name) return static_cast<std::uint32_t>(i);
  return std::nullopt;
}

// Both `a[i][j]` and `a[i,j]`.
void ExpressionCompiler::indices(std::uint32_t array) {
  const std::size_t wanted = (*scope_.arrays)[array].sizes.size();
  for (std::size_t given = 0; given < wanted;) {
    cursor_.expect('[', "and an index");
    const Cursor::LineEnds inside(cursor_, true);
    do {
      if (given == wanted) cursor_.fail("']'");
      binary(1);
      ++given;
    } while (cursor_.accept(','));
    cursor_.expect(']', "after the index");
  }
}

void ExpressionCompiler::load(const std::string& name, std::size_t begin) {
  if (const auto local = scope_.locals.find(name); local != scope_.locals.end()) {
    emit(Op::kLocal, local->second, 1, begin);
    return;
  }
  if (const auto array = array_named(name)) {
    indices(*array);
    emit(Op::kElement, *array, 1 - static_cast<int>((*scope_.arrays)[*array].sizes.size()), begin);
    return;
  }
  if (scope_.globals) {
    if (const auto global = scope_.globals->find(name); global != scope_.globals->end()) {
      emit(Op::kGlobal, global->second, 1, begin);
      return;
    }
  }
  cursor_.fail_at(begin, "'" + name + "'", "a number, or the name of a parameter or variable");
}

void ExpressionCompiler::store(const std::string& name, std::size_t at) {
  if (const auto local = scope_.locals.find(name); local != scope_.locals.end()) {
    emit(Op::kStoreLocal, local->second, -1, at);
    return;
  }
  if (scope_.globals) {
    const auto global = scope_.globals->find(name);
    if (global != scope_.globals->end() || scope_.assigns_globals) {
      const std::uint32_t slot = global != scope_.globals->end() ? global->second : (*scope_.global_slots)++;
      scope_.globals->emplace(name, slot);
      emit(Op::kStoreGlobal, slot, -1, at);
      return;
    }
  }
  const auto slot = static_cast<std::uint32_t>(scope_.locals.size());
  scope_.locals.emplace(name, slot);
  emit(Op::kStoreLocal, slot, -1, at);
}

void ExpressionCompiler::block() {
  const Nesting nesting(*this);
  const Cursor::LineEnds inside(cursor_, true);
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  cursor_.expect('{', "before statements");
  while (!cursor_.accept('}')) {
    if (cursor_.at_end()) cursor_.fail_at(begin, "'{' without an end", "'}'");
    statement();
  }
}

void ExpressionCompiler::statement() {
  const Nesting nesting(*this);
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  if (cursor_.peek() == '{') return block();
  if (cursor_.accept(';')) return;
  const std::string keyword = cursor_.word();
  if (keyword == "if") {
    cursor_.expect('(', "after 'if'");
    expression();
    cursor_.expect(')', "after the condition");
    const std::size_t otherwise = emit(Op::kJumpIfZero, 0, -1, begin);
    statement();
    cursor_.skip_space();
    const std::size_t after = cursor_.position();
    if (cursor_.word() == "else") {
      const std::size_t end = emit(Op::kJump, 0, 0, after);
      patch(otherwise);
      statement();
      patch(end);
    } else {
      cursor_.seek(after);
      patch(otherwise);
    }
    return;
  }
  if (keyword == "while") {
    cursor_.expect('(', "after 'while'");
    const auto top = static_cast<std::uint32_t>(code_.instructions.size());
    expression();
    cursor_.expect(')', "after the condition");
    const std::size_t end = emit(Op::kJumpIfZero, 0, -1, begin);
    statement();
    emit(Op::kJump, top, 0, begin);
    patch(end);
    return;
  }
  if (keyword == "for") {
    cursor_.expect('(', "after 'for'");
    assignment();
    cursor_.expect(';', "after the first part of 'for'");
    const auto top = static_cast<std::uint32_t>(code_.instructions.size());
    expression();
    cursor_.expect(';', "after the condition");
    const std::size_t end = emit(Op::kJumpIfZero, 0, -1, begin);
    const std::size_t body = emit(Op::kJump, 0, 0, begin);
    const auto step = static_cast<std::uint32_t>(code_.instructions.size());
    assignment();
    cursor_.expect(')', "after the step of 'for'");
    emit(Op::kJump, top, 0, begin);
    patch(body);
    statement();
    emit(Op::kJump, step, 0, begin);
    patch(end);
    return;
  }
  if (keyword == "printf") {
    print_call();
  } else {
    cursor_.skip_space();
    if (!keyword.empty() && cursor_.peek() == '(') {
      call(keyword, begin);
      emit(Op::kDrop, 0, -1, begin);
    } else {
      cursor_.seek(begin);
      assignment();
    }
  }
  cursor_.expect(';', "after the statement");
}

void ExpressionCompiler::assignment() {
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  const std::string name = cursor_.word();
  if (name.empty()) cursor_.fail("a statement");
  const auto array = scope_.locals.count(name) ? std::nullopt : array_named(name);
  if (array) indices(*array);
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  Op combined = Op::kConstant;
  const char c = cursor_.peek();
  if (!array && cursor_.peek(1) == '=' && (c == '+' || c == '-' || c == '*' || c == '/')) {
    combined = c == '+' ? Op::kAdd : c == '-' ? Op::kSubtract : c == '*' ? Op::kMultiply : Op::kDivide;
    load(name, begin);
    cursor_.advance(2);
  } else {
    cursor_.expect('=', "of an assignment");
    if (cursor_.peek() == '=') cursor_.fail("an expression");
  }
  expression();
  if (combined != Op::kConstant) emit(combined, 0, -1, at);
  if (array)
    emit(Op::kStoreElement, *array, -1 - static_cast<int>((*scope_.arrays)[*array].sizes.size()), begin);
  else
    store(name, begin);
}

// A library never prints: the arguments are checked, evaluated and dropped.
void ExpressionCompiler::print_call() {
  cursor_.expect('(', "after 'printf'");
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  cursor_.expect('"', "before the text to print");
  while (cursor_.peek() != '"') {
    if (cursor_.at_line_end()) cursor_.fail_at(begin, "a text without an end", "'\"'");
    cursor_.advance(cursor_.peek() == '\\' && cursor_.peek(1) != '\n' && cursor_.peek(1) != '\0' ? 2 : 1);
  }
  cursor_.advance();
  while (cursor_.accept(',')) {
    const std::size_t at = cursor_.position();
    expression();
    emit(Op::kDrop, 0, -1, at);
  }
  cursor_.expect(')', "after the arguments of 'printf'");
}

}  // namespace cambium
