#include "cli/recipe_value.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "cli/units.h"

namespace cambium {
namespace {

std::string describe(const toml::node& node) {
  if (const auto* value = node.as_string()) return "the string '" + value->get().substr(0, 60) + "'";
  if (const auto* value = node.as_integer()) return fmt::format("the number {}", value->get());
  if (const auto* value = node.as_floating_point()) return fmt::format("the number {}", value->get());
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_array()) return fmt::format("an array of {}", value->size());
  if (node.is_table()) return "a table";
  return "a date or time";
}

bool concerns(std::string_view set_key, std::string_view path) {
  const std::string_view shorter = set_key.size() < path.size() ? set_key : path;
  const std::string_view longer = set_key.size() < path.size() ? path : set_key;
  return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '.');
}

double linear_from_srgb(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

}  // namespace

SourceLocation RecipeSource::location(const toml::source_region& region, std::string_view path) const {
  if (region.begin.line > 0)
    return {file.string(), static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
  for (auto it = overrides.rbegin(); it != overrides.rend(); ++it)
    if (concerns(it->first, path)) return {"--set " + it->second};
  return {file.string()};
}

void RecipeValue::refuse(const std::string& expected) const {
  throw InputError(location(), describe(*node_) + " for '" + path_ + "'", expected);
}

bool RecipeValue::flag() const {
  const auto value = node_->value_exact<bool>();
  if (!value) refuse("true or false");
  return *value;
}

std::string RecipeValue::text() const {
  const auto value = node_->value_exact<std::string>();
  if (!value) refuse("a string");
  return *value;
}

double RecipeValue::number() const {
  const auto value = node_->is_number() ? node_->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) refuse("a finite number");
  return *value;
}

double RecipeValue::number(double lo, double hi) const {
  const std::string expected = fmt::format("a number from {} to {}", lo, hi);
  const auto value = node_->is_number() ? node_->value<double>() : std::nullopt;
  if (!value || !(lo <= *value && *value <= hi)) refuse(expected);
  return *value;
}

double RecipeValue::positive() const {
  const auto value = node_->is_number() ? node_->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value) || !(*value > 0)) refuse("a number greater than 0");
  return *value;
}

std::int64_t RecipeValue::integer(std::int64_t lo, std::int64_t hi) const {
  const auto value = node_->value_exact<std::int64_t>();
  if (!value || *value < lo || *value > hi) refuse(fmt::format("a whole number from {} to {}", lo, hi));
  return *value;
}

double RecipeValue::length() const {
  if (is_text()) return parse_length(text(), location());
  if (!node_->is_number()) refuse("a length, such as 0.05 (metres) or \"5cm\"");
  return number();
}

double RecipeValue::positive_length() const {
  const double value = length();
  if (!(value > 0)) refuse("a length greater than 0");
  return value;
}

double RecipeValue::not_negative_length() const {
  const double value = length();
  if (value < 0) refuse("a length of at least 0");
  return value;
}

double RecipeValue::degrees(double lo, double hi) const {
  if (!is_text()) return number(lo, hi) * std::numbers::pi / 180;
  const auto parts = parse_parts_of_pi(text());
  if (!parts || !(lo <= *parts * 180 && *parts * 180 <= hi))
    refuse(fmt::format("a number from {} to {} (degrees), or a string such as \"0.1pi\" within", lo, hi));
  return *parts * std::numbers::pi;
}

Vec3 RecipeValue::point() const {
  const auto parts = elements(3);
  return {parts[0].length(), parts[1].length(), parts[2].length()};
}

Vec3 RecipeValue::direction() const {
  const auto parts = elements(3);
  const Vec3 value{parts[0].number(), parts[1].number(), parts[2].number()};
  if (value == Vec3(0.0)) refuse("a direction that is not zero");
  return value;
}

Vec3 RecipeValue::color() const {
  if (is_text()) {
    const std::string value = text();
    unsigned rgb = 0;
    const auto [end, error] = std::from_chars(value.data() + 1, value.data() + value.size(), rgb, 16);
    if (value.size() != 7 || value[0] != '#' || error != std::errc{} || end != value.data() + 7)
      refuse("a colour such as \"#8a7358\"");
    return {linear_from_srgb((rgb >> 16) / 255.0), linear_from_srgb((rgb >> 8 & 255) / 255.0),
            linear_from_srgb((rgb & 255) / 255.0)};
  }
  const auto parts = elements(3);
  return {parts[0].number(0, 1000), parts[1].number(0, 1000), parts[2].number(0, 1000)};
}

std::filesystem::path RecipeValue::file() const {
  const std::string name = text();
  if (name.empty()) refuse("the name of a file");
  return source_->file.parent_path() / name;
}

std::size_t RecipeValue::choice(std::initializer_list<const char*> names) const {
  std::string listed;
  std::size_t index = 0;
  for (const char* name : names) {
    if (is_text() && text() == name) return index;
    listed += (index++ ? ", " : "one of ") + std::string(name);
  }
  refuse(listed);
}

std::vector<RecipeValue> RecipeValue::elements() const {
  const toml::array* array = node_->as_array();
  if (!array) refuse("an array");
  std::vector<RecipeValue> result;
  for (std::size_t i = 0; i < array->size(); ++i)
    result.emplace_back(*source_, *array->get(i), child_path(std::to_string(i)));
  return result;
}

std::vector<RecipeValue> RecipeValue::elements(std::size_t count) const {
  const toml::array* array = node_->as_array();
  if (!array || array->size() != count) refuse(fmt::format("an array of {}", count));
  return elements();
}

const toml::table& RecipeValue::table() const {
  const toml::table* table = node_->as_table();
  if (!table) refuse("a table");
  return *table;
}

void refuse_unknown_keys(const RecipeValue& table, const std::vector<const char*>& known) {
  for (const auto& [key, node] : table.table()) {
    bool is_known = false;
    std::string listed;
    for (const char* name : known) {
      is_known = is_known || key.str() == name;
      listed += (listed.empty() ? "" : ", ") + std::string(name);
    }
    if (!is_known)
      throw InputError(table.source().location(key.source(), table.child_path(key.str())),
                       "unknown key '" + table.child_path(key.str()) + "'", "one of " + listed);
  }
}

}  // namespace cambium
