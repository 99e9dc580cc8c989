#include "lsystem/rewriter.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

#include "lsystem/lineage.h"

namespace cambium {
namespace {

// Operations of the stack machine, rules tried and modules stepped over between two looks at the cancel flag: a few
// milliseconds.
constexpr std::uint64_t kPollWork = 500'000;
constexpr std::size_t kLongestRun = 1 << 16;  // modules copied in one go

}  // namespace

std::size_t most_parameters(std::size_t max_modules) {
  return std::min<std::size_t>(std::max<std::size_t>(8 * max_modules, 1'000'000), std::numeric_limits<std::uint32_t>::max());
}

void clear(Modules& modules) {
  modules.symbol.clear();
  modules.first.assign(1, 0);
  modules.parameters.clear();
  modules.key.clear();
}

void Rewriter::run_block(const Code& code, std::uint64_t seed, std::uint64_t which) {
  random_.reseed(seed);
  if (code.empty()) return;
  locals_.assign(program_.block_locals + 1, 0.0);
  random_.move_to(static_cast<std::uint64_t>(Stage::kBlocks), which);
  machine_.run(code, locals_.data());
}

void Rewriter::append_axiom(const System& system, std::uint64_t seed, std::size_t limit, Modules& out) {
  limit_ = limit;
  random_.reseed(seed);
  random_.move_to(static_cast<std::uint64_t>(Stage::kAxiom), 0);
  append_successor(system.axiom, 0, system.place, out);
}

void Rewriter::fail_too_many(const Place& place) const {
  throw InputError(located(program_.tables.files, place),
                   "a string of more than " + std::to_string(max_modules_) + " modules",
                   "fewer derivation steps, or a larger limit");
}

void Rewriter::check_size(const Modules& out, std::size_t modules, std::size_t parameters, const Place& place) const {
  if (out.size() + modules > limit_) fail_too_many(place);
  if (out.parameters.size() + parameters > most_parameters(max_modules_))
    throw InputError(located(program_.tables.files, place),
                     "a string of more than " + std::to_string(most_parameters(max_modules_)) + " parameters",
                     "fewer derivation steps, or a larger limit of modules");
}

void Rewriter::append_successor(const Successor& successor, std::uint64_t key, const Place& place, Modules& out) {
  check_size(out, successor.symbols.size(), successor.parameter_count, place);
  if (successor.parameter_count > 0) {
    const double* values = machine_.run(successor.parameters, locals_.data());
    out.parameters.insert(out.parameters.end(), values, values + successor.parameter_count);
  }
  out.symbol.insert(out.symbol.end(), successor.symbols.begin(), successor.symbols.end());
  for (const std::uint64_t slot : successor.slots) out.key.push_back(child_key(key, slot));
  std::uint32_t next = out.first.back();
  for (const std::uint16_t count : successor.arities) out.first.push_back(next += count);
}

void Rewriter::append(const Production& production, std::uint64_t key, Modules& out) {
  last_place_ = production.place;
  if (!production.after.empty()) machine_.run(production.after, locals_.data());
  append_successor(production.successor, key, production.place, out);
}

void Rewriter::copy(const Modules& in, std::size_t begin, std::size_t end, Modules& out) {
  const auto from = in.first[begin], to = in.first[end];
  check_size(out, end - begin, to - from, last_place_);
  const std::uint32_t shift = out.first.back() - from;  // wraps around as unsigned numbers do
  out.symbol.insert(out.symbol.end(), in.symbol.data() + begin, in.symbol.data() + end);
  out.key.insert(out.key.end(), in.key.data() + begin, in.key.data() + end);
  out.parameters.insert(out.parameters.end(), in.parameters.data() + from, in.parameters.data() + to);
  for (std::size_t i = begin; i < end; ++i) out.first.push_back(in.first[i + 1] + shift);
}

bool Rewriter::matches(const Production& production, const Site& site, ContextMatcher& contexts) {
  const std::size_t count = production.predecessor.size();
  if (site.at + count > site.string.size()) return false;
  if (locals_.size() <= production.local_count) locals_.resize(production.local_count + 1);
  std::fill_n(locals_.begin(), production.local_count, 0.0);
  double* locals = locals_.data();
  for (std::size_t i = 0; i < count; ++i)
    if (!take_module(production.predecessor[i], site.string, site.at + i, locals)) return false;
  const std::size_t right_begin = site.right_begin > 0 ? site.right_begin : site.at + count;
  if (!production.right.empty() && !contexts.right(production.right, right_begin, site.system, locals)) return false;
  if (!production.left.empty() && !contexts.left(production.left, site.left_end, site.system, locals)) return false;
  if (!production.before.empty()) machine_.run(production.before, locals);
  return production.condition.empty() || machine_.value(production.condition, locals) != 0.0;
}

// The first matching production; where that one has a weight, one of the matching weighted ones of its group, drawn by
// weight. Leaves the chosen one's variables in locals_.
const Production* Rewriter::choose(const RuleSet& rules, const Site& site, Stage stage, ContextMatcher& contexts) {
  candidates_.clear();
  candidate_locals_.clear();
  random_.move_to(static_cast<std::uint64_t>(stage), site.string.key[site.at]);
  double total = 0.0;
  std::uint64_t rule = 0;
  for (const std::uint32_t number : rules.of_symbol[site.string.symbol[site.at]]) {
    const Production& production = rules.productions[number];
    ++machine_.work;
    random_.move_to_rule(++rule);
    if (!candidates_.empty() && (production.weight.empty() || production.group != candidates_[0].production->group))
      continue;
    if (!matches(production, site, contexts)) continue;
    if (production.weight.empty()) {
      random_.move_to_successor(rule);
      return &production;
    }
    const double weight = machine_.value(production.weight, locals_.data());
    if (weight < 0.0)
      throw InputError(located(program_.tables.files, production.weight_place), "a negative weight",
                       "a weight of 0 or more");
    if (weight == 0.0) continue;
    total += weight;
    candidates_.push_back({&production, total, rule, candidate_locals_.size()});
    candidate_locals_.insert(candidate_locals_.end(), locals_.begin(), locals_.begin() + production.local_count);
  }
  return candidates_.empty() ? nullptr : draw();
}

const Production* Rewriter::draw() {
  const double drawn = random_.choice() * candidates_.back().weight;
  std::size_t chosen = 0;
  while (chosen + 1 < candidates_.size() && drawn >= candidates_[chosen].weight) ++chosen;
  const Candidate& candidate = candidates_[chosen];
  random_.move_to_successor(candidate.rule);
  std::copy_n(candidate_locals_.begin() + static_cast<std::ptrdiff_t>(candidate.first_local),
              candidate.production->local_count, locals_.begin());
  return candidate.production;
}

/// One call of rewrite().
class Rewriter::Rewriting {
 public:
  Rewriting(Rewriter& of, const PassInput& input, Modules& out)
      : of_(of), input_(input), program_(input.program), out_(out), contexts_(input.program, input.string, input.brackets) {
    callers_.push_back(&program_.main());
    use(program_.main());
  }

