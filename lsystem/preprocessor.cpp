#include "lsystem/preprocessor.h"

#include "lsystem/macro_expansion.h"
#include "lsystem/expression_compiler.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

namespace cambium {
namespace {

constexpr int kMaxIncludes = 64;

// Characters of one file without comments and line splices.
MarkedText without_comments(std::string_view text, std::uint32_t file, const std::vector<std::string>& files) {
  MarkedText out;
  out.reserve(text.size() + 1);
  Place place{1, 1, file};
  std::size_t i = 0;
  const auto step = [&] {
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else {
      ++place.column;
    }
    ++i;
  };
  const auto next_is = [&](char c) { return i + 1 < text.size() && text[i + 1] == c; };
  if (text.substr(0, 3) == "\xef\xbb\xbf") i = 3;  // a byte order mark
  bool in_text = false;
  while (i < text.size()) {
    const char c = text[i];
    const bool splice = c == '\\' && (next_is('\n') || (next_is('\r') && i + 2 < text.size() && text[i + 2] == '\n'));
    if (splice) {
      while (text[i] != '\n') step();
      step();
    } else if (!in_text && c == '/' && next_is('/')) {
      while (i < text.size() && text[i] != '\n') step();
    } else if (!in_text && c == '/' && next_is('*')) {
      const Place begin = place;
      step();
      step();
      while (i < text.size() && !(text[i] == '*' && next_is('/'))) step();
      if (i >= text.size()) throw InputError(located(files, begin), "a comment without an end", "'*/'");
      step();
      step();
      out.push_back({' ', begin});
    } else {
      if (c == '"' || c == '\n') in_text = c == '"' && !in_text;
      if (c != '\r') out.push_back({c, place});
      step();
    }
  }
  if (out.empty() || out.back().c != '\n') out.push_back({'\n', place});
  return out;
}

struct Directive {
  std::string name;
  MarkedText rest;  // without surrounding blanks
  Place at;
};

class Preprocessor {
 public:
  Preprocessor() : macros_(files_) {}

  SourceText run(std::string_view text, const std::filesystem::path& file) {
    include(text, file, 0);
    SourceText source;
    source.text.reserve(out_.size());
    source.places.reserve(out_.size());
    for (const MarkedChar& c : out_) source.append(c.c, c.place);
    source.end = source.places.empty() ? Place{1, 1, 0} : source.places.back();
    source.files = std::move(files_);
    return source;
  }

 private:
  struct Branch {
    Place at;
    bool outer;  // the text around it is kept
    bool taken;  // one of its parts was kept
    bool kept;   // the present part is kept
    bool last;   // past #else
  };

  [[noreturn]] void fail(const Place& at, std::string found, std::string expected) const {
    throw InputError(located(files_, at), std::move(found), std::move(expected));
  }

  void include(std::string_view text, const std::filesystem::path& file, int depth) {
    const auto number = static_cast<std::uint32_t>(files_.size());
    files_.push_back(file.string());
    const MarkedText all = without_comments(text, number, files_);
    std::vector<Branch> branches;
    MarkedText pending;  // text lines up to the next directive: a macro's arguments may span lines
    for (auto begin = all.begin(); begin != all.end();) {
      const auto end = std::find_if(begin, all.end(), [](const MarkedChar& c) { return c.c == '\n'; });
      const auto after = end == all.end() ? end : end + 1;
      Directive directive;
      if (parse_directive(begin, end, directive)) {
        flush(pending);
        obey(directive, branches, file, depth);
      } else if (branches.empty() || branches.back().kept) {
        pending.insert(pending.end(), begin, after);
      }
      begin = after;
    }
    flush(pending);
    if (!branches.empty()) fail(branches.back().at, "#if without an end", "#endif");
  }

  void flush(MarkedText& pending) {
    macros_.expand(pending, out_);
    pending.clear();
  }

  static bool parse_directive(MarkedText::const_iterator begin, MarkedText::const_iterator end, Directive& out) {
    const auto blank = [](const MarkedChar& c) { return c.c == ' ' || c.c == '\t'; };
    begin = std::find_if_not(begin, end, blank);
    if (begin == end || begin->c != '#') return false;
    out.at = begin->place;
    begin = std::find_if_not(begin + 1, end, blank);
    for (; begin != end && in_word(begin->c); ++begin) out.name.push_back(begin->c);
    static constexpr std::string_view kNames[] = {"define", "undef", "include", "if",     "ifdef", "ifndef",
                                                  "elif",   "else",  "endif",   "error",  "pragma", "line",  "warning"};
    if (std::find(std::begin(kNames), std::end(kNames), out.name) == std::end(kNames)) return false;
    begin = std::find_if_not(begin, end, blank);
    while (begin != end && blank(*(end - 1))) --end;
    out.rest.assign(begin, end);
    return true;
  }

