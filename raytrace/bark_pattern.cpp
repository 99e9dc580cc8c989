#include "raytrace/bark_pattern.h"

#include "raytrace/bark_lattice.h"
#include "blobtree/place_hash.h"

#include <array>
#include <cmath>
#include <mutex>
#include <numbers>

namespace cambium {
namespace {

/// What the styles have in common: how large a plate or pore is where it grows on a radius of 12 cm, and how much it grows
/// with the girth (plates of a thick trunk are larger than those of a thin one, but not in proportion).
struct Growth {
  double width = 0.03;      ///< metres around the girth
  double power = 0.5;       ///< width goes with radius^power
  double elongation = 1;    ///< height of a cell over its width
};
constexpr double kUsualOctave = -3.0589;   // log2 of 0.12

Growth growth_of(BarkStyle style) {
  switch (style) {
    case BarkStyle::kRidged: return {0.030, 0.55, 5.0};
    case BarkStyle::kPlated: return {0.055, 0.60, 1.7};
    case BarkStyle::kSmooth: return {0.040, 0.75, 1.0};
    case BarkStyle::kBirch: return {0.110, 0.75, 0.22};
  }
  return {};
}

/// Deep furrows that braid around long flat ridges.
template <BarkNumber N>
BarkTexel<N> ridged(const BarkLattice<N>& at, double open) {
  const N wander = 0.80 * at.noise(1, 1.3, 1) + 0.22 * at.noise(3, 5, 2);
  const N rise = 0.25 * at.noise(2, 2, 3);
  const N ragged = 0.060 * at.fine_noise(0.25, 7, 28, 4) + 0.035 * at.fine_noise(0.09, 18, 80, 5);
  const auto ridge = at.cells(at.x + wander, at.y + rise, 0.95, 0);
  // Some furrows are wide, others hardly open.
  const N body = smooth(-0.02, 0.30 * open, ridge.border + ragged + (0.12 * open) * at.noise(1, 0.8, 11));
  // The flat top is broken into small scales and weathered; grey crusts grow on it.
  const auto scale = at.fine_cells(0.3, 3.0 * at.x + 1.2 * wander + 3.0 * ragged, 6.0 * at.y + 10.0 * ragged, 0.95, 6, 3, 6.0);
  const double scaly = at.kept(0.3);
  const N chipped = at.faded(smooth(0.15, 0.02, scale.border + 2.0 * ragged), 0.3, 0.23);
  const N patch = at.noise(3, 7, 13);
  const N grain = (0.9 + patch) * at.fine_noise(0.1, 10, 24, 7) + 0.6 * (0.9 - patch) * at.fine_noise(0.03, 31, 90, 8);
  const N crust = at.faded(smooth(0.08, 0.30, patch + 0.5 * grain), 0.3, 0.18);
  const N top = 0.84 + 0.18 * scaly * (scale.random - 0.5) - 0.18 * chipped + 0.085 * grain + 0.03 * crust;
  BarkTexel<N> out;
  const N height = body * top;
  out.relief = 0.42 * at.width * open * (height - 1.0);
  out.height = std::clamp(value_of(height), 0.0, 1.0);
  const double b = value_of(body), cover = smooth(0.10, 0.80, b), pale = b * value_of(crust);
  const double shade = 0.96 + 0.36 * (ridge.random - 0.5) + 0.22 * scaly * (scale.random - 0.5) + 0.32 * value_of(grain) -
                       0.36 * value_of(chipped) + 0.34 * value_of(at.noise(1, 0.4, 9)) + 0.22 * pale;
  out.outer = cover * shade;
  out.inner = (1 - cover) * (1 + 0.5 * value_of(grain));
  out.warm = cover * (1.0 * (1 - b) + 0.8 * scaly * (scale.random - 0.5) + 0.9 * value_of(at.noise(1, 0.7, 10)) - 0.35 * pale);
  out.roughness = 0.88 + 0.08 * (1 - b);
  return out;
}

/// Large plates, split in layers whose edges flake off.
template <BarkNumber N>
BarkTexel<N> plated(const BarkLattice<N>& at, double open) {
  const N bend = 0.45 * at.noise(1, 1, 1) + 0.14 * at.noise(4, 4, 2), rise = 0.40 * at.noise(1, 1.4, 3) + 0.12 * at.noise(4, 5, 4);
  const N ragged = 0.05 * at.fine_noise(0.2, 9, 12, 5) + 0.025 * at.fine_noise(0.07, 25, 34, 6);
  const auto plate = at.cells(at.x + bend, at.y + rise, 0.95, 0);
  const N body = smooth(-0.02, 0.19 * open, plate.border + ragged + (0.08 * open) * at.noise(1, 1, 13));
  // Sheets: the steps of a slow noise that follows the plate's border, each with its own tone.
  const N slow = 2.6 * at.noise(2, 2, 7) + 1.5 * at.noise(5, 5, 8) + 9.0 * ragged + 3.0 * plate.border + 9 * plate.random;
  const double whole = std::floor(value_of(slow)), sheet = at.kept(0.15);
  const N past = slow - whole, step = smooth(0.0, 0.22, past);
  const double last = at.random(whole - 1) - 0.5, layer = sheet * (last + value_of(step) * (at.random(whole) - 0.5 - last));
  const N grain = at.fine_noise(0.06, 17, 22, 9) + 0.6 * at.fine_noise(0.025, 45, 60, 11);
  BarkTexel<N> out;
  // Every sheet's edge is a small step; the sheet itself leans the other way, so that steps do not add up.
  const N top = 0.86 + sheet * 0.12 * (step - past) + 0.06 * grain;
  const N height = body * top;
  out.relief = 0.26 * at.width * open * (height - 1.0);
  out.height = std::clamp(value_of(height), 0.0, 1.0);
  const double b = value_of(body), cover = smooth(0.05, 0.60, b), edge = 0.11 + sheet * (0.89 - value_of(step));
  const double shade = 1 + 0.30 * layer + 0.25 * (plate.random - 0.5) + 0.26 * value_of(grain) - 0.30 * edge +
                       0.25 * value_of(at.noise(1, 1, 12));
  out.outer = cover * shade;
  out.inner = (1 - cover) * (1 + 0.4 * value_of(grain));
  out.warm = cover * (1.2 * layer + 0.9 * edge + 0.8 * (1 - b) + 1.0 * value_of(at.noise(1, 0.8, 10)));
  out.roughness = 0.80 + 0.12 * (1 - b);
  return out;
}

/// Skin with pores, wrinkles across and blotches.
template <BarkNumber N>
BarkTexel<N> smooth_skin(const BarkLattice<N>& at, double) {
  const N pore = at.pores(at.x + 0.1 * at.noise(2, 2, 10), 1.6 * at.y, 0.65, 0.19, 0.085, 0.12, 1);
  const N wrinkle = at.fine_noise(0.12, 3, 14, 2) + 0.7 * at.fine_noise(0.05, 9, 40, 3);
  const N swell = at.noise(1, 0.8, 4);
  const N grain = at.fine_noise(0.06, 17, 20, 5) + 0.7 * at.fine_noise(0.025, 41, 45, 11);
  const double blotch = smooth(-0.10, 0.25, value_of(at.noise(1, 0.9, 6)) + 0.5 * value_of(at.fine_noise(0.2, 5, 5, 7)) +
                                                0.35 * value_of(grain));
  BarkTexel<N> out;
  const N height = 0.80 + 0.13 * wrinkle + 0.20 * swell + 0.045 * grain + 0.30 * pore;
  out.relief = 0.065 * at.width * (height - 1.0);
  out.height = std::clamp(0.92 + 0.07 * value_of(wrinkle), 0.0, 1.0);
  const double p = value_of(pore);
  const double shade = 1 + 0.30 * (blotch - 0.5) + 0.24 * value_of(wrinkle) + 0.20 * value_of(grain) +
                       0.22 * value_of(at.fine_noise(0.3, 4, 0.5, 8));
  out.outer = (1 - 0.85 * p) * shade;
  out.inner = 0.85 * p;
  out.warm = (1 - p) * (1.0 * value_of(at.noise(1, 0.5, 9)) - 0.4 * (blotch - 0.5));
  out.roughness = 0.62 + 0.10 * blotch + 0.15 * p;
  return out;
}

/// White paper with dark bands, that peels in thin curls.
template <BarkNumber N>
BarkTexel<N> birch(const BarkLattice<N>& at, double) {
  const N ragged = at.fine_noise(0.03, 22, 8, 1);
  const N band = at.pores(at.x, 0.7 * at.y + 0.05 * ragged, 0.40, 0.46, 0.09, 0.05, 2);
  const N dash = at.pores(6.0 * at.x, 1.7 * at.y + 0.05 * ragged, 0.38, 0.42, 0.09, 0.03, 3, 6);
  const N sheet = at.noise(1, 0.8, 4) + 0.25 * at.fine_noise(0.08, 6, 2, 5) + 0.10 * ragged;
  // A sheet that has come off shows the young, warmer one below, and throws up its rim.
  const N peeled = at.faded(smooth(0.24, 0.27, sheet), 0.04, 0.08);
  const N rim = peeled * smooth(0.34, 0.25, sheet);
  const N mark = larger(band, 0.75 * dash);
  BarkTexel<N> out;
  const N height = 0.86 + 0.10 * sheet - 0.20 * mark - 0.14 * peeled + 0.26 * rim;
  out.relief = 0.018 * at.width * (height - 1.0);
  out.height = std::clamp(0.95 - 0.25 * value_of(mark), 0.0, 1.0);
  const double m = value_of(mark), p = value_of(peeled), r = value_of(rim);
  const double streak = value_of(at.fine_noise(0.02, 5, 12, 6));
  out.outer = (1 - 0.92 * m) * (1 + 0.12 * value_of(sheet) + 0.10 * streak - 0.12 * p - 0.1 * r + 0.2 * value_of(at.noise(1, 0.1, 7)));
  out.inner = 0.92 * m;
  out.warm = (1 - m) * (0.9 * p + 0.3 * value_of(sheet));
  out.roughness = 0.55 + 0.3 * m;
  return out;
}

template <BarkNumber N>
BarkTexel<N> styled(BarkStyle style, const BarkLattice<N>& at, double open) {
  switch (style) {
    case BarkStyle::kRidged: return ridged(at, open);
    case BarkStyle::kPlated: return plated(at, open);
    case BarkStyle::kSmooth: return smooth_skin(at, open);
    case BarkStyle::kBirch: return birch(at, open);
  }
  return {};
}

template <BarkNumber N>
BarkTexel<N> mixed_texels(const BarkTexel<N>& a, const BarkTexel<N>& b, double t) {
  return {mixed(a.relief, b.relief, t),   mixed(a.height, b.height, t), mixed(a.outer, b.outer, t),
          mixed(a.inner, b.inner, t),     mixed(a.warm, b.warm, t),     mixed(a.roughness, b.roughness, t), mixed(a.young, b.young, t)};
}

BarkTexel<double> sum_of(const BarkTexel<double>& a, const BarkTexel<double>& b) {
  return {a.relief + b.relief, a.height + b.height, a.outer + b.outer, a.inner + b.inner, a.warm + b.warm, a.roughness + b.roughness,
          a.young + b.young};
}

constexpr BarkTexel<double> kNothing{0.0, 0, 0, 0, 0, 0, 0};

/// The mean of a style over enough of it; relief in widths of a column.
BarkTexel<double> averaged(BarkStyle style, double open) {
  constexpr int kSide = 56, kColumns = 28;
  BarkTexel<double> sum = kNothing;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = kColumns * (i % kSide + 0.5) / kSide, y = kColumns * (i / kSide + 0.5) / kSide;
    sum = sum_of(sum, styled(style, BarkLattice<double>{x, y, 1, growth_of(style).elongation, kColumns, 77, 0}, open));
  }
  return mixed_texels(kNothing, sum, 1.0 / (kSide * kSide));
}

/// The means of all styles, each worked out when it is first asked for: that takes some milliseconds.
class MeanTexels {
 public:
  BarkTexel<double> at(BarkStyle style, double open) {
    const double place = std::clamp(open, 0.0, 1.0) * kSteps;
    const auto step = static_cast<std::size_t>(place);
    const double past = place - static_cast<double>(step);
    return past > 0 ? mixed_texels(known(style, step), known(style, step + 1), past) : known(style, step);
  }

