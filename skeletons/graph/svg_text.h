// The text of an SVG file: places in it, numbers, and where its paths are.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace cambium {

/// Reads numbers from a part of a text, front to back. The text and the file's name must outlive it.
class SvgCursor {
 public:
  SvgCursor(std::string_view text, const std::string& file) : SvgCursor(text, file, 0, text.size()) {}
  SvgCursor(std::string_view text, const std::string& file, std::size_t begin, std::size_t end)
      : text_(text), file_(file), at_(begin), end_(end) {}

  std::size_t at() const { return at_; }
  bool at_end() const { return at_ >= end_; }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  bool sees(std::string_view word) const { return text_.substr(at_, end_ - at_).starts_with(word); }
  void move(std::size_t by) { at_ += by; }
  /// Behind the next `word`. Errors: InputError where there is none.
  void move_behind(std::string_view word);
  void skip_blanks();
  /// Blanks and commas.
  void skip_separators();
  /// Letters, digits and what else names are made of.
  std::string_view name();
  bool sees_number() const;
  /// Behind separators. Errors: InputError unless it is finite and not beyond 1e12.
  double number();
  /// '0' or '1', which need nothing between them and what follows.
  bool flag();
  [[noreturn]] void refuse(const std::string& expected) const { refuse_at(at_, expected); }
  [[noreturn]] void refuse_at(std::size_t place, const std::string& expected) const;
  /// As refuse_at, of something other than the word that is there.
  [[noreturn]] void refuse_at(std::size_t place, const std::string& found, const std::string& expected) const;

 private:
  std::string_view text_;
  const std::string& file_;
  std::size_t at_, end_;
};

/// p -> linear * p + offset
struct SvgTransform {
  glm::dmat2 linear{1.0};
  glm::dvec2 offset{0.0};

  glm::dvec2 operator()(const glm::dvec2& p) const { return linear * p + offset; }
  SvgTransform operator*(const SvgTransform& first) const { return {linear * first.linear, linear * first.offset + offset}; }
};

struct SvgPathPlace {
  std::size_t begin = 0, end = 0;    ///< of the data between its quotes, in the text
  SvgTransform to_document;
};

/// The <path> of that id, or the first that has data and is no part of a definition, if id is empty. Nothing behind it is looked at.
/// Errors: InputError with line and column for text before it that is no XML, and where there is no such path.
SvgPathPlace find_svg_path(std::string_view text, const std::string& file, const std::string& id);

}  // namespace cambium
