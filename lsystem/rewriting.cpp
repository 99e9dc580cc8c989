#include "lsystem/rewriting.h"

#include <algorithm>
#include <limits>
#include <string>

namespace cambium {
namespace {

std::size_t arity(const ModuleString& string, std::size_t index) { return string.first[index + 1] - string.first[index]; }

// Operations of the stack machine, rules tried and modules stepped over between two looks at the cancel flag: well below 50 ms.
constexpr std::uint64_t kPollWork = 1'000'000;

}  // namespace

Rewriter::Rewriter(const LSystemProgram& program, std::uint64_t seed, std::size_t max_modules, const RunOptions& run)
    : program_(program),
      max_modules_(max_modules),
      run_(run),
      random_(seed),
      machine_(program.files, program.arrays, random_) {
  machine_.globals = program.initial_globals;
}

bool Rewriter::cancelled() {
  polled_at_ = machine_.work;
  return run_.cancelled();
}

void Rewriter::run_block(const Code& code, std::uint64_t step, std::uint64_t which) {
  if (code.empty()) return;
  locals_.assign(program_.block_locals + 1, 0.0);
  random_.move_to(static_cast<std::uint64_t>(Stage::kBlocks), step, which);
  machine_.run(code, locals_.data());
}

ModuleString Rewriter::axiom() {
  ModuleString out;
  out.first.push_back(0);
  locals_.assign(1, 0.0);
  random_.move_to(static_cast<std::uint64_t>(Stage::kAxiom), 0, 0);
  append(out, program_.axiom, program_.place);
  return out;
}

void Rewriter::check_size(const ModuleString& out, std::size_t more, std::size_t parameters, const Place& place) const {
  if (out.size() + more > max_modules_)
    throw InputError(located(program_.files, place), "a string of more than " + std::to_string(max_modules_) + " modules",
                     "fewer derivation steps, or a larger limit");
  if (out.parameters.size() + parameters > std::numeric_limits<std::uint32_t>::max())
    throw InputError(located(program_.files, place), "more than 4294967295 parameters", "fewer derivation steps");
}

void Rewriter::append(ModuleString& out, const Successor& successor, const Place& place) {
  check_size(out, successor.symbols.size(), successor.parameter_count, place);
  if (successor.parameter_count > 0) {
    const double* values = machine_.run(successor.parameters, locals_.data());
    out.parameters.insert(out.parameters.end(), values, values + successor.parameter_count);
  }
  out.symbol.insert(out.symbol.end(), successor.symbols.begin(), successor.symbols.end());
  std::uint32_t next = out.first.back();
  for (const std::uint16_t count : successor.arities) out.first.push_back(next += count);
}

void Rewriter::copy(const ModuleString& in, std::size_t index, ModuleString& out, const Place& place) const {
  check_size(out, 1, arity(in, index), place);
  out.symbol.push_back(in.symbol[index]);
  out.parameters.insert(out.parameters.end(), in.parameters.begin() + in.first[index],
                        in.parameters.begin() + in.first[index + 1]);
  out.first.push_back(static_cast<std::uint32_t>(out.parameters.size()));
}

void Rewriter::bind(const ContextModule& module, const ModuleString& in, std::size_t index) {
  std::copy_n(in.parameters.begin() + in.first[index], module.arity, locals_.begin() + module.first_local);
}

bool Rewriter::take(const ContextModule& wanted, const ModuleString& in, std::size_t index) {
  if (in.symbol[index] != wanted.symbol || arity(in, index) != wanted.arity) return false;
  bind(wanted, in, index);
  return true;
}

// Towards the root: branches that hang to the left are stepped over, an opening bracket leads on to the parent axis.
bool Rewriter::match_left(const Production& production, const ModuleString& in, std::size_t index) {
  std::size_t at = index;
  for (const ContextModule& wanted : production.left) {
    while (true) {
      if (at == 0) return false;
      --at;
      ++machine_.work;
      const std::uint16_t symbol = in.symbol[at];
      if (symbol == program_.close) {
        at = partner_[at];
        if (at >= in.size()) return false;
      } else if (symbol != program_.open && !program_.ignored[symbol]) {
        break;
      }
    }
    if (!take(wanted, in, at)) return false;
  }
  return true;
}

// Away from the root along the same axis; `[` in a context enters the next branch, its `]` leaves it whatever else it holds.
bool Rewriter::match_right(const Production& production, const ModuleString& in, std::size_t index) {
  std::size_t at = index + 1;
  std::vector<std::size_t> ends;  // of the branches entered
  for (const ContextModule& wanted : production.right) {
    if (wanted.symbol == program_.close) {
      at = ends.back() + 1;
      ends.pop_back();
      continue;
    }
    const bool enter = wanted.symbol == program_.open;
    while (at < in.size()) {
      ++machine_.work;
      const std::uint16_t symbol = in.symbol[at];
      if (symbol == program_.open) {
        if (enter) break;
        at = partner_[at] < in.size() ? partner_[at] + 1 : in.size();
      } else if (symbol != program_.close && program_.ignored[symbol]) {
        ++at;
      } else {
        break;
      }
    }
    if (at >= in.size() || in.symbol[at] == program_.close) return false;
    if (enter) {
      if (in.symbol[at] != program_.open || partner_[at] >= in.size()) return false;
      ends.push_back(partner_[at]);
    } else if (!take(wanted, in, at)) {
      return false;
    }
    ++at;
  }
  return true;
}

bool Rewriter::matches(const Production& production, const ModuleString& in, std::size_t index) {
  if (production.predecessor.arity != arity(in, index)) return false;
  locals_.assign(production.local_count + 1, 0.0);
  bind(production.predecessor, in, index);
  if (!production.left.empty() && !match_left(production, in, index)) return false;
  if (!production.right.empty() && !match_right(production, in, index)) return false;
  if (!production.before.empty()) machine_.run(production.before, locals_.data());
  return production.condition.empty() || machine_.value(production.condition, locals_.data()) != 0.0;
}

// The first matching production; where that one has a weight, one of the matching weighted ones of its group, drawn by weight.
// Leaves the chosen one's variables in locals_.
const Production* Rewriter::choose(const ModuleString& in, std::size_t index, const RuleSet& rules) {
  candidates_.clear();
  candidate_locals_.clear();
  double total = 0.0;
  for (const std::uint32_t number : rules.of_symbol[in.symbol[index]]) {
    const Production& production = rules.productions[number];
    ++machine_.work;
    const bool drawing = !candidates_.empty();
    if (drawing && (production.weight.empty() || production.group != candidates_[0].production->group)) continue;
    if (!matches(production, in, index)) continue;
    if (production.weight.empty()) return &production;
    const double weight = machine_.value(production.weight, locals_.data());
    if (weight < 0.0)
      throw InputError(located(program_.files, production.weight_place), "a negative weight", "a weight of 0 or more");
    if (weight == 0.0) continue;
    total += weight;
    candidates_.push_back({&production, total, candidate_locals_.size()});
    candidate_locals_.insert(candidate_locals_.end(), locals_.begin(), locals_.end());
  }
  if (candidates_.empty()) return nullptr;
  const double drawn = random_.choice() * total;
  std::size_t chosen = 0;
  while (chosen + 1 < candidates_.size() && drawn >= candidates_[chosen].weight) ++chosen;
  const Candidate& candidate = candidates_[chosen];
  const auto begin = candidate_locals_.begin() + static_cast<std::ptrdiff_t>(candidate.first_local);
  locals_.assign(begin, begin + candidate.production->local_count + 1);
  return candidate.production;
}

void Rewriter::link_brackets(const ModuleString& in) {
  partner_.assign(in.size(), in.size());
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in.symbol[i] == program_.open) open.push_back(i);
    if (in.symbol[i] != program_.close || open.empty()) continue;
    partner_[i] = open.back();
    partner_[open.back()] = i;
    open.pop_back();
  }
}

