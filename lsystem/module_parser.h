// Modules, successors and productions of an L-system, from text.
#pragma once

#include "lsystem/expression_compiler.h"
#include "lsystem/program.h"

#include <optional>
#include <string>

namespace cambium {

/// Whether a word that begins a line is a keyword of the language, whatever its case: then no successor runs on past it.
bool is_keyword(const std::string& word);
std::string lower_case(std::string word);

class ModuleParser {
 public:
  ModuleParser(Cursor& cursor, LSystemProgram& program, Scope& globals)
      : cursor_(cursor), program_(program), globals_(globals) {}

  /// The symbol at the head: one character, or `@X`, `@#`, `@Gs`, `@Td`, `?P`, `~x`, or a marked name. nullopt where none can stand.
  std::optional<std::string> symbol();
  Successor successor(Scope& scope);
  Production production();

 private:
  struct FormalModule;
  struct Predecessors;

  bool line_continues(bool inside_brackets);
  void modules(Successor& out, Scope& scope);
  std::uint16_t module_arity(ExpressionCompiler& compiler);
  FormalModule formal(Scope& scope);
  Predecessors predecessors(Scope& scope);
  bool at_arrow() const { return cursor_.looking_at("-->"); }
  void left_part(Predecessors& parts);
  void right_part(Predecessors& parts);
  void go_to_arrow_line();
  void refuse_object_production() const;
  void refuse_environment(const std::string& name, std::size_t at) const;
  void check(const Predecessors& parts) const;
  void condition(Production& out, Scope& scope);
  void weight(Production& out, Scope& scope);
  std::uint16_t number(const std::string& name, std::size_t at);

  Cursor& cursor_;
  LSystemProgram& program_;
  Scope& globals_;
};

}  // namespace cambium
