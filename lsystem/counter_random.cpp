#include "lsystem/counter_random.h"

#include "lsystem/lineage.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

constexpr std::uint64_t kChoiceStream = 0xc01ceull << 44;  // no rule has so high a number

}  // namespace

void CounterRandom::reseed(std::uint64_t seed) {
  seed_ = seed;
  placed_ = false;
}

void CounterRandom::move_to(std::uint64_t stage, std::uint64_t key) {
  stage_ = stage;
  key_ = key;
  count_ = 0;
  placed_ = false;
}

std::uint64_t CounterRandom::place() {
  if (!placed_) place_ = mixed(mixed(mixed(seed_) ^ stage_) ^ key_);
  placed_ = true;
  return place_;
}

double CounterRandom::uniform() { return unit(mixed(place() ^ count_++)); }

double CounterRandom::choice() { return unit(mixed(place() ^ kChoiceStream)); }

// Box and Muller 1958; the second of the pair is thrown away so that a draw stays a function of its number.
double CounterRandom::normal() {
  const double u = 1.0 - uniform();
  const double v = uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

// Marsaglia and Tsang 2000, with their boost for shapes below 1.
double CounterRandom::gamma(double shape) {
  const double boosted = shape < 1.0 ? shape + 1.0 : shape;
  const double d = boosted - 1.0 / 3.0;
  const double c = 1.0 / std::sqrt(9.0 * d);
  double result = d;
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const double x = normal();
    const double root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    const double u = 1.0 - uniform();
    if (std::log(u) < 0.5 * x * x + d - d * v + d * std::log(v)) {
      result = d * v;
      break;
    }
  }
  if (shape < 1.0) result *= std::pow(1.0 - uniform(), 1.0 / shape);
  return result;
}

double CounterRandom::beta(double a, double b) {
  const double x = gamma(a);
  const double y = gamma(b);
  return x + y > 0.0 ? x / (x + y) : (uniform() < a / (a + b) ? 1.0 : 0.0);
}

double CounterRandom::binomial(double n, double p) {
  double successes = 0;
  for (double trial = 1; trial <= n; ++trial) successes += uniform() < p ? 1 : 0;
  return successes;
}

}  // namespace cambium
