// Settings that are numbers out of their range, refused by their key. Private to skeletons/.
#pragma once

#include "blobtree/input_error.h"
#include "skeletons/number_text.h"

#include <cmath>
#include <string>

namespace cambium {

/// `key = 0.5`, with the shortest digits that read back as the same double.
inline std::string numbered(const std::string& key, double value) {
  std::string text = key + " = ";
  append_number(text, value);
  return text;
}

/// Errors: InputError (no location) unless `holds`.
inline void require_number(bool holds, const std::string& key, double value, const std::string& expected) {
  if (!holds) throw InputError({}, numbered(key, value), expected);
}

inline void require_positive(double value, const std::string& key) {
  require_number(value > 0 && std::isfinite(value), key, value, "a finite " + key + " above 0");
}

}  // namespace cambium
