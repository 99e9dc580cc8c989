#include "lsystem/counter_random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

// The finalizer of splitmix64 (Steele, Lea, Flood 2014): a bijection that passes the usual batteries on a counter.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

constexpr std::uint64_t kChoiceStream = 0xc01ce;

}  // namespace

void CounterRandom::move_to(std::uint64_t stage, std::uint64_t step, std::uint64_t position) {
  place_ = mixed(mixed(mixed(stage) ^ step) ^ position);
  count_ = 0;
}

double CounterRandom::uniform() { return unit(mixed(mixed(mixed(seed_) ^ place_) ^ count_++)); }

double CounterRandom::choice() const { return unit(mixed(mixed(mixed(seed_) ^ place_) ^ (kChoiceStream << 32))); }

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

}  // namespace cambium
