#include "cli/units.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string>

namespace cambium {
namespace {

constexpr int kLargestImageSide = 65536;
constexpr double kLargestCount = 1e15;  // doubles still count one by one

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string quoted(std::string_view text) { return "'" + std::string(text.substr(0, 60)) + "'"; }

/// The finite number that `text` begins with; cuts it off. Nothing is cut if there is none.
std::optional<double> take_number(std::string_view& text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::optional<int> whole_side(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < 1 || value > kLargestImageSide)
    return std::nullopt;
  return value;
}

}  // namespace

double parse_number(std::string_view text, const SourceLocation& at) {
  std::string_view rest = trimmed(text);
  const auto value = take_number(rest);
  if (!value || !rest.empty()) throw InputError(at, quoted(text), "a finite number");
  return *value;
}

double parse_length(std::string_view text, const SourceLocation& at) {
  std::string_view rest = trimmed(text);
  const auto value = take_number(rest);
  rest = trimmed(rest);
  double metres = 0;
  if (rest.empty() || rest == "m")
    metres = 1;
  else if (rest == "cm")
    metres = 1e-2;
  else if (rest == "mm")
    metres = 1e-3;
  if (!value || metres == 0) throw InputError(at, quoted(text), "a length such as 5mm, 2 cm or 0.1 m");
  return *value * metres;
}

double parse_positive_length(std::string_view text, const SourceLocation& at) {
  const double length = parse_length(text, at);
  if (!(length > 0)) throw InputError(at, quoted(text), "a length greater than 0, such as 5mm");
  return length;
}

std::size_t parse_count(std::string_view text, const SourceLocation& at) {
  std::string_view rest = trimmed(text);
  const auto value = take_number(rest);
  const double scale = rest.empty() ? 1 : rest == "k" ? 1e3 : rest == "M" ? 1e6 : 0;
  const double count = value.value_or(0) * scale;
  if (!(count >= 1 && count <= kLargestCount) || std::abs(count - std::round(count)) > 1e-6)
    throw InputError(at, quoted(text), "a whole number of at least 1, such as 20000, 50k or 1.2M");
  return static_cast<std::size_t>(std::llround(count));
}

std::pair<int, int> parse_image_size(std::string_view text, const SourceLocation& at) {
  const std::string_view size = trimmed(text);
  const auto cross = size.find_first_of("xX");
  if (cross != std::string_view::npos) {
    const auto width = whole_side(size.substr(0, cross));
    const auto height = whole_side(size.substr(cross + 1));
    if (width && height) return {*width, *height};
  }
  throw InputError(at, quoted(text), "an image size such as 768x1024, each side 1 to 65536");
}

}  // namespace cambium