  /// False if cancelled.
  bool run(std::size_t begin, std::size_t end) {
    const Modules& in = input_.string;
    for (std::size_t at = begin; at < end;) {
      std::size_t idle = at;
      for (const std::size_t longest = std::min(end, at + kLongestRun); idle < longest && !acts_[in.symbol[idle]];) ++idle;
      if (idle > at) {
        of_.copy(in, at, idle, out_);
        note(at, nullptr, true);
        of_.machine_.work += (idle - at) / 8;
        at = idle;
      } else {
        const std::size_t next = module(at);
        follow_calls(at, next);
        at = next;
      }
      poll();
      if (cancelled_) return false;
    }
    return true;
  }

 private:
  void poll() {
    const std::uint64_t work = of_.machine_.work + contexts_.work;
    if (work - polled_at_ <= kPollWork) return;
    polled_at_ = work;
    cancelled_ = of_.run_.cancelled();
  }

  // From here on the rules of `system` hold.
  void use(const System& system) {
    system_ = &system;
    direct_ = input_.stage == Stage::kDerivation ? &system.productions : nullptr;
    nested_ = input_.stage == Stage::kHomomorphism ? &system.homomorphism : &system.decomposition;
    acts_.assign(program_.symbols.names().size(), 0);
    for (std::size_t symbol = 0; symbol < acts_.size(); ++symbol)
      acts_[symbol] = (direct_ && !direct_->of_symbol[symbol].empty()) || !nested_->of_symbol[symbol].empty();
    if (direct_) acts_[program_.cut] = 1;
    if (program_.systems.size() > 1) acts_[program_.call] = acts_[program_.end_call] = 1;
  }

  // Notes the origin of what has been appended since the last note; of a run each module is its own parent.
  void note(std::size_t parent, const Production* rule, bool is_run = false) {
    if (!of_.origins) return;
    while (of_.origins->size() < out_.size()) {
      of_.origins->push_back({static_cast<std::uint32_t>(parent), rule});
      if (is_run) ++parent;
    }
  }

  // Rewrites the module at `at`; where to go on.
  std::size_t module(std::size_t at) {
    const Modules& in = input_.string;
    const std::uint16_t symbol = in.symbol[at];
    const Production* production = nullptr;
    if (direct_ && !direct_->of_symbol[symbol].empty())
      production = of_.choose(*direct_, {in, at, *system_, at, 0}, Stage::kDerivation, contexts_);
    const std::size_t next = at + (production ? production->predecessor.size() : 1);
    if (production ? !nested_->empty() : !nested_->of_symbol[symbol].empty()) {
      decompose(at, next, production);
    } else if (production) {
      of_.append(*production, in.key[at], out_);
      note(at, production);
    } else if (symbol == program_.cut && direct_ && in.arity(at) == 0) {
      return end_of_cut(next);
    } else {
      stay(at);
    }
    return next;
  }

