#include "lsystem/array_definitions.h"

#include <cmath>
#include <utility>

namespace cambium {
namespace {

constexpr std::size_t kMaxElements = 1'000'000;

}  // namespace

void ArrayDefinitions::read() {
  const Cursor::LineEnds inside(cursor_, true);
  cursor_.expect('{', "after 'define:'");
  while (!cursor_.accept('}')) {
    cursor_.skip_space();
    const std::size_t at = cursor_.position();
    const std::string keyword = cursor_.word();
    if (keyword != "array" && keyword != "external") cursor_.fail_at(at, cursor_.describe(at), "'array', 'external' or '}'");
    do {
      if (keyword == "array")
        array();
      else
        external();
    } while (cursor_.accept(','));
    cursor_.expect(';', "after the definition");
  }
}

void ArrayDefinitions::check_new(const std::string& name, std::size_t at) const {
  if (name.empty()) cursor_.fail("a name");
  if (names_.arrays.count(name) || names_.variables.count(name))
    cursor_.fail_at(at, "'" + name + "' twice", "different names");
}

// `[2,3]` or `[2][3]`.
std::vector<std::uint32_t> ArrayDefinitions::sizes() {
  std::vector<std::uint32_t> out;
  std::size_t count = 1;
  cursor_.expect('[', "and the array's size");
  while (true) {
    cursor_.skip_space();
    const std::size_t at = cursor_.position();
    const double size = constant_expression(cursor_);
    if (size < 1 || size != std::floor(size) || size * static_cast<double>(count) > kMaxElements)
      cursor_.fail_at(at, cursor_.describe(at), "a size of 1 to 1000000 elements in all");
    out.push_back(static_cast<std::uint32_t>(size));
    count *= out.back();
    if (cursor_.accept(',')) continue;
    cursor_.expect(']', "after the array's size");
    if (!cursor_.accept('[')) return out;
  }
}

void ArrayDefinitions::array() {
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  ArrayInfo array;
  array.name = cursor_.word();
  check_new(array.name, at);
  array.first = names_.slots;
  array.sizes = sizes();
  std::size_t count = 1;
  for (const std::uint32_t size : array.sizes) count *= size;
  if (names_.slots + count > kMaxElements) cursor_.fail_at(at, "more than 1000000 array elements", "smaller arrays");
  names_.slots += static_cast<std::uint32_t>(count);
  values_.resize(names_.slots, 0.0);
  if (cursor_.accept('=')) initial_values(array, count);
  names_.arrays.emplace(array.name, static_cast<std::uint32_t>(names_.tables.arrays.size()));
  names_.tables.arrays.push_back(std::move(array));
}

void ArrayDefinitions::initial_values(const ArrayInfo& array, std::size_t count) {
  cursor_.expect('{', "before the array's values");
  std::size_t given = 0;
  for (int depth = 1; depth > 0;) {
    cursor_.skip_space();
    if (cursor_.accept('{')) {
      ++depth;
    } else if (cursor_.accept('}')) {
      --depth;
    } else if (!(given > 0 && cursor_.accept(','))) {
      const std::size_t at = cursor_.position();
      const double value = constant_expression(cursor_);
      if (given == count) cursor_.fail_at(at, "more values than the array holds", std::to_string(count));
      values_[array.first + given++] = value;
    }
  }
}

void ArrayDefinitions::external() {
  cursor_.skip_space();
  const std::size_t at = cursor_.position();
  const std::string name = cursor_.word();
  check_new(name, at);
  const bool is_array = cursor_.accept('[');
  if (is_array) {
    cursor_.seek(cursor_.position() - 1);
    sizes();
  }
  for (const SystemNames* earlier : earlier_) {
    const auto& wanted = is_array ? earlier->arrays : earlier->variables;
    const auto found = wanted.find(name);
    if (found == wanted.end()) continue;
    (is_array ? names_.arrays : names_.variables).emplace(name, found->second);
    return;
  }
  cursor_.fail_at(at, "'" + name + "'",
                  is_array ? "an array of an L-system before this one" : "a variable of an L-system before this one");
}

}  // namespace cambium
