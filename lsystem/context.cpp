#include "lsystem/context.h"

#include <algorithm>

namespace cambium {

bool BracketPairs::link(const Modules& string, std::uint16_t open, std::uint16_t close, const RunOptions& run) {
  const auto none = static_cast<std::uint32_t>(string.size());
  partner_.resize(string.size());
  std::vector<std::uint32_t> opened;
  for (std::uint32_t i = 0; i < none; ++i) {
    if ((i & 0xfffff) == 0 && run.cancelled()) return false;
    partner_[i] = none;
    if (string.symbol[i] == open) opened.push_back(i);
    if (string.symbol[i] != close || opened.empty()) continue;
    partner_[i] = opened.back();
    partner_[opened.back()] = i;
    opened.pop_back();
  }
  return true;
}

bool take_module(const ContextModule& wanted, const Modules& string, std::size_t at, double* locals) {
  if (string.symbol[at] != wanted.symbol || string.arity(at) != wanted.arity) return false;
  std::copy_n(string.parameters.begin() + string.first[at], wanted.arity, locals + wanted.first_local);
  return true;
}

bool ContextMatcher::left(const std::vector<ContextModule>& left, std::size_t end, const System& system, double* locals) {
  std::size_t at = end;
  bool wrapped = !system.ring;
  for (const ContextModule& wanted : left) {
    while (true) {
      ++work;
      if (at == 0) {
        if (wrapped) return false;
        wrapped = true;
        at = string_.size();
        if (at == 0) return false;
      }
      --at;
      const std::uint16_t symbol = string_.symbol[at];
      if (symbol == program_.close) {
        at = brackets_.partner(at);
        if (at >= string_.size()) return false;
      } else if (symbol != program_.open && !system.ignored[symbol]) {
        break;
      }
    }
    if (!take_module(wanted, string_, at, locals)) return false;
  }
  return true;
}

std::size_t ContextMatcher::end_of_branch(std::size_t at) {
  for (; at < string_.size() && string_.symbol[at] != program_.close; ++work)
    at = string_.symbol[at] == program_.open ? std::min(brackets_.partner(at) + 1, string_.size()) : at + 1;
  return at;
}

bool ContextMatcher::right(const std::vector<ContextModule>& right, std::size_t begin, const System& system,
                           double* locals) {
  std::size_t at = begin;
  bool wrapped = !system.ring;
  for (const ContextModule& wanted : right) {
    if (wanted.symbol == program_.rest) {
      at = end_of_branch(at);
      continue;
    }
    while (true) {
      ++work;
      if (at >= string_.size()) {
        if (wrapped || string_.size() == 0) return false;
        wrapped = true;
        at = 0;
      }
      const std::uint16_t symbol = string_.symbol[at];
      if (system.ignored[symbol])
        ++at;
      else if (symbol == program_.open && wanted.symbol != program_.open)
        at = std::min(brackets_.partner(at) + 1, string_.size());
      else
        break;
    }
    if (!take_module(wanted, string_, at, locals)) return false;
    ++at;
  }
  return true;
}

}  // namespace cambium
