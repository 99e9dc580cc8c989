// How often a repeating texture goes round a branch, and the length of a repeat that suits a whole tree.
#pragma once

#include <cstddef>
#include <vector>

namespace cambium {

/// How often the texture may go round: 1, 2, 3, 4, 6, 8, 12 ... Neighbours are at most twice each other, so the nearest is never
/// off by more than sqrt(2), and the texture's density (the root of the ratio of areas) by 19 %; a tapering branch changes it seldom.
int wraps_of_step(int step);
/// The nearest step, by ratio, for a girth of so many repeats.
int step_of_wraps(double repeats);

/// Surface by its branches' radius.
class RadiusAreas {
 public:
  void add(double radius, double area);
  void add(const RadiusAreas& other);
  /// The longest repeat at which the texture's density stays near its median on nearly all of the area. 0 where there is none.
  double best_repeat() const;

 private:
  static constexpr int kPerOctave = 16, kLeast = -20;      // from 2^-20 m to 2^12 m
  static constexpr std::size_t kBins = 32 * kPerOctave;
  std::vector<double> areas_ = std::vector<double>(kBins, 0.0);
};

}  // namespace cambium
