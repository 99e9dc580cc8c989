// JSON whose values know where they stand in the file, so that every reader can name line and column.
#pragma once

#include "blobtree/geometry.h"
#include "blobtree/input_error.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

class JsonValue;

/// A parsed document: one flat arena, so nesting of any depth costs no call stack. Immutable; thread safe.
/// Numbers are the nearest doubles; NaN, infinities and numbers beyond double are refused, as are duplicate keys.
class LocatedJson {
 public:
  /// Errors: InputError naming the line and column of the first mistake. Cost: linear in the text.
  static LocatedJson parse(std::string text, std::string file);

  JsonValue root() const;
  const std::string& file() const { return file_; }

 private:
  friend class JsonValue;
  friend class LocatedJsonBuilder;

  struct Cell {
    std::uint64_t offset : 56;   // of the first character in text_
    std::uint64_t kind : 8;
    union {
      double number;
      bool truth;
      struct { std::uint32_t first, count; } span;  // String: characters in pool_; Array, Object: entries in links_
    };
  };

  /// Cost: the same wherever on a line it stands, however long the line.
  SourceLocation location_of(std::size_t offset) const;
  std::size_t characters_before(std::size_t offset) const;

  std::string file_, text_, pool_;
  std::vector<Cell> cells_;             // the root is the last one
  std::vector<std::uint32_t> links_;    // cells of arrays in order; of objects key, value, key, value ...
  std::vector<std::size_t> line_starts_;
  std::vector<std::size_t> characters_before_;   // so many characters before every so many bytes
};

/// A value of a document, cheap to copy; must not outlive the document. Everything that a wrong file can cause is an
/// InputError at the value concerned. Columns count characters, not bytes.
class JsonValue {
 public:
  enum class Kind { Null, Boolean, Number, String, Array, Object };

  Kind kind() const;
  SourceLocation location() const;
  [[noreturn]] void fail(std::string found, std::string expected) const;
  /// For messages: `the number 3`, `the string "x"`, `an array of 2`, `null`.
  std::string describe() const;

  double number() const;
  long double extended_number() const;                      ///< with the digits beyond double, where there are any
  std::int64_t integer(std::int64_t lowest, std::int64_t highest) const;
  bool boolean() const;
  std::string_view string() const;

  /// Array. elements(n) also checks the length.
  std::size_t size() const;
  JsonValue operator[](std::size_t i) const;               ///< precondition: i < size()
  const JsonValue& elements(std::size_t count) const;
  Vec3 vec3() const;                                        ///< [x, y, z]

  /// Object, members in the file's order.
  std::size_t member_count() const;
  JsonValue member_key(std::size_t i) const;                ///< a string value, located at the key
  JsonValue member(std::size_t i) const;
  std::optional<JsonValue> find(std::string_view key) const;
  JsonValue at(std::string_view key) const;                 ///< a missing key is an error at the object
  double number_or(std::string_view key, double absent) const;
  /// An error at the first key that is not one of these.
  void expect_keys(std::initializer_list<std::string_view> known) const;

 private:
  friend class LocatedJson;
  JsonValue(const LocatedJson* document, std::uint32_t cell) : document_(document), cell_(cell) {}
  const LocatedJson::Cell& cell() const { return document_->cells_[cell_]; }
  const LocatedJson::Cell& expect(Kind kind) const;

  const LocatedJson* document_;
  std::uint32_t cell_;
};

inline LocatedJson parse_json(std::string_view text, std::string file) {
  return LocatedJson::parse(std::string(text), std::move(file));
}
/// Errors: InputError, also for a file that cannot be read.
LocatedJson load_json(const std::filesystem::path& path);

}  // namespace cambium
