#include "lsystem/value_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "lsystem/module_parser.h"

namespace cambium {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

bool ValueReader::at_end() {
  cursor_.skip_space();
  return cursor_.at_end();
}

bool ValueReader::at_line_end() {
  cursor_.skip_space();
  return cursor_.at_line_end();
}

void ValueReader::next_line() {
  while (!cursor_.at_line_end()) cursor_.advance();
  if (!cursor_.at_end()) cursor_.advance();
}

Place ValueReader::place() {
  cursor_.skip_space();
  return cursor_.place();
}

std::optional<double> ValueReader::number_if_any() {
  cursor_.skip_space();
  const std::string& text = cursor_.source().text;
  const std::size_t begin = cursor_.position() + (cursor_.peek() == '+' ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  cursor_.seek(static_cast<std::size_t>(end - text.data()));
  return value;
}

double ValueReader::number(std::string_view what) {
  const auto value = number_if_any();
  if (!value) fail(std::string(what));
  return *value;
}

double ValueReader::positive(std::string_view what) {
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  const double value = number(what);
  if (!(value > 0))
    cursor_.fail_at(begin, cursor_.source().text.substr(begin, cursor_.position() - begin), std::string(what) + " above 0");
  return value;
}

std::size_t ValueReader::count(std::string_view what, std::size_t least, std::size_t most) {
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  const double value = number(what);
  if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most)) || value != std::floor(value))
    cursor_.fail_at(begin, cursor_.source().text.substr(begin, cursor_.position() - begin),
                    std::string(what) + ", a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return static_cast<std::size_t>(value);
}

Vec3 ValueReader::vector(std::string_view what) {
  Vec3 out(0.0);
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    out[axis] = number(what);
    if (axis < 2) cursor_.accept(',');
  }
  return out;
}

Vec3 ValueReader::direction(std::string_view what) {
  cursor_.skip_space();
  const std::size_t begin = cursor_.position();
  const Vec3 out = vector(what);
  const double length = glm::length(out);
  if (!(length > 1e-100) || !std::isfinite(length))
    cursor_.fail_at(begin, "a vector without a direction", std::string(what));
  return out / length;
}

std::string ValueReader::word() {
  cursor_.skip_space();
  std::string out;
  for (; !cursor_.at_end() && !is_blank(cursor_.peek()); cursor_.advance()) out += cursor_.peek();
  return out;
}

std::string ValueReader::word(std::string_view what) {
  std::string out = word();
  if (out.empty()) fail(std::string(what));
  return out;
}

std::string ValueReader::label() {
  cursor_.skip_space();
  const std::string& text = cursor_.source().text;
  const std::size_t begin = cursor_.position();
  const std::size_t colon = text.find(':', begin);
  if (colon >= std::min(text.find('\n', begin), text.size())) return {};
  cursor_.seek(colon + 1);
  std::string out = lower_case(text.substr(begin, colon - begin));
  while (!out.empty() && is_blank(out.back())) out.pop_back();
  return out;
}

bool ValueReader::accept(std::string_view text) {
  cursor_.skip_space();
  if (!cursor_.looking_at(text)) return false;
  cursor_.advance(text.size());
  return true;
}

void ValueReader::expect(std::string_view text) {
  if (!accept(text)) fail("'" + std::string(text) + "'");
}

void ValueReader::fail(std::string expected) {
  cursor_.skip_space();
  cursor_.fail(std::move(expected));
}

}  // namespace cambium
