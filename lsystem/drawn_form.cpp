#include "lsystem/drawn_form.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "lsystem/dialect_turtle.h"
#include "lsystem/rewriting_pass.h"

namespace cambium {
namespace {

constexpr std::size_t kPollModules = 1 << 16;

bool has_homomorphism(const LSystemProgram& program) {
  return std::any_of(program.systems.begin(), program.systems.end(),
                     [](const System& system) { return !system.homomorphism.empty(); });
}

std::uint64_t drawing_seed(const ModuleString& string, const LSystemProgram& program) {
  return program.main().homomorphism_seed.value_or(string.seed);
}

/// False if cancelled.
bool apply_homomorphism(const ModuleString& string, const LSystemProgram& program, const TurtleOptions& options,
                        const RunOptions& run, ModuleString& out, std::vector<std::uint32_t>* origins) {
  RewritingPass pass(program, options.max_modules, run);
  pass.seed = drawing_seed(string, program);
  if (string.variables.size() == pass.variables.size()) pass.variables = string.variables;
  out.names = program.symbols.names();
  if (!origins) return pass.rewrite(string, Stage::kHomomorphism, out);
  std::vector<Rewriter::Origin> all;
  if (!pass.rewrite(string, Stage::kHomomorphism, out, all)) return false;
  origins->clear();
  for (const Rewriter::Origin& origin : all) origins->push_back(origin.parent);
  return true;
}

/// False if cancelled. `origins`: of `string`'s modules before, of `out`'s after.
bool respell(const ModuleString& string, const LSystemProgram& program, const TurtleOptions& options, const RunOptions& run,
             std::uint64_t seed, ModuleString& out, std::vector<std::uint32_t>* origins) {
  DialectTurtle turtle(program, options, string.names, seed);
  clear(out);
  std::vector<std::uint32_t> from;
  for (std::size_t i = 0; i < string.size(); ++i) {
    if (i % kPollModules == 0 && run.cancelled()) return false;
    turtle.respell(string, i, out);
    if (origins) from.resize(out.size(), (*origins)[i]);
  }
  if (origins) *origins = std::move(from);
  out.names = turtle.names();
  return true;
}

}  // namespace

bool is_its_drawn_form(const LSystemProgram& program) {
  return program.dialect == Dialect::kCpfg && !has_homomorphism(program);
}

std::optional<ModuleString> drawn_form(const ModuleString& string, const LSystemProgram& program,
                                       const TurtleOptions& options, const RunOptions& run,
                                       std::vector<std::uint32_t>* origins) {
  ModuleString drawn;
  const bool rewrites = has_homomorphism(program);
  if (rewrites) {
    if (!apply_homomorphism(string, program, options, run, drawn, origins)) return std::nullopt;
  } else if (origins) {
    origins->resize(string.size());
    std::iota(origins->begin(), origins->end(), 0u);
  }
  if (program.dialect == Dialect::kCpfg) return rewrites ? std::move(drawn) : string;
  ModuleString respelled;
  const std::uint64_t seed = drawing_seed(string, program);
  if (!respell(rewrites ? drawn : string, program, options, run, seed, respelled, origins)) return std::nullopt;
  return respelled;
}

}  // namespace cambium
