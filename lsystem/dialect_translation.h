// L-systems in the languages of other programs: the parts of them that are rules and not programs.
//
// A dialect is translated into cpfg's language, character by character: what is translated keeps the place that it came
// from, so that there is one parser, one engine, and errors point into the file as it was written. Symbols keep their own
// names; what these mean to the turtle is DialectTurtle's business. docs/lsystems.md says what is read.
#pragma once

#include <filesystem>
#include <string_view>

#include "lsystem/dialect.h"
#include "lsystem/source_text.h"

namespace cambium {

/// What a Houdini file says beside its rules, with the node's own defaults.
struct HoudiniValues {
  double step = 0.1, step_scale = 0.9;             ///< metres of an F; what `"` multiplies and `_` divides them by
  double angle = 28, angle_scale = 0.7;            ///< degrees; of `;` and `@`
  double thickness = 0.05, thickness_scale = 0.8;  ///< a diameter, metres; of `!` and `?`
  double gravity = 0;                              ///< of a T without parameter
};

/// An L-Py file up to its `endlsystem`. Errors: InputError at the first construct that is no rule but Python.
SourceText cpfg_from_lpy(std::string_view text, const std::filesystem::path& file);

/// Premise, rules and values of a Houdini L-System node, a line each. Errors: InputError.
SourceText cpfg_from_houdini(std::string_view text, const std::filesystem::path& file, HoudiniValues& values);

}  // namespace cambium
