// `define:` ... what an L-system declares before its axiom.
#pragma once

#include <vector>

#include "lsystem/expression_compiler.h"

namespace cambium {

/// Reads the `{ array a[2][3] = {...}; external b; }` of a `define:`. Sizes and values are constant expressions; values fill
/// an array in row-major order, inner braces only group, and what is not given is 0. `external` names a variable or array of
/// an L-system that stands before this one in the file. Errors: InputError.
class ArrayDefinitions {
 public:
  /// `earlier`: names of the L-systems before this one. `values`: initial values of all variables so far; grows.
  ArrayDefinitions(Cursor& cursor, SystemNames& names, const std::vector<const SystemNames*>& earlier,
                   std::vector<double>& values)
      : cursor_(cursor), names_(names), earlier_(earlier), values_(values) {}

  void read();

 private:
  void array();
  void external();
  std::vector<std::uint32_t> sizes();
  void initial_values(const ArrayInfo& array, std::size_t count);
  void check_new(const std::string& name, std::size_t at) const;

  Cursor& cursor_;
  SystemNames& names_;
  const std::vector<const SystemNames*>& earlier_;
  std::vector<double>& values_;
};

}  // namespace cambium
