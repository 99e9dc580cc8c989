// The statements of blocks.
#include "lsystem/expression_compiler.h"

namespace cambium {

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
  if (keyword == "if") return if_statement(begin);
  if (keyword == "while") return while_statement(begin);
  if (keyword == "do") return do_statement(begin);
  if (keyword == "for") return for_statement(begin);
  cursor_.seek(begin);
  if (is_assignment()) {
    assignment();
  } else {
    expression();
    emit(Opcode::kDrop, 0, -1, begin);
  }
  cursor_.expect(';', "after the statement");
}

// A statement may be an expression whose value nobody wants: a call, say.
bool ExpressionCompiler::is_assignment() {
  const std::size_t begin = cursor_.position();
  cursor_.word();
  cursor_.skip_space();
  const char c = cursor_.peek();
  const bool compares = cursor_.peek(1) == '=' && (c == '=' || c == '!' || c == '<' || c == '>');
  const bool combines = cursor_.peek(1) == '=' && !compares;
  const bool expression =
      c == '(' || c == ';' || compares || (std::string_view("+-*/%^<>?!&|").find(c) != std::string_view::npos && !combines);
  cursor_.seek(begin);
  return c == '\0' || !expression;
}

void ExpressionCompiler::if_statement(std::size_t begin) {
  cursor_.expect('(', "after 'if'");
  expression();
  cursor_.expect(')', "after the condition");
  const std::size_t otherwise = emit(Opcode::kJumpIfZero, 0, -1, begin);
  statement();
  cursor_.skip_space();
  const std::size_t after = cursor_.position();
  if (cursor_.word() != "else") {
    cursor_.seek(after);
    return patch(otherwise);
  }
  const std::size_t end = emit(Opcode::kJump, 0, 0, after);
  patch(otherwise);
  statement();
  patch(end);
}

void ExpressionCompiler::while_statement(std::size_t begin) {
  cursor_.expect('(', "after 'while'");
  const std::uint32_t top = here();
  expression();
  cursor_.expect(')', "after the condition");
  const std::size_t end = emit(Opcode::kJumpIfZero, 0, -1, begin);
  statement();
  emit(Opcode::kJump, top, 0, begin);
  patch(end);
}

void ExpressionCompiler::do_statement(std::size_t begin) {
  const std::uint32_t top = here();
  statement();
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  if (cursor_.word() != "while") cursor_.fail_at(at, cursor_.describe(at), "'while' after the body of 'do'");
  cursor_.expect('(', "after 'while'");
  expression();
  cursor_.expect(')', "after the condition");
  cursor_.expect(';', "after 'do'");
  const std::size_t end = emit(Opcode::kJumpIfZero, 0, -1, begin);
  emit(Opcode::kJump, top, 0, begin);
  patch(end);
}

void ExpressionCompiler::for_statement(std::size_t begin) {
  cursor_.expect('(', "after 'for'");
  assignment();
  cursor_.expect(';', "after the first part of 'for'");
  const std::uint32_t top = here();
  expression();
  cursor_.expect(';', "after the condition");
  const std::size_t end = emit(Opcode::kJumpIfZero, 0, -1, begin);
  const std::size_t body = emit(Opcode::kJump, 0, 0, begin);
  const std::uint32_t step = here();
  assignment();
  cursor_.expect(')', "after the step of 'for'");
  emit(Opcode::kJump, top, 0, begin);
  patch(body);
  statement();
  emit(Opcode::kJump, step, 0, begin);
  patch(end);
}

void ExpressionCompiler::assignment() {
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  const std::string name = cursor_.word();
  if (name.empty()) cursor_.fail("a statement");
  const std::uint32_t* array = scope_.locals.count(name) ? nullptr : array_named(name);
  if (array) indices(*array);
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  Opcode combined = Opcode::kConstant;
  const char c = cursor_.peek();
  if (!array && cursor_.peek(1) == '=' && (c == '+' || c == '-' || c == '*' || c == '/')) {
    combined = c == '+' ? Opcode::kAdd : c == '-' ? Opcode::kSubtract : c == '*' ? Opcode::kMultiply : Opcode::kDivide;
    load(name, begin);
    cursor_.advance(2);
  } else {
    cursor_.expect('=', "of an assignment");
    if (cursor_.peek() == '=') cursor_.fail("an expression");
  }
  expression();
  if (combined != Opcode::kConstant) emit(combined, 0, -1, at);
  if (!array) return store(name, begin);
  code_.has_effects = true;
  emit(Opcode::kStoreElement, *array, -1 - static_cast<int>(dimensions(*array)), begin);
}

}  // namespace cambium
