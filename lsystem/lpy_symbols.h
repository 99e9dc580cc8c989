// The names of L-Py's modules: those that its turtle knows, those that a file declares, and single characters.
#pragma once

#include <set>
#include <string>

#include "lsystem/source_text.h"

namespace cambium {

class LpySymbols {
 public:
  void declare(const std::string& name) { declared_.insert(name); }

  /// The symbol at the head, by L-Py's rule the longest name that it knows, or else one character; where L-Py has two names
  /// for one module the shorter. Empty where none can stand. Errors: InputError for a '@' or '?' that is no name of L-Py's.
  std::string read(Cursor& in) const;

 private:
  std::set<std::string> declared_;
};

}  // namespace cambium
