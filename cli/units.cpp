#include "cli/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "raytrace/sampling.h"

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

/// The whole of `text` as a whole number in [lo, hi].
std::optional<int> whole_number(std::string_view text, int lo, int hi) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < lo || value > hi) return std::nullopt;
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

std::optional<double> parse_parts_of_pi(std::string_view text) {
  std::string_view rest = trimmed(text);
  if (rest == "pi" || rest == "-pi") return rest == "pi" ? 1 : -1;
  const auto parts = take_number(rest);
  return trimmed(rest) == "pi" ? parts : std::nullopt;
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
    const auto width = whole_number(size.substr(0, cross), 1, kLargestImageSide);
    const auto height = whole_number(size.substr(cross + 1), 1, kLargestImageSide);
    if (width && height) return {*width, *height};
  }
  throw InputError(at, quoted(text), "an image size such as 768x1024, each side 1 to 65536");
}

std::pair<std::optional<int>, int> parse_samples(std::string_view text, const SourceLocation& at) {
  const std::string_view counts = trimmed(text);
  const auto dots = counts.find("..");
  const bool both = dots != std::string_view::npos;
  const auto most = whole_number(both ? counts.substr(dots + 2) : counts, 1, kMostSamples);
  const auto least = whole_number(both ? counts.substr(0, dots) : "1", 1, most.value_or(1));
  if (!most || !least)
    throw InputError(at, quoted(text), "samples such as 16 or 1..16, each 1 to " + std::to_string(kMostSamples));
  return {both ? least : std::nullopt, *most};
}

PixelRect parse_crop(std::string_view text, const SourceLocation& at) {
  std::array<int, 4> edges{};
  std::string_view rest = text;
  for (int i = 0; i < 4; ++i) {
    const auto comma = rest.find(',');
    const auto edge = whole_number(trimmed(rest.substr(0, comma)), 0, kLargestImageSide);
    if (!edge || (comma == std::string_view::npos) != (i == 3))
      throw InputError(at, quoted(text), "a crop x0,y0,x1,y1 in pixels, such as 0,0,256,256");
    edges[i] = *edge;
    rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
  }
  return {edges[0], edges[1], edges[2], edges[3]};
}

}  // namespace cambium
