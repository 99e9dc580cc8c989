// L-Py's strings of modules, and the patterns that they are matched with, in cpfg's language.
#pragma once

#include "lsystem/dialect_text.h"
#include "lsystem/lpy_cursor.h"
#include "lsystem/lpy_symbols.h"
#include "lsystem/python_expression.h"

namespace cambium {

/// Reads from `in`, which outlives it. Errors: InputError.
class LpyStrings {
 public:
  explicit LpyStrings(LpyCursor& in) : in_(in) {}

  /// A successor up to the end of its line, and over further ones that are indented deeper than `indent`. `*`, or nothing:
  /// none.
  MarkedText successor(int indent);
  /// `left < strict > right` up to the arrow or colon. Its parameters are added to names.parameters.
  MarkedText predecessors();

  LpySymbols symbols;
  PythonNames names;  ///< of expressions

 private:
  void refuse_statement();
  MarkedText module_here();
  MarkedText argument();
  MarkedText formal_module();

  LpyCursor& in_;
};

}  // namespace cambium
