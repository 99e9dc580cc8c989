// From a string of modules to a plant skeleton: its drawn form, then the turtle's walk.
#include "lsystem/drawn_form.h"
#include "lsystem/growth.h"
#include "lsystem/lsystem.h"
#include "lsystem/program.h"
#include "lsystem/turtle_walk.h"

namespace cambium {
namespace {

std::string file_of(const LSystem& system) {
  const std::vector<std::string>& files = system.program().tables.files;
  return files.empty() ? std::string() : files[0];
}

std::optional<Turtled> draw(const ModuleString& string, const LSystem& system, const TurtleOptions& options,
                            const RunOptions& run, TurtleAnswers* answers) {
  const LSystemProgram& program = system.program();
  const std::string file = file_of(system);
  if (is_its_drawn_form(program)) return TurtleWalk(string, file, program.view, options, run, answers).walk();
  const auto drawn = drawn_form(string, program, options, run);
  if (!drawn) return std::nullopt;
  return TurtleWalk(*drawn, file, program.view, options, run, answers).walk();
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

std::optional<Turtled> interpret(const GrownString& grown, const LSystem& system, const TurtleOptions& options,
                                 const RunOptions& run) {
  const std::string file = file_of(system);
  TurtleWalk walk(grown.string, file, system.program().view, options, run, nullptr);
  walk.grow(grown.parts);
  return walk.walk();
}

}  // namespace cambium