 private:
  static constexpr std::size_t kSteps = 4;
  struct Entry {
    std::once_flag made;
    BarkTexel<double> mean;
  };

  const BarkTexel<double>& known(BarkStyle style, std::size_t step) {
    Entry& entry = entries_[static_cast<std::size_t>(style)][step];
    std::call_once(entry.made, [&] { entry.mean = averaged(style, std::max(1e-3, static_cast<double>(step) / kSteps)); });
    return entry.mean;
  }

  std::array<std::array<Entry, kSteps + 1>, 4> entries_;
};

BarkTexel<double> mean_texel(BarkStyle style, double open) {
  static MeanTexels means;
  return means.at(style, open);
}

/// One style at one octave of the girth: a lattice with its own number of columns and its own metres per row.
template <BarkNumber N>
BarkTexel<N> at_octave(BarkStyle style, const BarkPatternKind& kind, double octave, const N& u, const N& v, double footprint,
                       double open) {
  const Growth growth = growth_of(style);
  const double girth = 2 * std::numbers::pi * std::numbers::sqrt2 * std::ldexp(1.0, static_cast<int>(octave));   // in the octave's middle
  const double wanted = growth.width * kind.scale * std::exp2(growth.power * (octave + 0.5 - kUsualOctave));
  const double columns = std::clamp(std::round(girth / wanted), 4.0, 4096.0), width = girth / columns;
  const double near = 1 - smooth(0.25, 1.0, footprint / width);
  const auto far = [&]() -> BarkTexel<N> {
    const BarkTexel<double> mean = mean_texel(style, open);
    return {N(mean.relief * width), mean.height, mean.outer, mean.inner, mean.warm, mean.roughness, 0};
  };
  if (!(near > 0)) return far();
  const std::uint64_t seed = hash_of(kind.seed, static_cast<std::uint64_t>(octave + 1024), static_cast<std::uint64_t>(style));
  const BarkLattice<N> at{u * columns, v * (1 / (width * growth.elongation)), width, growth.elongation,
                          static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(seed), footprint};
  const BarkTexel<N> texel = styled(style, at, open);
  return near < 1 ? mixed_texels(far(), texel, near) : texel;
}

// A pattern's height in metres must follow the girth, but v / radius would shear the pattern wherever a branch tapers. So it is
// drawn for the two neighbouring powers of two of the radius, each with its own fixed metres per plate, and faded over.
template <BarkNumber N>
BarkTexel<N> over_octaves(BarkStyle style, const BarkPatternKind& kind, const N& u, const N& v, double radius, double footprint,
                          double open) {
  const double level = std::log2(radius), whole = std::floor(level), weight = smooth(0.35, 0.65, level - whole);
  if (weight <= 0) return at_octave(style, kind, whole, u, v, footprint, open);
  if (weight >= 1) return at_octave(style, kind, whole + 1, u, v, footprint, open);
  return mixed_texels(at_octave(style, kind, whole, u, v, footprint, open), at_octave(style, kind, whole + 1, u, v, footprint, open),
                      weight);
}

template <BarkNumber N>
BarkTexel<N> young_skin(const BarkPatternKind& kind, const N& u, const N& v, double radius, double footprint) {
  BarkTexel<N> texel = over_octaves(BarkStyle::kSmooth, kind, u, v, radius, footprint, 1);
  texel.young = 1;
  return texel;
}

}  // namespace

