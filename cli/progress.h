// A line on the terminal that says how far the work is.
#pragma once

#include <chrono>
#include <string_view>

namespace cambium {

/// Shows on stderr, only if that is a terminal. Not thread safe: RunOptions::progress is called one at a time.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::string_view stage, double fraction);  ///< fraction in [0, 1]; at most ten times a second
  void clear();

 private:
  bool wanted_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace cambium
