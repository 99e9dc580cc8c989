// Random numbers that depend on where they are drawn, not on what was drawn before elsewhere.
#pragma once

#include <cstdint>

namespace cambium {

/// Draws of one place: a function of (seed, stage, key, rule, number of the draw). The same on every machine and for any thread
/// count. Moving is cheap: nothing is hashed before the first draw.
class CounterRandom {
 public:
  explicit CounterRandom(std::uint64_t seed) : seed_(seed) {}

  std::uint64_t seed() const { return seed_; }
  void reseed(std::uint64_t seed);
  /// `key`: a module's lineage, or any number that tells one place from another.
  void move_to(std::uint64_t stage, std::uint64_t key);
  /// Draws of one rule tried at this place do not depend on how many another one made.
  void move_to_rule(std::uint64_t rule) { count_ = rule << 32; }
  /// Nor those of its successor on how many its condition made.
  void move_to_successor(std::uint64_t rule) { count_ = rule << 32 | 1u << 31; }

  double uniform();                           ///< in [0, 1)
  double normal();                            ///< mean 0, standard deviation 1
  double beta(double a, double b);            ///< a, b > 0
  double binomial(double n, double p);        ///< successes of n trials, 0 <= n <= 1e6, 0 <= p <= 1
  double choice();                            ///< in [0, 1); always the same at one place, apart from the draws

 private:
  double gamma(double shape);
  std::uint64_t place();

  std::uint64_t seed_;
  std::uint64_t stage_ = 0, key_ = 0;
  std::uint64_t place_ = 0;
  std::uint64_t count_ = 0;
  bool placed_ = false;
};

}  // namespace cambium
