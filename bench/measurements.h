// Times pieces of work with Google Benchmark, so that ratios between them can be formed.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace cambium::bench {

/// How long to measure each piece of work.
struct Pace {
  int repetitions = 12;
  double seconds = 0.02;                 ///< of each repetition, at least
  std::size_t largest_tree = 1'000'000;  ///< internodes of generated trees
  int cover_rounds = 3;                  ///< covers made of each of them, with one thread and with two
  double cover_seconds = 12;             ///< after so long a tree is measured no more
};

/// A group whose members are measured in turns: repetitions of all of them in a random order, so that a slow second of the
/// machine falls on all alike. What counts is the fastest repetition.
class Measurements {
 public:
  explicit Measurements(Pace pace) : pace_(pace) {}

  /// `work` is one iteration. It must store what it computes where the compiler cannot see that it is unused.
  void add(std::string name, std::function<void()> work);
  void run();
  /// Processor time of one iteration, nanoseconds. Errors: std::out_of_range if it was not run.
  double ns(const std::string& name) const;

 private:
  Pace pace_;
  std::vector<std::pair<std::string, std::function<void()>>> work_;
  std::map<std::string, double> fastest_;
};

}  // namespace cambium::bench
