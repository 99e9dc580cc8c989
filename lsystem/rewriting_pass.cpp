#include "lsystem/rewriting_pass.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace cambium {
namespace {

constexpr std::size_t kChunk = 4096;         // modules: some 50 microseconds of work
constexpr std::size_t kChunksPerThread = 8;  // of a wave: evens out chunks of unequal work

template <class T>
void append_all(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void append_modules(const Modules& from, Modules& to) {
  const std::uint32_t shift = to.first.back();
  append_all(from.symbol, to.symbol);
  append_all(from.parameters, to.parameters);
  append_all(from.key, to.key);
  for (std::size_t i = 0; i < from.size(); ++i) to.first.push_back(from.first[i + 1] + shift);
}

// As many as `modules` and `parameters`, in one go: growth by doubling would stop everything for a while when the string is
// large.
void reserve(Modules& out, double modules, double parameters) {
  if (static_cast<double>(out.symbol.capacity()) < modules) {
    out.symbol.reserve(static_cast<std::size_t>(modules));
    out.first.reserve(static_cast<std::size_t>(modules) + 1);
    out.key.reserve(static_cast<std::size_t>(modules));
  }
  if (static_cast<double>(out.parameters.capacity()) < parameters)
    out.parameters.reserve(static_cast<std::size_t>(parameters));
}

// Extrapolates from `done` of `all` modules.
void reserve_for_rest(Modules& out, std::size_t done, std::size_t all, std::size_t max_modules) {
  if (done == 0 || done >= all) return;
  const double growth = 1.05 * static_cast<double>(all) / static_cast<double>(done);
  reserve(out, std::min(growth * static_cast<double>(out.size()), static_cast<double>(max_modules)),
          std::min(growth * static_cast<double>(out.parameters.size()), 2.0 * static_cast<double>(max_modules)));
}

}  // namespace

RewritingPass::RewritingPass(const LSystemProgram& program, std::size_t max_modules, const RunOptions& run,
                             const Printer* printer)
    : variables(program.initial_globals),
      program_(program),
      max_modules_(std::min<std::size_t>(max_modules, 4'000'000'000)),
      run_(run),
      threads_(run.threads > 0 ? run.threads : tbb::info::default_concurrency()),
      first_(program, variables, run_, max_modules_, printer) {}

void RewritingPass::axiom(Modules& out) {
  clear(out);
  first_.append_axiom(program_.main(), seed, max_modules_, out);
}

void RewritingPass::run_block(Code System::*block, std::uint64_t which) {
  for (std::size_t i = 0; i < program_.systems.size(); ++i) {
    first_.run_block(program_.systems[i].*block, seed, which * program_.systems.size() + i);
    seed = first_.seed();
  }
}

bool RewritingPass::has_to_be_in_order(const Modules& in, Stage stage) const {
  bool calls = false;
  for (const System& system : program_.systems) {
    if (stage == Stage::kDerivation && system.productions.in_order) return true;
    if ((stage == Stage::kHomomorphism ? system.homomorphism : system.decomposition).in_order) return true;
    calls = calls || program_.systems.size() > 1;
  }
  const auto holds = [&](std::uint16_t symbol) {
    return std::find(in.symbol.begin(), in.symbol.end(), symbol) != in.symbol.end();
  };
  return (calls && holds(program_.call)) || (stage == Stage::kDerivation && holds(program_.cut));
}

// Links brackets if any rule looks at contexts; false if cancelled.
bool RewritingPass::prepare(const Modules& in, Stage stage) {
  for (const System& system : program_.systems) {
    const RuleSet& nested = stage == Stage::kHomomorphism ? system.homomorphism : system.decomposition;
    if (nested.has_context || (stage == Stage::kDerivation && system.productions.has_context))
      return brackets_.link(in, program_.open, program_.close, run_);
  }
  return true;
}

bool RewritingPass::rewrite(const Modules& in, Stage stage, Modules& out) {
  clear(out);
  if (!prepare(in, stage)) return false;
  const PassInput input{program_, in, brackets_, stage, seed};
  if (threads_ == 1 || in.size() <= 2 * kChunk || has_to_be_in_order(in, stage)) return in_one_chunk(input, out);
  return in_waves(input, out);
}

bool RewritingPass::rewrite(const Modules& in, Stage stage, Modules& out, std::vector<Rewriter::Origin>& origins) {
  clear(out);
  origins.clear();
  if (!prepare(in, stage)) return false;
  first_.origins = &origins;
  const bool done = in_one_chunk({program_, in, brackets_, stage, seed}, out);
  first_.origins = nullptr;
  return done;
}

// In order; where that is not asked for still in pieces, to see how much room the whole will need.
bool RewritingPass::in_one_chunk(const PassInput& input, Modules& out) {
  const std::size_t size = input.string.size();
  const bool whole = first_.origins || has_to_be_in_order(input.string, input.stage);
  const std::size_t step = whole ? std::max<std::size_t>(size, 1) : 16 * kChunk;
  if (whole) reserve(out, static_cast<double>(size), static_cast<double>(input.string.parameters.size()));
  for (std::size_t begin = 0; begin < size; begin += step) {
    if (!first_.rewrite(input, begin, std::min(size, begin + step), max_modules_, out)) return false;
    reserve_for_rest(out, std::min(size, begin + step), size, max_modules_);
  }
  seed = first_.seed();  // a production may have called srand
  return true;
}

void RewritingPass::rewrite_chunk(const PassInput& input, std::size_t chunk, std::size_t limit, Slot& slot) {
  clear(slot.piece);
  slot.failed = slot.cancelled = false;
  const std::size_t begin = chunk * kChunk;
  try {
    slot.cancelled = !slot.rewriter->rewrite(input, begin, std::min(input.string.size(), begin + kChunk), limit, slot.piece);
  } catch (const InputError&) {
    slot.failed = true;
  }
}

// What failed is done again with the room that is really left, so that the error is the one that a single thread would meet.
bool RewritingPass::append_piece(const PassInput& input, std::size_t chunk, Slot& slot, Modules& out) {
  if (slot.cancelled) return false;
  const bool too_long = out.size() + slot.piece.size() > max_modules_ ||
                        out.parameters.size() + slot.piece.parameters.size() > most_parameters(max_modules_);
  if (slot.failed || too_long) {
    const std::size_t begin = chunk * kChunk;
    return first_.rewrite(input, begin, std::min(input.string.size(), begin + kChunk), max_modules_, out);
  }
  append_modules(slot.piece, out);
  return true;
}

bool RewritingPass::in_waves(const PassInput& input, Modules& out) {
  const std::size_t chunks = (input.string.size() + kChunk - 1) / kChunk;
  slots_.resize(static_cast<std::size_t>(threads_) * kChunksPerThread);
  for (Slot& slot : slots_)
    if (!slot.rewriter) slot.rewriter = std::make_unique<Rewriter>(program_, variables, run_, max_modules_);
  tbb::task_arena arena(threads_);
  for (std::size_t begin = 0; begin < chunks; begin += slots_.size()) {
    const std::size_t count = std::min(slots_.size(), chunks - begin);
    const std::size_t limit = max_modules_ - out.size();
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { rewrite_chunk(input, begin + i, limit, slots_[i]); });
    });
    for (std::size_t i = 0; i < count; ++i)
      if (!append_piece(input, begin + i, slots_[i], out)) return false;
    reserve_for_rest(out, (begin + count) * kChunk, input.string.size(), max_modules_);
  }
  return true;
}

}  // namespace cambium
