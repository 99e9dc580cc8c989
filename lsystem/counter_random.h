// Random numbers that depend on where they are drawn, not on what was drawn before elsewhere.
#pragma once

#include <cstdint>

namespace cambium {

/// Draws of one place: a function of (seed, stage, step, position, number of the draw). The same on every machine and for any
/// thread count.
class CounterRandom {
 public:
  explicit CounterRandom(std::uint64_t seed) : seed_(seed) {}

  void reseed(std::uint64_t seed) { seed_ = seed; }
  void move_to(std::uint64_t stage, std::uint64_t step, std::uint64_t position);

  double uniform();                           ///< in [0, 1)
  double normal();                            ///< mean 0, standard deviation 1
  double beta(double a, double b);            ///< a, b > 0
  double choice() const;                      ///< in [0, 1); always the same at one place, apart from the draws

 private:
  double gamma(double shape);

  std::uint64_t seed_;
  std::uint64_t place_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace cambium
