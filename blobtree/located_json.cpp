#include "blobtree/located_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>

namespace cambium {
namespace {

using Kind = JsonValue::Kind;

constexpr std::size_t kMarkEvery = 1024;   // bytes

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// A short piece of the text for a message.
std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  if (text.size() <= kLongest) return fmt::format("`{}`", text);
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a character
  return fmt::format("`{}...`", text.substr(0, end));
}

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::Null: return "null";
    case Kind::Boolean: return "true or false";
    case Kind::Number: return "a number";
    case Kind::String: return "a string";
    case Kind::Array: return "an array";
    case Kind::Object: return "an object";
  }
  return "";
}

}  // namespace

// Receives the library's events, which come in the order of the text, and follows them in the text with a cursor: that is
// how values learn where they stand. The library has accepted everything up to the event, so the cursor needs no checks
// of its own.
class LocatedJsonBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit LocatedJsonBuilder(LocatedJson& document) : document_(document), text_(document.text_) {}

  bool null() override { return leaf(Kind::Null, skip_literal(4)), true; }
  bool boolean(bool truth) override {
    leaf(Kind::Boolean, skip_literal(truth ? 4 : 5)).truth = truth;
    return true;
  }
  bool number_integer(number_integer_t) override { return number(); }
  bool number_unsigned(number_unsigned_t) override { return number(); }
  bool number_float(number_float_t, const string_t&) override { return number(); }
  bool string(string_t& text) override {
    const auto first = static_cast<std::uint32_t>(document_.pool_.size());
    document_.pool_ += text;
    leaf(Kind::String, skip_string()).span = {first, static_cast<std::uint32_t>(text.size())};
    return true;
  }
  bool key(string_t& text) override { return string(text); }
  bool binary(binary_t&) override { return false; }  // not in JSON text

  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_array() override { return close(Kind::Array); }
  bool end_object() override {
    refuse_duplicate_keys();
    return close(Kind::Object);
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    const std::string_view message = error.what();
    const std::size_t read = std::min(position > 0 ? position - 1 : 0, text_.size());  // the last character looked at
    // Between the cursor and the mistake stand at most one separator that was still right, and white space.
    skip_space();
    if (cursor_ < read && (text_[cursor_] == ',' || text_[cursor_] == ':')) {
      ++cursor_;
      skip_space();
    }
    const std::size_t begin = std::min(cursor_, text_.size());
    const auto fail = [this](std::size_t where, std::string found, std::string expected) {
      throw InputError(document_.location_of(where), std::move(found), std::move(expected));
    };
    const auto has = [&](std::string_view part) { return message.find(part) != std::string_view::npos; };
    if (begin >= text_.size()) fail(text_.size(), "the end of the file", expectation(message));
    if (has("number overflow"))
      fail(begin, quote(text_.substr(begin, word_end(begin) - begin)), "a number that a double can hold");
    if (has("invalid string")) {
      if (read >= text_.size()) fail(begin, "a string without its closing quote", "a closing quote");
      fail(read, reason(message, "invalid string: "), "a valid string");
    }
    if (has("invalid number")) fail(begin, quote(text_.substr(begin, word_end(begin) - begin)), "a number as JSON writes it");
    if (text_[begin] == '"') fail(begin, "a string", expectation(message));
    const std::size_t end = std::max(word_end(begin), begin + 1);
    fail(begin, quote(text_.substr(begin, end - begin)), expectation(message));
    return false;
  }

  void finish() {
    if (pending_.size() == 1) return;
    throw InputError(document_.location_of(0), "no value", "a JSON value");
  }

 private:
  void skip_space() {
    while (cursor_ < text_.size() && is_space(text_[cursor_])) ++cursor_;
  }
  // The start of the next value or key.
  void skip_separators() {
    while (is_space(text_[cursor_]) || text_[cursor_] == ',' || text_[cursor_] == ':') ++cursor_;
  }
  // The end of what stands in the place of a value, for messages.
  std::size_t word_end(std::size_t from) const {
    constexpr std::string_view kEnds = ",:]}[{\" \t\n\r";
    const std::size_t end = text_.find_first_of(kEnds, from);
    return end == std::string_view::npos ? text_.size() : end;
  }
  std::size_t skip_literal(std::size_t length) {
    skip_separators();
    const std::size_t begin = cursor_;
    cursor_ += length;
    return begin;
  }
  // By the grammar, not up to the next separator: in 01 the library sees 0, and then complains about 1.
  std::size_t skip_number() {
    skip_separators();
    const std::size_t begin = cursor_;
    const auto here = [this] { return cursor_ < text_.size() ? text_[cursor_] : ' '; };
    const auto skip_digits = [&] {
      while (here() >= '0' && here() <= '9') ++cursor_;
    };
    if (here() == '-') ++cursor_;
    if (here() == '0')
      ++cursor_;
    else
      skip_digits();
    if (here() == '.') {
      ++cursor_;
      skip_digits();
    }
    if (here() == 'e' || here() == 'E') {
      ++cursor_;
      if (here() == '+' || here() == '-') ++cursor_;
      skip_digits();
    }
    return begin;
  }
  std::size_t skip_string() {
    skip_separators();
    const std::size_t begin = cursor_++;
    for (; text_[cursor_] != '"'; ++cursor_)
      if (text_[cursor_] == '\\') ++cursor_;
    ++cursor_;
    return begin;
  }

  LocatedJson::Cell& leaf(Kind kind, std::size_t offset) {
    LocatedJson::Cell cell{};
    cell.offset = offset;
    cell.kind = static_cast<std::uint64_t>(kind);
    pending_.push_back(static_cast<std::uint32_t>(document_.cells_.size()));
    document_.cells_.push_back(cell);
    return document_.cells_.back();
  }

  // Straight from the text: the library reads -0 as the integer 0.
  bool number() {
    const std::size_t begin = skip_number();
    double value = 0;
    std::from_chars(text_.data() + begin, text_.data() + cursor_, value);  // too small a number stays 0
    leaf(Kind::Number, begin).number = value;
    return true;
  }

  bool open() {
    skip_separators();
    open_.push_back({cursor_++, pending_.size()});
    return true;
  }

  bool close(Kind kind) {
    skip_space();
    ++cursor_;
    const auto [offset, first_pending] = open_.back();
    open_.pop_back();
    const auto first = static_cast<std::uint32_t>(document_.links_.size());
    const auto count = static_cast<std::uint32_t>(pending_.size() - first_pending);
    document_.links_.insert(document_.links_.end(), pending_.begin() + static_cast<std::ptrdiff_t>(first_pending),
                            pending_.end());
    pending_.resize(first_pending);
    leaf(kind, offset).span = {first, count};
    return true;
  }

  std::string_view key_text(std::size_t i) const {
    const auto& cell = document_.cells_[pending_[i]];
    return std::string_view(document_.pool_).substr(cell.span.first, cell.span.count);
  }

  void refuse_duplicate_keys() {
    const std::size_t begin = open_.back().second;
    std::vector<std::size_t>& keys = keys_;
    keys.clear();
    for (std::size_t i = begin; i < pending_.size(); i += 2) keys.push_back(i);
    std::sort(keys.begin(), keys.end(), [&](std::size_t a, std::size_t b) {
      const int order = key_text(a).compare(key_text(b));
      return order != 0 ? order < 0 : a < b;
    });
    std::size_t repeated = pending_.size();  // the first in the text
    for (std::size_t i = 1; i < keys.size(); ++i)
      if (key_text(keys[i - 1]) == key_text(keys[i])) repeated = std::min(repeated, keys[i]);
    if (repeated == pending_.size()) return;
    throw InputError(document_.location_of(document_.cells_[pending_[repeated]].offset),
                     "the key " + quote(key_text(repeated)) + " a second time", "every key once");
  }

  // What the library says it expected, in our words.
  static std::string expectation(std::string_view message) {
    const auto ends = [&](std::string_view tail) { return message.ends_with(tail); };
    if (ends("expected end of input")) return "nothing after the value";
    if (ends("expected string literal")) return "a key in quotes";
    if (ends("expected ':'")) return "`:`";
    if (ends("expected ']'")) return "`,` or `]`";
    if (ends("expected '}'")) return "`,` or `}`";
    return "a JSON value";
  }

  // The library's description of a broken string, without its positions.
  static std::string reason(std::string_view message, std::string_view start) {
    std::string_view text = message.substr(message.find(start));
    return std::string(text.substr(0, text.find(';')));
  }

  LocatedJson& document_;
  std::string_view text_;
  std::size_t cursor_ = 0;
  std::vector<std::uint32_t> pending_;                         // cells that have no parent yet
  std::vector<std::pair<std::size_t, std::size_t>> open_;      // offset of the bracket, size of pending_ before it
  std::vector<std::size_t> keys_;                              // scratch
};

