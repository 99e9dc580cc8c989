// A derivation under way, step by step: what derive(), explain_step() and Growth have in common.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lsystem/lsystem.h"
#include "lsystem/program.h"
#include "lsystem/rewriting_pass.h"

namespace cambium {

/// All references outlive it. Its functions are false, or nullopt, if cancelled, and throw what derive() does.
class Derivation {
 public:
  /// Errors: InputError if nothing says how many steps.
  Derivation(const LSystem& system, const DeriveOptions& options, const RunOptions& run);

  int steps() const { return steps_; }          ///< in all
  std::uint64_t step() const { return step_; }  ///< that are done
  const Modules& modules() const { return modules_; }
  const std::vector<double>& variables() const { return pass_.variables; }

  /// The Start blocks and the axiom.
  bool begin();
  bool advance();
  /// The same, with the string before it and the origins of what is in it after.
  bool advance(Modules& before, std::vector<Rewriter::Origin>& origins);
  /// As cpfg, which draws every string and so answers what it asks. Does nothing a second time.
  bool answer();
  /// The End blocks.
  void end() { pass_.run_block(&System::end, 1); }

  ModuleString named(Modules modules) const;
  /// The string, taken away.
  ModuleString take() { return named(std::move(modules_)); }

 private:
  bool begin_step();
  bool end_step();
  void take_next();

  const LSystem& system_;
  const DeriveOptions& options_;
  const LSystemProgram& program_;
  const RunOptions& run_;
  RewritingPass pass_;
  bool asks_ = false;      // there may be queries
  bool answered_ = false;  // the string's
  int steps_ = 0;
  std::uint64_t step_ = 0;
  Modules modules_, next_;
};

}  // namespace cambium
