// Python's expressions of numbers, as cpfg's.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "lsystem/dialect_text.h"

namespace cambium {

/// What a name may stand for.
struct PythonNames {
  std::map<std::string, double> constants;
  std::vector<std::string> parameters;  ///< of the rule at hand; they hide constants
  bool math = false;                    ///< the file has `from math import ...`
};

/// Translates one expression at the head of `in`. Python's precedence and meaning: `not` below comparisons, which may be chained,
/// `**` from the right and before a sign, `/` of whole numbers a fraction, `//` and `%` towards minus infinity, `a if c else b`.
/// `and` and `or` give 0 or 1. Angles of math's functions are radians. Errors: InputError, at what is none of this (a list, a
/// text, an attribute, an unknown name) where it stands.
MarkedText python_expression(Cursor& in, const PythonNames& names);

/// Whether a word cannot be a name in Python.
bool is_python_keyword(const std::string& word);

}  // namespace cambium