LocatedJson LocatedJson::parse(std::string text, std::string file) {
  LocatedJson document;
  document.file_ = std::move(file);
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark
  document.text_ = std::move(text);
  document.line_starts_.push_back(0);
  std::size_t characters = 0;
  for (std::size_t i = 0; i < document.text_.size(); ++i) {
    if (i % kMarkEvery == 0) document.characters_before_.push_back(characters);
    characters += starts_character(document.text_[i]);
    if (document.text_[i] == '\n') document.line_starts_.push_back(i + 1);
  }
  document.characters_before_.push_back(characters);   // where the last mark is the end itself
  if (document.text_.size() >= std::numeric_limits<std::uint32_t>::max())
    throw InputError({document.file_, 0, 0}, fmt::format("{} bytes", document.text_.size()), "less than 4 GiB");
  if (const auto nul = document.text_.find('\0'); nul != std::string::npos)
    throw InputError(document.location_of(nul), "a NUL character", "text");
  LocatedJsonBuilder builder(document);
  nlohmann::json::sax_parse(document.text_.begin(), document.text_.end(), &builder);
  builder.finish();
  return document;
}

JsonValue LocatedJson::root() const { return {this, static_cast<std::uint32_t>(cells_.size() - 1)}; }

std::size_t LocatedJson::characters_before(std::size_t offset) const {
  const std::size_t mark = offset / kMarkEvery;
  const auto begin = text_.begin() + static_cast<std::ptrdiff_t>(mark * kMarkEvery);
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(offset);
  return characters_before_[mark] + static_cast<std::size_t>(std::count_if(begin, end, starts_character));
}

