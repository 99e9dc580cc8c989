// Passes over a whole string by all threads, and the state that lasts from one to the next.
//
// How a derivation is fast. A string is four flat arrays, so a run of modules without rules is four block copies. A rule is
// found through a table by symbol; its conditions and parameters are bytecode over doubles, constants folded. A pass only
// reads the old string, contexts included, and a module's draws depend on its key alone: so the string is cut into chunks
// that any thread may rewrite into a piece of its own, and the pieces, put together in order, are the same bytes for any
// number of threads. Chunks go in waves, so that no more than a wave's pieces stand beside the two strings, and a limit is
// noticed within a wave.
//
// Where order matters a pass is one chunk: rules with effects outside of their module (RuleSet::in_order, which predecessors
// of several modules set as well, since a match decides where the next one begins), a `%`, which takes what follows it, and
// `?(n)`.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lsystem/rewriter.h"

namespace cambium {

class RewritingPass {
 public:
  RewritingPass(const LSystemProgram& program, std::size_t max_modules, const RunOptions& run,
                const Printer* printer = nullptr);

  /// Starts with the axiom, undecomposed.
  void axiom(Modules& out);
  /// `out` is overwritten. False if cancelled. Errors: InputError, the first in the string's order whatever the threads do.
  bool rewrite(const Modules& in, Stage stage, Modules& out);
  /// The same by one thread, with the origins of what it makes.
  bool rewrite(const Modules& in, Stage stage, Modules& out, std::vector<Rewriter::Origin>& origins);
  void run_block(Code System::*block, std::uint64_t which);  ///< of every L-system of the file

  std::uint64_t seed = 0;
  std::vector<double> variables;

 private:
  struct Slot {  // for one chunk of a wave
    std::unique_ptr<Rewriter> rewriter;
    Modules piece;
    bool failed = false;
    bool cancelled = false;
  };

  bool prepare(const Modules& in, Stage stage);
  bool has_to_be_in_order(const Modules& in, Stage stage) const;
  bool in_one_chunk(const PassInput& input, Modules& out);
  bool in_waves(const PassInput& input, Modules& out);
  void rewrite_chunk(const PassInput& input, std::size_t chunk, std::size_t limit, Slot& slot);
  bool fits(const Slot& slot, std::size_t modules, std::size_t parameters) const;
  std::size_t sound_slots(std::size_t begin, std::size_t end, std::size_t modules, std::size_t parameters) const;
  void append_pieces(std::size_t begin, std::size_t end, Modules& out) const;
  bool append_wave(const PassInput& input, std::size_t first_chunk, std::size_t count, Modules& out);

  const LSystemProgram& program_;
  std::size_t max_modules_;
  RunOptions run_;
  int threads_;
  Rewriter first_;  // for what one thread does
  std::vector<Slot> slots_;
  BracketPairs brackets_;
};

}  // namespace cambium
