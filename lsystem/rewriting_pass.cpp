#include "lsystem/rewriting_pass.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "lsystem/large_pages.h"

namespace cambium {
namespace {

constexpr std::size_t kChunk = 8192;          // modules: a tenth of a millisecond of work
constexpr std::size_t kChunksPerThread = 16;  // of a wave: evens out chunks of unequal work, and delays of a busy machine

template <class T>
void append_all(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void append_first(const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to) {
  const std::uint32_t shift = to.back();
  for (std::size_t i = 1; i < from.size(); ++i) to.push_back(from[i] + shift);
}

template <class T>
void reserve(std::vector<T>& array, double size) {
  if (static_cast<double>(array.capacity()) >= size) return;
  array.reserve(static_cast<std::size_t>(1.1 * size) + 1);
  ask_for_large_pages(array.data() + array.size(), (array.capacity() - array.size()) * sizeof(T));
}

// In one go: growth by doubling would stop everything for a while when the string is large.
void reserve(Modules& out, double modules, double parameters) {
  reserve(out.symbol, modules);
  reserve(out.first, modules + 1);
  reserve(out.key, modules);
  reserve(out.parameters, parameters);
}

// Extrapolates from `done` of `all` modules.
void reserve_for_rest(Modules& out, std::size_t done, std::size_t all, std::size_t max_modules) {
  if (done == 0 || done >= all) return;
  const double growth = static_cast<double>(all) / static_cast<double>(done);
  const auto most = static_cast<double>(max_modules);
  reserve(out, std::min(growth * static_cast<double>(out.size()), most),
          std::min(growth * static_cast<double>(out.parameters.size()), 2.0 * most));
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
  const std::size_t step = whole ? std::max<std::size_t>(size, 1) : 8 * kChunk;
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

bool RewritingPass::fits(const Slot& slot, std::size_t modules, std::size_t parameters) const {
  return !slot.failed && !slot.cancelled && modules + slot.piece.size() <= max_modules_ &&
         parameters + slot.piece.parameters.size() <= most_parameters(max_modules_);
}

// How many slots from `begin` have pieces that may simply be appended to a string of so many modules and parameters.
std::size_t RewritingPass::sound_slots(std::size_t begin, std::size_t end, std::size_t modules, std::size_t parameters) const {
  std::size_t at = begin;
  for (; at < end && fits(slots_[at], modules, parameters); ++at) {
    modules += slots_[at].piece.size();
    parameters += slots_[at].piece.parameters.size();
  }
  return at - begin;
}

// Each array by a thread of its own: most of the time is the machine's, which hands out memory page by page.
void RewritingPass::append_pieces(std::size_t begin, std::size_t end, Modules& out) const {
  const auto each = [&](auto append) {
    return [this, begin, end, append] {
      for (std::size_t i = begin; i < end; ++i) append(slots_[i].piece);
    };
  };
  tbb::parallel_invoke(each([&](const Modules& piece) { append_all(piece.key, out.key); }),
                       each([&](const Modules& piece) { append_all(piece.parameters, out.parameters); }),
                       each([&](const Modules& piece) { append_first(piece.first, out.first); }),
                       each([&](const Modules& piece) { append_all(piece.symbol, out.symbol); }));
}

// A wave's pieces in order. What failed is done again with the room that is really left, so that the error is the one that a
// single thread would meet.
bool RewritingPass::append_wave(const PassInput& input, std::size_t first_chunk, std::size_t count, Modules& out) {
  for (std::size_t at = 0; at < count; ++at) {
    const std::size_t sound = sound_slots(at, count, out.size(), out.parameters.size());
    append_pieces(at, at + sound, out);
    at += sound;
    if (at == count) break;
    if (slots_[at].cancelled) return false;
    const std::size_t begin = (first_chunk + at) * kChunk;
    if (!first_.rewrite(input, begin, std::min(input.string.size(), begin + kChunk), max_modules_, out)) return false;
  }
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
    const bool appended = arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { rewrite_chunk(input, begin + i, limit, slots_[i]); });
      return append_wave(input, begin, count, out);
    });
    if (!appended) return false;
    reserve_for_rest(out, (begin + count) * kChunk, input.string.size(), max_modules_);
  }
  return true;
}

}  // namespace cambium
