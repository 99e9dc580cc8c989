// The rows of the table that the benchmark prints, and of its JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cambium::bench {

/// What a ratio (or figure) has to be for the target to be met.
struct Target {
  enum class Side { kAtLeast, kAtMost };
  Side side = Side::kAtMost;
  double bound = 0;
  bool met_by(double measured) const { return side == Side::kAtLeast ? measured >= bound : measured <= bound; }
};

inline Target at_least(double bound) { return {Target::Side::kAtLeast, bound}; }
inline Target at_most(double bound) { return {Target::Side::kAtMost, bound}; }

/// One line. Every member but `what` may be missing. The target judges the ratio, or the figure where there is no ratio.
struct Row {
  std::string what;
  std::optional<double> figure{};
  std::string unit{};  ///< of the figure: "ns/sample", "s", "B/internode"
  std::optional<double> ratio{};
  std::string ratio_to{};  ///< what the ratio is to: "yardstick", "value"
  std::optional<Target> target{};

  /// Nullopt where nothing is asked.
  std::optional<bool> met() const;
};

/// Lines under headings, in the order in which they were added.
class Report {
 public:
  void heading(std::string text);
  void add(Row row);
  /// A line of words, such as a condition under which the rows above were measured.
  void note(std::string text);
  std::size_t judged() const;  ///< rows with a target
  std::size_t missed() const;  ///< those whose target is not met

  /// Fixed columns; a figure per `ns` also gives its rate in millions per second.
  std::string table() const;
  std::string json() const;

 private:
  struct Line {
    enum class Kind { kHeading, kRow, kNote } kind = Kind::kRow;
    std::string text;
    Row row;
  };
  std::vector<Line> lines_;
};

}  // namespace cambium::bench