Rewriter::Pass Rewriter::pass(const ModuleString& in, ModuleString& out, const RuleSet& rules, Stage stage,
                              std::uint64_t step) {
  out.symbol.clear();
  out.parameters.clear();
  out.first.assign(1, 0);
  if (rules.has_context) link_brackets(in);
  bool rewritten = false;
  Place last = program_.place;
  for (std::size_t i = 0; i < in.size(); ++i) {
    if ((i & 4095) == 0 || machine_.work - polled_at_ > kPollWork)
      if (cancelled()) return Pass::kCancelled;
    random_.move_to(static_cast<std::uint64_t>(stage), step, i);
    const Production* production = rules.of_symbol[in.symbol[i]].empty() ? nullptr : choose(in, i, rules);
    if (production) {
      rewritten = true;
      last = production->place;
      if (!production->after.empty()) machine_.run(production->after, locals_.data());
      append(out, production->successor, production->place);
      continue;
    }
    copy(in, i, out, last);
    if (in.symbol[i] != program_.cut || stage != Stage::kDerivation) continue;
    std::size_t depth = 0;
    while (i + 1 < in.size() && !(depth == 0 && in.symbol[i + 1] == program_.close)) {
      ++i;
      depth += in.symbol[i] == program_.open ? 1 : 0;
      depth -= in.symbol[i] == program_.close ? 1 : 0;
    }
  }
  return rewritten ? Pass::kRewritten : Pass::kNothingMatched;
}

bool Rewriter::expand(ModuleString& string, const RuleSet& rules, Stage stage, std::uint64_t step) {
  if (rules.empty()) return true;
  ModuleString next;
  for (int depth = 0; depth < rules.max_depth; ++depth) {
    const Pass result = pass(string, next, rules, stage, step << 20 | static_cast<std::uint64_t>(depth));
    if (result == Pass::kCancelled) return false;
    if (result == Pass::kNothingMatched) return true;
    std::swap(string.symbol, next.symbol);
    std::swap(string.first, next.first);
    std::swap(string.parameters, next.parameters);
  }
  return true;
}

}  // namespace cambium
