#include "skeletons/graph/svg_text.h"

#include "blobtree/input_error.h"
#include "skeletons/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace cambium {
namespace {

constexpr double kLargest = 1e12;
constexpr std::size_t kDeepest = 256;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
bool is_digit(char c) { return '0' <= c && c <= '9'; }
bool is_letter(char c) { return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z'); }
bool is_in_name(char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == ':' || c == '.' || (c & 0x80); }

SourceLocation location_of(std::string_view text, const std::string& file, std::size_t place) {
  const std::string_view before = text.substr(0, place);
  const std::size_t line_begin = before.rfind('\n') + 1;   // 0 where there is none
  return {file, static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1, static_cast<int>(place - line_begin) + 1};
}

SvgTransform turned(double degrees) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  return {glm::dmat2{c, s, -s, c}, {}};
}

/// One of a list, by its name and numbers; nullopt if there is none such.
std::optional<SvgTransform> transform_of(std::string_view name, const std::vector<double>& n) {
  const auto slant = [](double degrees) { return std::tan(degrees * std::numbers::pi / 180); };
  if (name == "matrix" && n.size() == 6) return SvgTransform{{n[0], n[1], n[2], n[3]}, {n[4], n[5]}};
  if (name == "translate" && (n.size() == 1 || n.size() == 2)) return SvgTransform{glm::dmat2(1.0), {n[0], n.size() > 1 ? n[1] : 0}};
  if (name == "scale" && (n.size() == 1 || n.size() == 2)) return SvgTransform{{n[0], 0, 0, n.back()}, {}};
  if (name == "rotate" && n.size() == 1) return turned(n[0]);
  if (name == "rotate" && n.size() == 3) {
    const glm::dvec2 center{n[1], n[2]};
    return SvgTransform{glm::dmat2(1.0), center} * turned(n[0]) * SvgTransform{glm::dmat2(1.0), -center};
  }
  if (name == "skewX" && n.size() == 1) return SvgTransform{{1, 0, slant(n[0]), 1}, {}};
  if (name == "skewY" && n.size() == 1) return SvgTransform{{1, slant(n[0]), 0, 1}, {}};
  return std::nullopt;
}

SvgTransform read_transforms(SvgCursor cursor) {
  SvgTransform all;
  for (cursor.skip_separators(); !cursor.at_end(); cursor.skip_separators()) {
    const std::size_t begin = cursor.at();
    const std::string_view name = cursor.name();
    cursor.skip_blanks();
    if (name.empty() || cursor.peek() != '(') cursor.refuse_at(begin, "a transform such as translate(1, 2)");
    cursor.move(1);
    std::vector<double> numbers;
    for (cursor.skip_separators(); cursor.peek() != ')'; cursor.skip_separators()) {
      if (numbers.size() == 6) cursor.refuse("')'");
      numbers.push_back(cursor.number());
    }
    cursor.move(1);
    const auto next = transform_of(name, numbers);
    if (!next) cursor.refuse_at(begin, "matrix, translate, scale, rotate, skewX or skewY with as many numbers as it takes");
    all = all * *next;
  }
  return all;
}

struct Attribute {
  std::string_view name;
  std::size_t begin = 0, end = 0;    // of its value
};

/// An element that is open.
struct Element {
  std::string_view name;
  SvgTransform to_document;
  bool drawn = true;
};

class PathFinder {
 public:
  PathFinder(std::string_view text, const std::string& file, const std::string& id)
      : text_(text), file_(file), id_(id), cursor_(text, file) {}

  SvgPathPlace find() {
    while (true) {
      const std::size_t next = text_.find('<', cursor_.at());
      if (next == std::string_view::npos) break;
      cursor_.move(next - cursor_.at());
      if (skip_what_is_no_element()) continue;
      if (cursor_.sees("</")) {
        close_element();
      } else if (const auto found = open_element()) {
        return *found;
      }
    }
    if (!open_.empty()) cursor_.refuse_at(text_.size(), "</" + std::string(open_.back().name) + ">");
    throw InputError({file_}, "no " + wanted(), "a drawing with one");
  }

 private:
  std::string wanted() const { return id_.empty() ? "<path>" : "<path> with the id " + quoted(id_); }

  bool skip_what_is_no_element() {
    constexpr std::array<std::array<std::string_view, 2>, 3> kSkipped = {{{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}}};
    for (const auto& [begin, end] : kSkipped)
      if (cursor_.sees(begin)) {
        cursor_.move(begin.size());
        cursor_.move_behind(end);
        return true;
      }
    if (!cursor_.sees("<!")) return false;
    const std::size_t end = text_.find_first_of("[>", cursor_.at());   // a document type, which may define things in brackets
    if (end != std::string_view::npos && text_[end] == '[') cursor_.move_behind("]");
    cursor_.move_behind(">");
    return true;
  }

  void close_element() {
    const std::size_t begin = cursor_.at();
    cursor_.move(2);
    const std::string_view name = cursor_.name();
    if (open_.empty()) cursor_.refuse_at(begin, "no end of an element, since none is open");
    if (name != open_.back().name) cursor_.refuse_at(begin, "</" + std::string(open_.back().name) + ">");
    cursor_.skip_blanks();
    if (cursor_.peek() != '>') cursor_.refuse("'>'");
    open_.pop_back();
  }