  // A module for which there are rules, none of which matched.
  void stay(std::size_t at) {
    of_.copy(input_.string, at, at + 1, out_);
    if (acts_[input_.string.symbol[at]]) out_.key.back() = older_key(out_.key.back());
    note(at, nullptr);
  }

  // Behind a cut: the end of its branch, or the end of its sub-L-system if that comes first.
  std::size_t end_of_cut(std::size_t at) {
    const Modules& in = input_.string;
    std::size_t depth = 0, calls = 0;
    for (; at < in.size(); ++at) {
      const std::uint16_t symbol = in.symbol[at];
      if (symbol == program_.close && depth-- == 0) break;
      if (symbol == program_.open) ++depth;
      if (program_.systems.size() == 1) continue;
      if (symbol == program_.end_call && calls-- == 0) break;
      if (symbol == program_.call && in.arity(at) > 0) ++calls;
    }
    return at;
  }

  // What [at, next) becomes, decomposed depth first: a rule's successor is decomposed before what stands behind its
  // predecessor.
  void decompose(std::size_t at, std::size_t next, const Production* production) {
    const Modules& in = input_.string;
    const Stage stage = input_.stage == Stage::kHomomorphism ? Stage::kHomomorphism : Stage::kDecomposition;
    Modules& first = begin_level(0, production);
    if (production) {
      of_.append(*production, in.key[at], first);
    } else {
      of_.copy(in, at, next, first);
      if (direct_) first.key.back() = older_key(in.key[at]);
    }
    pending_ = first.size();
    for (std::size_t depth = 1; depth > 0 && !cancelled_; poll()) {
      ++of_.machine_.work;
      Level& level = of_.levels_[depth - 1];
      if (level.next == level.modules.size()) {
        pending_ -= level.modules.size();
        --depth;
        continue;
      }
      const Production* rule = nullptr;
      if (depth <= static_cast<std::size_t>(nested_->max_depth) &&
          !nested_->of_symbol[level.modules.symbol[level.next]].empty())
        rule = of_.choose(*nested_, {level.modules, level.next, *system_, at, next}, stage, contexts_);
      if (!rule) {
        of_.copy(level.modules, level.next, level.next + 1, out_);
        note(at, level.rule);
        ++level.next;
        continue;
      }
      const std::uint64_t key = level.modules.key[level.next];
      level.next += rule->predecessor.size();
      Modules& made = begin_level(depth, rule);  // `level` may have moved
      of_.append(*rule, key, made);
      pending_ += made.size();
      if (pending_ > of_.limit_) of_.fail_too_many(rule->place);
      ++depth;
    }
  }

  Modules& begin_level(std::size_t depth, const Production* rule) {
    if (of_.levels_.size() <= depth) of_.levels_.resize(depth + 1);
    Level& level = of_.levels_[depth];
    clear(level.modules);
    level.next = 0;
    level.rule = rule;
    return level.modules;
  }

  // `?(n)` in what was read calls an L-system, `$` returns from it.
  void follow_calls(std::size_t from, std::size_t to) {
    if (program_.systems.size() == 1) return;
    const Modules& in = input_.string;
    for (std::size_t i = from; i < to; ++i) {
      if (in.symbol[i] == program_.call && in.arity(i) > 0) {
        const double label = in.parameters[in.first[i]];
        const System* called = program_.numbered(label);
        if (!called) fail_unknown(label);
        callers_.push_back(called);
        use(*called);
      } else if (in.symbol[i] == program_.end_call && callers_.size() > 1) {
        callers_.pop_back();
        use(*callers_.back());
      }
    }
  }

  [[noreturn]] void fail_unknown(double label) const {
    char text[40];
    std::snprintf(text, sizeof text, "?(%.9g) in the string", label);
    throw InputError(located(program_.tables.files, system_->place), text, "the label of an L-system of the file");
  }

  Rewriter& of_;
  const PassInput& input_;
  const LSystemProgram& program_;
  Modules& out_;
  ContextMatcher contexts_;
  std::vector<const System*> callers_;  // the last one's rules hold
  const System* system_ = nullptr;
  const RuleSet* direct_ = nullptr;  // null: the pass only decomposes
  const RuleSet* nested_ = nullptr;
  std::vector<std::uint8_t> acts_;  // by symbol: it may not just be copied
  std::size_t pending_ = 0;         // modules in the levels of a decomposition
  std::uint64_t polled_at_ = 0;
  bool cancelled_ = false;
};

bool Rewriter::rewrite(const PassInput& input, std::size_t begin, std::size_t end, std::size_t limit, Modules& out) {
  limit_ = limit;
  if (random_.seed() != input.seed) random_.reseed(input.seed);
  last_place_ = input.program.main().place;
  return !run_.cancelled() && Rewriting(*this, input, out).run(begin, end);
}

}  // namespace cambium