template <BarkNumber N>
BarkTexel<N> bark_pattern(const BarkPatternKind& kind, const N& u, const N& v, double radius, double footprint) {
  if (!(radius > 0) || !std::isfinite(value_of(u)) || !std::isfinite(value_of(v))) return {};
  BarkPatternKind bounded = kind;
  bounded.scale = std::clamp(kind.scale, 0.05, 50.0);
  const double girth = std::clamp(radius, 1e-6, 1e6);
  const N around = clamped(u, -1e6, 1e6), along = clamped(v, -1e8, 1e8);
  if (kind.style == BarkStyle::kSmooth || !(kind.mature_radius > 0))
    return over_octaves(kind.style, bounded, around, along, girth, footprint, 1);
  // The same stem is smooth at its top and fissured at its base; cracks open as it thickens.
  const double age = smooth(0.33, 1.0, girth / kind.mature_radius);
  if (age <= 0) return young_skin(bounded, around, along, girth, footprint);
  const BarkTexel<N> old = over_octaves(kind.style, bounded, around, along, girth, footprint, 0.25 + 0.75 * age);
  if (age >= 1) return old;
  return mixed_texels(young_skin(bounded, around, along, girth, footprint), old, age);
}

template BarkTexel<double> bark_pattern(const BarkPatternKind&, const double&, const double&, double, double);
template BarkTexel<Sloped> bark_pattern(const BarkPatternKind&, const Sloped&, const Sloped&, double, double);

}  // namespace cambium