SourceLocation LocatedJson::location_of(std::size_t offset) const {
  const auto line = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset) - line_starts_.begin();
  const std::size_t start = line_starts_[static_cast<std::size_t>(line) - 1];
  const std::size_t column = characters_before(offset) - characters_before(start);
  return {file_, static_cast<int>(line), static_cast<int>(column) + 1};
}

Kind JsonValue::kind() const { return static_cast<Kind>(cell().kind); }

SourceLocation JsonValue::location() const { return document_->location_of(cell().offset); }

void JsonValue::fail(std::string found, std::string expected) const {
  throw InputError(location(), std::move(found), std::move(expected));
}

std::string JsonValue::describe() const {
  switch (kind()) {
    case Kind::Null: return "null";
    case Kind::Boolean: return cell().truth ? "true" : "false";
    case Kind::Number: return fmt::format("the number {}", cell().number);
    case Kind::String: return "the string " + quote(string());
    case Kind::Array: return fmt::format("an array of {}", cell().span.count);
    case Kind::Object: return "an object";
  }
  return "";
}

const LocatedJson::Cell& JsonValue::expect(Kind wanted) const {
  if (kind() != wanted) fail(describe(), std::string(name_of(wanted)));
  return cell();
}

double JsonValue::number() const { return expect(Kind::Number).number; }

long double JsonValue::extended_number() const {
  long double value = number();
  const std::string& text = document_->text_;
  std::from_chars(text.data() + cell().offset, text.data() + text.size(), value);
  return value;
}

std::int64_t JsonValue::integer(std::int64_t lowest, std::int64_t highest) const {
  const double value = number();
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const bool whole = value == std::floor(value) && std::abs(value) <= kExact;
  if (!whole || static_cast<std::int64_t>(value) < lowest || static_cast<std::int64_t>(value) > highest)
    fail(describe(), fmt::format("a whole number from {} to {}", lowest, highest));
  return static_cast<std::int64_t>(value);
}

bool JsonValue::boolean() const { return expect(Kind::Boolean).truth; }

std::string_view JsonValue::string() const {
  const auto [first, count] = expect(Kind::String).span;
  return std::string_view(document_->pool_).substr(first, count);
}

std::size_t JsonValue::size() const { return expect(Kind::Array).span.count; }

JsonValue JsonValue::operator[](std::size_t i) const { return {document_, document_->links_[cell().span.first + i]}; }

const JsonValue& JsonValue::elements(std::size_t count) const {
  if (size() != count) fail(describe(), fmt::format("an array of {}", count));
  return *this;
}

Vec3 JsonValue::vec3() const {
  if (kind() != Kind::Array || cell().span.count != 3) fail(describe(), "[x, y, z]");
  return {(*this)[0].number(), (*this)[1].number(), (*this)[2].number()};
}

std::size_t JsonValue::member_count() const { return expect(Kind::Object).span.count / 2; }

JsonValue JsonValue::member_key(std::size_t i) const {
  return {document_, document_->links_[cell().span.first + 2 * i]};
}

JsonValue JsonValue::member(std::size_t i) const {
  return {document_, document_->links_[cell().span.first + 2 * i + 1]};
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  for (std::size_t i = 0, n = member_count(); i < n; ++i)
    if (member_key(i).string() == key) return member(i);
  return std::nullopt;
}

JsonValue JsonValue::at(std::string_view key) const {
  const auto value = find(key);
  if (!value) fail("no key " + quote(key), "an object with it");
  return *value;
}

double JsonValue::number_or(std::string_view key, double absent) const {
  const auto value = find(key);
  return value ? value->number() : absent;
}

void JsonValue::expect_keys(std::initializer_list<std::string_view> known) const {
  for (std::size_t i = 0, n = member_count(); i < n; ++i) {
    const JsonValue key = member_key(i);
    if (std::find(known.begin(), known.end(), key.string()) != known.end()) continue;
    std::string list;
    for (const auto name : known) list += (list.empty() ? "`" : ", `") + std::string(name) + "`";
    key.fail("the unknown key " + quote(key.string()), "one of " + list);
  }
}

LocatedJson load_json(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError({path.string(), 0, 0}, "no file that can be opened", "a readable JSON file");
  std::string text;
  char block[1 << 16];
  do {
    stream.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(stream.gcount()));
  } while (stream);
  if (stream.bad() || std::filesystem::is_directory(path))
    throw InputError({path.string(), 0, 0}, "a file that cannot be read", "a readable JSON file");
  return LocatedJson::parse(std::move(text), path.string());
}

}  // namespace cambium
