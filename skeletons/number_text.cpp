#include "skeletons/number_text.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace cambium {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

bool read_double(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return false;
  if (error == std::errc()) return true;
  // Out of range: too small is as good as zero, too large is not a number that we can hold.
  if (error != std::errc::result_out_of_range) return false;
  const std::size_t exponent = text.find_first_of("eE");
  if (exponent == std::string_view::npos || exponent + 1 >= text.size() || text[exponent + 1] != '-') return false;
  value = 0;
  return true;
}

}  // namespace

std::vector<TextField> split_at_blanks(std::string_view line) {
  std::vector<TextField> fields;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && is_blank(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    if (i > begin) fields.push_back({line.substr(begin, i - begin), static_cast<int>(begin) + 1});
  }
  return fields;
}

std::vector<TextField> split_at(std::string_view line, char separator) {
  std::vector<TextField> fields;
  std::size_t begin = 0;
  while (true) {
    std::size_t end = line.find(separator, begin);
    if (end == std::string_view::npos) end = line.size();
    std::size_t first = begin, last = end;
    while (first < last && is_blank(line[first])) ++first;
    while (last > first && is_blank(line[last - 1])) --last;
    if (last - first >= 2 && line[first] == '"' && line[last - 1] == '"') ++first, --last;
    fields.push_back({line.substr(first, last - first), static_cast<int>(first) + 1});
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

std::string quoted(std::string_view text) {
  if (text.empty()) return "nothing";
  std::string out(1, '\'');
  out.append(text.substr(0, text.size() > 40 ? 37 : text.size()));
  out.append(text.size() > 40 ? "...'" : "'");
  return out;
}

double parse_finite(const TextField& field, const std::string& file, int line, const std::string& what) {
  double value = 0;
  if (!read_double(field.text, value) || !std::isfinite(value))
    throw InputError({file, line, field.column}, quoted(field.text), "a finite number for " + what);
  return value;
}

double parse_positive(const TextField& field, const std::string& file, int line, const std::string& what) {
  const double value = parse_finite(field, file, line, what);
  if (!(value > 0)) throw InputError({file, line, field.column}, quoted(field.text), "a number above 0 for " + what);
  return value;
}

std::int64_t parse_integer(const TextField& field, const std::string& file, int line, const std::string& what) {
  constexpr double kLargest = 9007199254740992.0;  // every integer up to here is a double
  double value = 0;
  if (!read_double(field.text, value) || !(std::abs(value) <= kLargest) || value != std::floor(value))
    throw InputError({file, line, field.column}, quoted(field.text), "a whole number for " + what);
  return static_cast<std::int64_t>(value);
}

void append_number(std::string& out, double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, error == std::errc() ? end : buffer);
}

LineReader::LineReader(std::string_view text) : rest_(text) {
  if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);  // byte-order mark
}

bool LineReader::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return true;
}

}  // namespace cambium
