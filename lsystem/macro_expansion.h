// #define: object-like and function-like macros over text that knows its places.
#pragma once

#include "lsystem/source_text.h"

#include <map>
#include <string>
#include <vector>

namespace cambium {

struct MarkedChar {
  char c;
  Place place;
};
using MarkedText = std::vector<MarkedChar>;

/// The identifier that begins at `index`, or empty.
std::string word_at(const MarkedText& text, std::size_t index);

/// Macros defined so far, and __LINE__. Errors: InputError for a malformed definition or invocation, or when expansion explodes.
class MacroTable {
 public:
  explicit MacroTable(const std::vector<std::string>& files) : files_(files) {}

  void define(const MarkedText& definition, const Place& at);   ///< `NAME body` or `NAME(a,b) body`
  void undefine(const std::string& name) { macros_.erase(name); }
  bool defined(const std::string& name) const { return macros_.count(name) != 0; }
  void expand(const MarkedText& in, MarkedText& out) { expand_into(in, out, 0); }
  void spend(std::size_t characters, const Place& at);          ///< counts against the bound on work

 private:
  struct Macro {
    bool takes_arguments = false;
    std::vector<std::string> parameters;
    MarkedText body;
    bool busy = false;  // being expanded: C does not expand it again inside itself
  };

  void expand_into(const MarkedText& in, MarkedText& out, int depth);
  std::size_t read_arguments(const MarkedText& in, std::size_t open, std::vector<MarkedText>& out) const;
  [[noreturn]] void fail(const Place& at, std::string found, std::string expected) const;

  const std::vector<std::string>& files_;
  std::map<std::string, Macro> macros_;
  std::size_t work_ = 0;
};

}  // namespace cambium
