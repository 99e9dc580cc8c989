#include "lsystem/lpy_cursor.h"

#include "lsystem/dialect_text.h"

namespace cambium {

SourceText lpy_source(std::string_view text, const std::filesystem::path& file) {
  const SourceText all = as_it_stands(text, file);
  SourceText out;
  out.files = all.files;
  out.end = all.end;
  const std::string& from = all.text;
  const auto copy = [&](std::size_t i) { out.append(from[i], all.places[i]); };
  for (std::size_t i = 0; i < from.size();) {
    const std::string_view three = std::string_view(from).substr(i, 3);
    if (from[i] == '#') {
      while (i < from.size() && from[i] != '\n') ++i;
    } else if (three == "\"\"\"" || three == "'''") {
      const std::size_t end = from.find(three, i + 3);
      if (end == from.npos) throw InputError(located(all.files, all.places[i]), "a text without an end", std::string(three));
      for (; i < end + 3; ++i)
        if (from[i] == '\n') copy(i);
    } else if (from[i] == '"') {
      do copy(i++);
      while (i < from.size() && from[i] != '"' && from[i] != '\n');
      if (i < from.size() && from[i] == '"') copy(i++);
    } else {
      copy(i++);
    }
  }
  return out;
}

bool LpyCursor::next_line() {
  skip_blank_lines();
  return !at_end();
}

int LpyCursor::line_indent() const {
  const std::string& text = source().text;
  const std::size_t before = position() == 0 ? text.npos : text.rfind('\n', position() - 1);
  int indent = 0;
  for (std::size_t i = before == text.npos ? 0 : before + 1; i < position(); ++i)
    indent = text[i] == '\t' ? (indent / 8 + 1) * 8 : indent + 1;
  return indent;
}

bool LpyCursor::enter_deeper_line(int indent) {
  const std::size_t before = position();
  if (next_line() && line_indent() > indent) return true;
  seek(before);
  return false;
}

bool LpyCursor::enter_word(int indent, std::string_view word) {
  const std::size_t before = position();
  if (next_line() && line_indent() == indent && this->word() == word) return true;
  seek(before);
  return false;
}

std::string_view LpyCursor::rest_of_line() const {
  const std::string_view text = source().text;
  return text.substr(position(), text.find('\n', position()) - position());
}

void LpyCursor::end_line() {
  skip_space();
  if (!at_line_end()) fail("the end of the line");
}

void LpyCursor::fail_python(std::size_t at, const std::string& what) const {
  fail_at(at, "'" + what + "', which is embedded Python", "what docs/lsystems.md lists of L-Py");
}

}  // namespace cambium
