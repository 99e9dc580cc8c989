// What the turtle walks over: the homomorphism of a string, in cpfg's symbols.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lsystem/lsystem.h"
#include "lsystem/program.h"

namespace cambium {

/// Whether every string is its own drawn form: there is no homomorphism, and the symbols are cpfg's.
bool is_its_drawn_form(const LSystemProgram& program);

/// nullopt if cancelled. If `origins` is given it gets the module of `string` that each module of the result comes from, and
/// one thread does all. Errors: InputError of the homomorphism; more than options.max_modules.
std::optional<ModuleString> drawn_form(const ModuleString& string, const LSystemProgram& program,
                                       const TurtleOptions& options, const RunOptions& run,
                                       std::vector<std::uint32_t>* origins = nullptr);

}  // namespace cambium