  /// The path that is looked for, if it is one.
  std::optional<SvgPathPlace> open_element() {
    const std::size_t begin = cursor_.at();
    cursor_.move(1);
    Element element{cursor_.name(), {}, true};
    if (element.name.empty()) cursor_.refuse_at(begin, "an element's name behind '<'");
    const std::vector<Attribute> attributes = read_attributes();
    const bool closed = cursor_.peek() == '/';
    cursor_.move(closed ? 2 : 1);

    if (!open_.empty()) element.to_document = open_.back().to_document, element.drawn = open_.back().drawn;
    element.drawn = element.drawn && !is_definition(local(element.name));
    if (const Attribute* transform = find(attributes, "transform"))
      element.to_document = element.to_document * read_transforms(SvgCursor(text_, file_, transform->begin, transform->end));
    if (local(element.name) == "path") {
      const Attribute *id = find(attributes, "id"), *data = find(attributes, "d");
      const bool named = !id_.empty() && id && value(*id) == id_;
      if (named && !data) cursor_.refuse_at(begin, "a <path> with data, d");
      if (named || (id_.empty() && data && element.drawn)) return SvgPathPlace{data->begin, data->end, element.to_document};
    }
    if (!closed) {
      if (open_.size() == kDeepest) cursor_.refuse_at(begin, "at most 256 elements inside each other");
      open_.push_back(element);
    }
    return std::nullopt;
  }

  /// Up to the '>' or '/>' behind them.
  std::vector<Attribute> read_attributes() {
    std::vector<Attribute> attributes;
    for (cursor_.skip_blanks(); cursor_.peek() != '>' && !cursor_.sees("/>"); cursor_.skip_blanks()) {
      Attribute attribute{cursor_.name()};
      if (attribute.name.empty()) cursor_.refuse("an attribute or '>'");
      cursor_.skip_blanks();
      if (cursor_.peek() != '=') cursor_.refuse("'='");
      cursor_.move(1);
      cursor_.skip_blanks();
      const char quote = cursor_.peek();
      if (quote != '"' && quote != '\'') cursor_.refuse("a value in quotes");
      cursor_.move(1);
      attribute.begin = cursor_.at();
      cursor_.move_behind(std::string_view(&quote, 1));
      attribute.end = cursor_.at() - 1;
      attributes.push_back(attribute);
    }
    return attributes;
  }

  static std::string_view local(std::string_view name) { return name.substr(name.rfind(':') + 1); }
  static bool is_definition(std::string_view name) {
    constexpr std::string_view kDefinitions[] = {"defs", "clipPath", "mask", "symbol", "pattern", "marker"};
    return std::find(std::begin(kDefinitions), std::end(kDefinitions), name) != std::end(kDefinitions);
  }
  static const Attribute* find(const std::vector<Attribute>& attributes, std::string_view name) {
    const auto at = std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.name == name; });
    return at == attributes.end() ? nullptr : &*at;
  }
  std::string_view value(const Attribute& attribute) const { return text_.substr(attribute.begin, attribute.end - attribute.begin); }

  std::string_view text_;
  const std::string &file_, &id_;
  SvgCursor cursor_;
  std::vector<Element> open_;
};

}  // namespace

void SvgCursor::move_behind(std::string_view word) {
  const std::size_t found = text_.substr(0, end_).find(word, at_);
  if (found == std::string_view::npos) refuse_at(at_, "'" + std::string(word) + "' somewhere behind it");
  at_ = found + word.size();
}

void SvgCursor::skip_blanks() {
  while (!at_end() && is_blank(text_[at_])) ++at_;
}

void SvgCursor::skip_separators() {
  while (!at_end() && (is_blank(text_[at_]) || text_[at_] == ',')) ++at_;
}

std::string_view SvgCursor::name() {
  const std::size_t begin = at_;
  while (!at_end() && is_in_name(text_[at_])) ++at_;
  return text_.substr(begin, at_ - begin);
}

bool SvgCursor::sees_number() const { return is_digit(peek()) || peek() == '.' || peek() == '-' || peek() == '+'; }

double SvgCursor::number() {
  skip_separators();
  if (!sees_number()) refuse("a number");
  const std::size_t digits = at_ + (peek() == '+' || peek() == '-');
  const bool begins = digits < end_ && (is_digit(text_[digits]) || text_[digits] == '.');   // neither "+-1" nor "-inf"
  double value = 0;
  const auto [end, error] = std::from_chars(text_.data() + digits, text_.data() + end_, value);
  if (!begins || error != std::errc{} || value > kLargest) refuse("a number of at most 1e12");
  const bool negative = peek() == '-';
  at_ = static_cast<std::size_t>(end - text_.data());
  return negative ? -value : value;
}

bool SvgCursor::flag() {
  skip_separators();
  if (peek() != '0' && peek() != '1') refuse("0 or 1");
  return text_[at_++] == '1';
}

void SvgCursor::refuse_at(std::size_t place, const std::string& expected) const {
  const std::string_view rest = text_.substr(place, std::max(end_, place) - place);
  const std::size_t length = std::max<std::size_t>(std::min(rest.find_first_of(" \t\r\n,\"'"), rest.size()), 1);
  refuse_at(place, rest.empty() ? "the end" : quoted(rest.substr(0, length)), expected);
}

void SvgCursor::refuse_at(std::size_t place, const std::string& found, const std::string& expected) const {
  throw InputError(location_of(text_, file_, place), found, expected);
}

SvgPathPlace find_svg_path(std::string_view text, const std::string& file, const std::string& id) {
  return PathFinder(text, file, id).find();
}

}  // namespace cambium
