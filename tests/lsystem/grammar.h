// Short ways to parse and derive in tests.
#pragma once

#include "lsystem/lsystem.h"

#include <cmath>
#include <map>
#include <string>

namespace cambium::test {

inline LSystem parsed(const std::string& text) { return LSystem::parse(text, "test.l"); }

/// A whole file around an axiom and productions.
inline std::string grammar(const std::string& axiom, const std::string& productions, const std::string& settings = "") {
  return "lsystem: test\n" + settings + "\naxiom: " + axiom + "\n" + productions + "\nendlsystem\n";
}

inline ModuleString derived(const LSystem& system, int steps, std::uint64_t seed = 0) {
  DeriveOptions options;
  options.steps = steps;
  options.seed = seed;
  return derive(system, options, {}).value();
}

inline std::string derived_text(const std::string& text, int steps, std::uint64_t seed = 0) {
  return to_text(derived(parsed(text), steps, seed));
}

inline std::map<std::string, std::size_t> counts(const ModuleString& string) {
  std::map<std::string, std::size_t> out;
  for (const std::uint16_t symbol : string.symbol) ++out[string.names[symbol]];
  return out;
}

inline Turtled turtled(const std::string& axiom, const TurtleOptions& options = {}) {
  const LSystem system = parsed(grammar(axiom, ""));
  return interpret(derived(system, 0), system, options, {}).value();
}

/// The error that parsing, deriving a few steps and interpreting `text` ends in; fails the test if there is none.
inline std::optional<InputError> error_of(const std::string& text, int steps = 2) {
  try {
    const LSystem system = parsed(text);
    interpret(derived(system, steps), system, {}, {});
  } catch (const InputError& error) {
    return error;
  }
  return std::nullopt;
}

}  // namespace cambium::test
