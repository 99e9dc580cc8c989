#include "cli/recipe_override.h"

#include <charconv>
#include <optional>

namespace cambium {
namespace {

std::vector<std::string> split_key(const std::string& key, const SourceLocation& at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    if (end == begin)
      throw InputError(at, "an empty part in the key '" + key + "'", "key=value with a key such as surface.lip");
    parts.push_back(key.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::optional<std::size_t> as_index(const std::string& part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size()) return std::nullopt;
  return index;
}

/// A table that holds the value under "value". Its nodes are copied from there, which leaves their source regions behind.
toml::table parse_value(const std::string& text) {
  if (text.find('\n') == std::string::npos) {
    try {
      toml::table parsed = toml::parse("value = " + text + "\n");
      if (parsed.size() == 1 && parsed.contains("value")) return parsed;
    } catch (const toml::parse_error&) {
      // Not TOML: a bare word.
    }
  }
  toml::table parsed;
  parsed.insert_or_assign("value", text);
  return parsed;
}

/// A slot of a table or array that a part of the key names.
class Slot {
 public:
  Slot(toml::node& parent, const std::string& part, const SourceLocation& at)
      : array_(parent.as_array()), table_(parent.as_table()), key_(part) {
    if (array_) {
      const auto index = as_index(part);
      if (!index || *index > array_->size())
        throw InputError(at, "'" + part + "' as an index", "0 to " + std::to_string(array_->size()));
      index_ = *index;
    } else if (!table_) {
      throw InputError(at, "'" + part + "' inside a plain value", "a key of the recipe");
    }
  }

  toml::node* get() { return array_ ? (index_ < array_->size() ? array_->get(index_) : nullptr) : table_->get(key_); }

  template <class Value>
  void put(Value&& value) {
    if (table_)
      table_->insert_or_assign(key_, std::forward<Value>(value));
    else if (index_ < array_->size())
      array_->replace(array_->cbegin() + static_cast<std::ptrdiff_t>(index_), std::forward<Value>(value));
    else
      array_->push_back(std::forward<Value>(value));
  }

 private:
  toml::array* array_;
  toml::table* table_;
  std::string key_;
  std::size_t index_ = 0;
};

}  // namespace

void apply_override(const std::string& text, toml::table& root, RecipeSource& source) {
  const SourceLocation at{"--set " + text};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw InputError(at, "no '='", "key=value");
  const std::string key = text.substr(0, equals);
  const std::vector<std::string> parts = split_key(key, at);
  source.overrides.emplace_back(key, text);

  toml::node* parent = &root;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    Slot slot(*parent, parts[i], at);
    if (!slot.get()) {
      if (as_index(parts[i + 1]))
        slot.put(toml::array{});
      else
        slot.put(toml::table{});
    }
    parent = slot.get();
  }
  const toml::table value = parse_value(text.substr(equals + 1));
  Slot(*parent, parts.back(), at).put(*value.get("value"));
}

}  // namespace cambium
