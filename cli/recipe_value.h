// One value of a recipe, read as the type that is wanted or refused with its place. Private to the recipe's reading.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blobtree/geometry.h"
#include "blobtree/input_error.h"

namespace cambium {

/// Where a recipe's values come from: the file, and the texts of --set by the key they set.
struct RecipeSource {
  std::filesystem::path file;
  std::vector<std::pair<std::string, std::string>> overrides;  ///< dotted key, whole text

  /// The place of a node or key; `path` is its dotted key. A node that --set made has no region of its own.
  SourceLocation location(const toml::source_region& region, std::string_view path) const;
};

class RecipeValue {
 public:
  RecipeValue(const RecipeSource& source, const toml::node& node, std::string path)
      : source_(&source), node_(&node), path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  SourceLocation location() const { return source_->location(node_->source(), path_); }
  [[noreturn]] void refuse(const std::string& expected) const;

  bool flag() const;
  std::string text() const;
  double number() const;                      ///< finite
  double number(double lo, double hi) const;  ///< in [lo, hi]
  double positive() const;
  std::int64_t integer(std::int64_t lo, std::int64_t hi) const;
  double length() const;  ///< metres; a number, or a string with a unit
  double positive_length() const;
  double not_negative_length() const;
  /// In radians: a number of degrees from lo to hi, or a string in parts of pi such as "0.3pi".
  double degrees(double lo = -3600, double hi = 3600) const;
  Vec3 point() const;                                                  ///< three lengths
  Vec3 direction() const;                                              ///< three numbers, not all zero
  Vec3 color() const;                                                  ///< linear; [r, g, b] linear or "#rrggbb" sRGB
  std::filesystem::path file() const;                                  ///< relative to the recipe's folder
  std::size_t choice(std::initializer_list<const char*> names) const;  ///< index of the name it is

  bool is_array() const { return node_->is_array(); }
  bool is_table() const { return node_->is_table(); }
  bool is_text() const { return node_->is_string(); }
  bool is_flag() const { return node_->is_boolean(); }
  std::vector<RecipeValue> elements() const;  ///< of an array
  std::vector<RecipeValue> elements(std::size_t count) const;
  const toml::table& table() const;
  const RecipeSource& source() const { return *source_; }
  std::string child_path(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  }

 private:
  const RecipeSource* source_;
  const toml::node* node_;
  std::string path_;
};

/// One key that a table may have, and what it does to the part of the recipe that the table describes.
template <class Part>
struct KeyRule {
  const char* key;
  void (*read)(const RecipeValue& value, Part& part);
};

template <class Part, std::size_t N>
std::vector<const char*> keys_of(const KeyRule<Part> (&rules)[N]) {
  std::vector<const char*> keys;
  for (const auto& rule : rules) keys.push_back(rule.key);
  return keys;
}

/// Errors: InputError at a key that is not among `known`.
void refuse_unknown_keys(const RecipeValue& table, const std::vector<const char*>& known);

/// Reads the table's members in the order of the rules. Errors: InputError for keys without a rule; those of `also_known`
/// are left to the caller.
template <class Part, std::size_t N>
void read_table(const RecipeValue& table, const KeyRule<Part> (&rules)[N], Part& part,
                const std::vector<const char*>& also_known = {}) {
  std::vector<const char*> known = keys_of(rules);
  known.insert(known.end(), also_known.begin(), also_known.end());
  refuse_unknown_keys(table, known);
  for (const auto& rule : rules)
    if (const toml::node* node = table.table().get(rule.key))
      rule.read(RecipeValue(table.source(), *node, table.child_path(rule.key)), part);
}

}  // namespace cambium
