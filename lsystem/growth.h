// A plant at any time of its growth: also between two derivation steps.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "lsystem/growth_parts.h"
#include "lsystem/lsystem.h"

namespace cambium {

/// What the turtle walks over at some time: the homomorphism has been applied.
struct GrownString {
  ModuleString string;
  GrowthParts parts;
};

/// Derives as far as it is asked for, and keeps the strings of two steps.
///
/// Between steps k and k + 1 the string is that of step k + 1. In it a module continues its parent if it stayed, or if it is
/// the first in what was made of it that has its symbol and number of parameters: outside of brackets, else within. A module
/// that continues another has parameters in between, linearly (so have the L-system's variables): parameters that are ages
/// are exact, and the homomorphism sees them so. What continues nothing is new: it grows from nothing to what it is at step
/// k + 1, see GrowthParts. So growth is continuous, also at whole steps, but where a production replaces what is drawn by
/// something else: the one is gone and the other begins with the step. Draws are those of step k + 1.
class Growth {
 public:
  /// All references outlive it. Errors: as derive().
  Growth(const LSystem& system, const DeriveOptions& options, const RunOptions& run);
  ~Growth();
  Growth(const Growth&) = delete;
  Growth& operator=(const Growth&) = delete;

  int steps() const { return steps_; }

  /// The string at `time`, in derivation steps from 0 to steps(); at whole steps what derive() gives. Times that descend by
  /// more than a step begin anew. Errors: as derive() and interpret(). nullopt if cancelled; then it must not be asked
  /// again. Cost: the steps up to there, by one thread where `time` is between two, and the homomorphism.
  std::optional<GrownString> at(double time);

 private:
  struct Step;

  bool advance_to(double time);
  bool advance(bool with_origins);
  std::optional<GrownString> whole(ModuleString string) const;
  std::optional<GrownString> between(double part) const;

  const LSystem& system_;
  const DeriveOptions& options_;
  const RunOptions& run_;
  int steps_ = 0;
  std::unique_ptr<Step> step_;  ///< the last one made
};

/// As interpret() of a string. Nothing that has grown less than GrowthParts::kLeast is drawn.
std::optional<Turtled> interpret(const GrownString& grown, const LSystem& system, const TurtleOptions& options,
                                 const RunOptions& run);

}  // namespace cambium
