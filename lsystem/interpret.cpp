// From a string of modules to a plant skeleton: the homomorphism, then the turtle's walk.
#include <algorithm>

#include "lsystem/lsystem.h"
#include "lsystem/program.h"
#include "lsystem/rewriting_pass.h"
#include "lsystem/turtle_walk.h"

namespace cambium {
namespace {

bool has_homomorphism(const LSystemProgram& program) {
  return std::any_of(program.systems.begin(), program.systems.end(),
                     [](const System& system) { return !system.homomorphism.empty(); });
}

/// What the turtle sees of a string. nullopt if cancelled.
std::optional<ModuleString> drawn_form(const ModuleString& string, const LSystemProgram& program,
                                       const TurtleOptions& options, const RunOptions& run) {
  ModuleString drawn;
  RewritingPass pass(program, options.max_modules, run);
  pass.seed = program.main().homomorphism_seed.value_or(string.seed);
  if (string.variables.size() == pass.variables.size()) pass.variables = string.variables;
  if (!pass.rewrite(string, Stage::kHomomorphism, drawn)) return std::nullopt;
  drawn.names = program.symbols.names();
  return drawn;
}

std::optional<Turtled> draw(const ModuleString& string, const LSystem& system, const TurtleOptions& options,
                            const RunOptions& run, TurtleAnswers* answers) {
  const LSystemProgram& program = system.program();
  const std::string file = program.tables.files.empty() ? std::string() : program.tables.files[0];
  if (!has_homomorphism(program)) return TurtleWalk(string, file, options, run, answers).walk();
  const auto drawn = drawn_form(string, program, options, run);
  if (!drawn) return std::nullopt;
  return TurtleWalk(*drawn, file, options, run, answers).walk();
}

}  // namespace

std::optional<Turtled> interpret(const ModuleString& string, const LSystem& system, const TurtleOptions& options,
                                 const RunOptions& run) {
  return draw(string, system, options, run, nullptr);
}

// What no rule of the homomorphism matches keeps its key.
bool answer_queries(ModuleString& string, const LSystem& system, const TurtleOptions& options, const RunOptions& run) {
  TurtleAnswers answers;
  if (!draw(string, system, options, run, &answers)) return false;
  for (std::size_t i = 0; i < string.size(); ++i) {
    if (string.names[string.symbol[i]][0] != '?' || string.arity(i) != 3) continue;
    const auto found = answers.find(string.key[i]);
    if (found == answers.end()) continue;
    for (glm::length_t axis = 0; axis < 3; ++axis)
      string.parameters[string.first[i] + static_cast<std::size_t>(axis)] = found->second[axis];
  }
  return true;
}

}  // namespace cambium
