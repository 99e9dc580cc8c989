// How far each module of a string has grown, between two derivation steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cambium {

struct GrowthParts {
  enum class Stage : std::uint8_t {
    kOld,  ///< it, or what it continues, was there before the step
    kNew,
    kNewBelowOld,  ///< new, and something old that is drawn stands behind it in its branch
  };
  static constexpr double kLeast = 1e-3;  ///< smaller parts are not drawn

  std::vector<Stage> stages;  ///< by module; empty: all are old
  double part = 1;            ///< of what is new, in (0, 1]

  /// What lengths and sizes of organs are multiplied with.
  double size(std::size_t module) const { return stage(module) == Stage::kOld ? 1 : part < kLeast ? 0 : part; }
  /// And widths. What carries old wood is no thinner than that.
  double width(std::size_t module) const { return stage(module) == Stage::kNew ? part : 1; }
  /// And turns: where they carry nothing that was there before, they may be whole from the beginning.
  double turn(std::size_t module) const { return stage(module) == Stage::kNewBelowOld ? part : 1; }

 private:
  Stage stage(std::size_t module) const { return stages.empty() ? Stage::kOld : stages[module]; }
};

}  // namespace cambium