  void obey(const Directive& d, std::vector<Branch>& branches, const std::filesystem::path& file, int depth) {
    const bool kept = branches.empty() || branches.back().kept;
    if (d.name == "if" || d.name == "ifdef" || d.name == "ifndef") {
      bool holds = false;
      if (kept) holds = d.name == "if" ? condition(d) : macros_.defined(only_name(d)) == (d.name == "ifdef");
      branches.push_back({d.at, kept, holds, kept && holds, false});
      return;
    }
    if (d.name == "else" || d.name == "elif" || d.name == "endif") {
      if (branches.empty()) fail(d.at, "#" + d.name, "an #if before it");
      Branch& branch = branches.back();
      if (d.name == "endif") {
        branches.pop_back();
        return;
      }
      if (branch.last) fail(d.at, "#" + d.name + " after #else", "#endif");
      branch.last = d.name == "else";
      branch.kept = branch.outer && !branch.taken && (branch.last || condition(d));
      branch.taken = branch.taken || branch.kept;
      return;
    }
    if (!kept) return;
    if (d.name == "define") macros_.define(d.rest, d.at);
    if (d.name == "undef") macros_.undefine(only_name(d));
    if (d.name == "error") fail(d.at, "#error " + plain(d.rest), "a file without #error");
    if (d.name == "include") {
      const std::string name = plain(d.rest);
      if (name.size() < 3 || name.front() != '"' || name.back() != '"')
        fail(d.rest.empty() ? d.at : d.rest.front().place, name.empty() ? "nothing" : name, "the name of a file in quotes");
      if (depth >= kMaxIncludes) fail(d.at, "includes deeper than 64", "no file that includes itself");
      const std::filesystem::path wanted = file.parent_path() / name.substr(1, name.size() - 2);
      const std::string text = read_source(wanted, located(files_, d.rest.front().place));
      macros_.spend(text.size(), d.at);
      include(text, wanted, depth + 1);
    }
  }

  static std::string plain(const MarkedText& text) {
    std::string out;
    for (const MarkedChar& c : text) out.push_back(c.c);
    return out;
  }

  std::string only_name(const Directive& d) const {
    const std::string name = plain(d.rest);
    if (name.empty() || !starts_word(name[0]) || !std::all_of(name.begin(), name.end(), in_word))
      fail(d.rest.empty() ? d.at : d.rest.front().place, name.empty() ? "nothing" : "'" + name + "'", "one name");
    return name;
  }

  // The value of the expression after #if: `defined` first, then macros, then any name left is 0.
  bool condition(const Directive& d) {
    if (d.rest.empty()) fail(d.at, "#" + d.name + " alone", "a condition");
    MarkedText asked;
    for (std::size_t i = 0; i < d.rest.size();) {
      const std::string name = word_at(d.rest, i);
      if (name != "defined") {
        const std::size_t length = std::max<std::size_t>(name.size(), 1);
        asked.insert(asked.end(), d.rest.begin() + static_cast<long>(i), d.rest.begin() + static_cast<long>(i + length));
        i += length;
        continue;
      }
      const Place at = d.rest[i].place;
      i += name.size();
      const auto skip = [&] {
        while (i < d.rest.size() && (d.rest[i].c == ' ' || d.rest[i].c == '\t')) ++i;
      };
      skip();
      const bool parenthesis = i < d.rest.size() && d.rest[i].c == '(';
      if (parenthesis) ++i;
      skip();
      const std::string macro = word_at(d.rest, i);
      if (macro.empty()) fail(at, "'defined' without a name", "defined(NAME)");
      i += macro.size();
      skip();
      if (parenthesis && (i >= d.rest.size() || d.rest[i++].c != ')')) fail(at, "'defined(' without ')'", "defined(NAME)");
      asked.push_back({macros_.defined(macro) ? '1' : '0', at});
    }
    MarkedText expanded;
    macros_.expand(asked, expanded);
    SourceText source;
    source.files = files_;
    source.end = d.rest.back().place;
    for (std::size_t i = 0; i < expanded.size();) {
      const std::string name = word_at(expanded, i);
      source.append(name.empty() ? expanded[i].c : '0', expanded[i].place);
      i += std::max<std::size_t>(name.size(), 1);
    }
    source.append('\n', {source.end.line, source.end.column + 1, source.end.file});
    Cursor cursor(source);
    const double value = constant_expression(cursor);
    cursor.skip_space();
    if (!cursor.at_line_end()) cursor.fail("the end of the condition");
    return value != 0.0;
  }

  std::vector<std::string> files_;
  MacroTable macros_;
  MarkedText out_;
};

}  // namespace

SourceText preprocess(std::string_view text, const std::filesystem::path& file) { return Preprocessor().run(text, file); }

std::string read_source(const std::filesystem::path& file, const SourceLocation& wanted_from) {
  constexpr std::uintmax_t kMaxSize = 16u << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(wanted_from, "'" + file.string() + "', which is no readable file", "an existing file");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kMaxSize) throw InputError(wanted_from, "a file of more than 16 MB", "an L-system");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(wanted_from, "'" + file.string() + "', which cannot be opened", "a readable file");
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) throw InputError(wanted_from, "'" + file.string() + "', which cannot be read", "a readable file");
  return text;
}

}  // namespace cambium
