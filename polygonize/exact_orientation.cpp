#include "polygonize/exact_orientation.h"

#include <array>

namespace cambium {
namespace {

// A sum of doubles, not overlapping, smallest first: exactly the number they stand for. No entry is 0.
template <int Capacity>
struct Expansion {
  std::array<double, Capacity> part;
  int count = 0;

  void push(double v) {
    if (v != 0) part[static_cast<std::size_t>(count++)] = v;
  }
  int sign() const {
    if (count == 0) return 0;
    return part[static_cast<std::size_t>(count - 1)] > 0 ? 1 : -1;
  }
};

struct Two {
  double high, low;
};

Two exact_sum(double a, double b) {
  const double high = a + b, b_part = high - a, a_part = high - b_part;
  return {high, (a - a_part) + (b - b_part)};
}

Two exact_product(double a, double b) {
  const double high = a * b;
  return {high, std::fma(a, b, -high)};
}

Expansion<2> difference(double a, double b) {
  const Two d = exact_sum(a, -b);
  Expansion<2> result;
  result.push(d.low);
  result.push(d.high);
  return result;
}

// Merges by magnitude and sums upwards (Shewchuk's linear expansion sum, which keeps its result non-overlapping for any
// non-overlapping operands).
template <int N, int M>
Expansion<N + M> sum(const Expansion<N>& e, const Expansion<M>& f) {
  Expansion<N + M> result;
  int i = 0, j = 0;
  const auto next = [&] {
    if (j >= f.count || (i < e.count && std::abs(e.part[static_cast<std::size_t>(i)]) < std::abs(f.part[static_cast<std::size_t>(j)]))) {
      return e.part[static_cast<std::size_t>(i++)];
    }
    return f.part[static_cast<std::size_t>(j++)];
  };
  const int total = e.count + f.count;
  if (total == 0) return result;
  const double first = next();
  if (total == 1) {
    result.push(first);
    return result;
  }
  const double second = next();
  double high = second + first, low = first - (high - second);   // |second| >= |first|
  for (int k = 2; k < total; ++k) {
    const double g = next();
    const double r = g + low, carried = low - (r - g);           // |g| >= |low|
    result.push(carried);
    const Two s = exact_sum(high, r);
    high = s.high, low = s.low;
  }
  result.push(low);
  result.push(high);
  return result;
}

template <int N>
Expansion<2 * N> scaled(const Expansion<N>& e, double b) {
  Expansion<2 * N> result;
  if (e.count == 0) return result;
  Two q = exact_product(e.part[0], b);
  result.push(q.low);
  double carry = q.high;
  for (int i = 1; i < e.count; ++i) {
    const Two t = exact_product(e.part[static_cast<std::size_t>(i)], b);
    const Two s = exact_sum(carry, t.low);
    result.push(s.low);
    const Two f = exact_sum(t.high, s.high);
    result.push(f.low);
    carry = f.high;
  }
  result.push(carry);
  return result;
}

template <int N>
Expansion<4 * N> product(const Expansion<N>& e, const Expansion<2>& f) {
  Expansion<2 * N> low, high;
  if (f.count > 0) low = scaled(e, f.part[0]);
  if (f.count > 1) high = scaled(e, f.part[1]);
  return sum(low, high);
}

template <int N>
Expansion<N> negated(Expansion<N> e) {
  for (int i = 0; i < e.count; ++i) e.part[static_cast<std::size_t>(i)] = -e.part[static_cast<std::size_t>(i)];
  return e;
}

Expansion<16> minor(const Expansion<2>& a, const Expansion<2>& b, const Expansion<2>& c, const Expansion<2>& d) {
  return sum(product(a, d), negated(product(b, c)));
}

}  // namespace

int orientation_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (const int quick = quick_orientation_3d(a, b, c, d)) return quick;
  const auto adx = difference(a.x, d.x), ady = difference(a.y, d.y), adz = difference(a.z, d.z);
  const auto bdx = difference(b.x, d.x), bdy = difference(b.y, d.y), bdz = difference(b.z, d.z);
  const auto cdx = difference(c.x, d.x), cdy = difference(c.y, d.y), cdz = difference(c.z, d.z);
  return sum(sum(product(minor(bdx, bdy, cdx, cdy), adz), product(minor(cdx, cdy, adx, ady), bdz)),
             product(minor(adx, ady, bdx, bdy), cdz))
      .sign();
}

int orientation_2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
  if (const int quick = quick_orientation_2d(a, b, c, axis)) return quick;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return minor(difference(a[u], c[u]), difference(a[v], c[v]), difference(b[u], c[u]), difference(b[v], c[v])).sign();
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation_2d(a, b, c, axis) != 0) return false;
  }
  return true;
}

}  // namespace cambium
