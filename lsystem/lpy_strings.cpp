#include "lsystem/lpy_strings.h"

namespace cambium {

MarkedText LpyStrings::successor(int indent) {
  MarkedText out;
  const std::size_t begin = in_.position();
  in_.skip_space();
  if (in_.accept('*')) {
    in_.end_line();
  } else {
    refuse_statement();
    while (true) {
      in_.skip_space();
      if (in_.at_line_end()) {
        if (!in_.enter_deeper_line(indent)) break;
        refuse_statement();
      }
      append(out, module_here());
    }
  }
  if (out.empty()) append(out, "*", in_.place_of(begin));
  return out;
}

// Python that stands where modules could: its words would be read as modules of one letter each.
void LpyStrings::refuse_statement() {
  const std::size_t at = in_.position();
  const std::string word = in_.word();
  if (is_python_keyword(word)) in_.fail_python(at, word);
  in_.seek(at);
}

MarkedText LpyStrings::module_here() {
  const std::size_t at = in_.position();
  const std::string name = symbols.read(in_);
  if (name.empty()) in_.fail_at(at, in_.describe(at), "a module, or the end of the line");
  MarkedText out;
  append_symbol(out, name, in_.place_of(at));
  in_.skip_space();
  if (in_.peek() != '(') return out;
  const std::size_t open = in_.position();
  in_.advance();
  const Cursor::LineEnds inside(in_, true);
  if (in_.accept(')')) return out;
  char before = '(';
  do {
    out.push_back({before, in_.place_of(open)});
    append(out, argument());
    before = ',';
  } while (in_.accept(','));
  out.push_back({')', in_.place()});
  in_.expect_close(open, "or ','");
  return out;
}

// A number, or the text of a label, which is not drawn.
MarkedText LpyStrings::argument() {
  in_.skip_space();
  if (in_.peek() != '"') return python_expression(in_, names);
  const std::size_t begin = in_.position();
  do in_.advance();
  while (in_.peek() != '"' && !in_.at_line_end());
  if (in_.at_line_end()) in_.fail_at(begin, "a text without an end", "'\"'");
  in_.advance();
  MarkedText out;
  append_number(out, 0, in_.place_of(begin));
  return out;
}

MarkedText LpyStrings::predecessors() {
  MarkedText out;
  while (true) {
    in_.skip_space();
    const std::size_t at = in_.position();
    const char c = in_.peek();
    if (in_.looking_at("-->") || in_.looking_at("-static->") || c == ':' || in_.at_line_end()) break;
    if (in_.looking_at("<<") || in_.looking_at(">>"))
      in_.fail_at(at, std::string("'") + c + c + "', a context in the string that is being made", "'<' or '>'");
    if (c == '<' || c == '>') {
      in_.advance();
      out.push_back({c, in_.place_of(at)});
    } else {
      append(out, formal_module());
    }
  }
  if (out.empty()) in_.fail("a rule, a section or an assignment");
  return out;
}

MarkedText LpyStrings::formal_module() {
  const std::size_t at = in_.position();
  if (in_.looking_at("=]") || in_.peek() == '*' || in_.looking_at("x("))
    in_.fail_at(at, in_.describe(at), "a module: patterns of L-Py are out of reach");
  const std::string name = symbols.read(in_);
  if (name.empty()) in_.fail_at(at, in_.describe(at), "a module, ':' or '-->'");
  MarkedText out;
  append_symbol(out, name, in_.place_of(at));
  in_.skip_space();
  if (in_.peek() != '(') return out;
  const std::size_t open = in_.position();
  in_.advance();
  if (in_.accept(')')) return out;
  char before = '(';
  do {
    in_.skip_space();
    const std::size_t here = in_.position();
    const std::string parameter = in_.word();
    if (parameter.empty() || is_python_keyword(parameter)) in_.fail_at(here, in_.describe(here), "the name of a parameter");
    names.parameters.push_back(parameter);
    out.push_back({before, in_.place_of(here)});
    append(out, parameter, in_.place_of(here));
    before = ',';
  } while (in_.accept(','));
  out.push_back({')', in_.place()});
  in_.expect_close(open, "or ','");
  return out;
}

}  // namespace cambium
