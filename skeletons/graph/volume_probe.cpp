#include "skeletons/graph/volume_probe.h"

#include "skeletons/graph/spread_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr std::size_t kFewInside = 128;                       // then a look at eight times as many
constexpr std::size_t kMostSamples = std::size_t{1} << 18;
constexpr std::size_t kTooFewInside = 16;                     // of the most: what an obstacle left over, too little to grow in
constexpr std::size_t kPollEvery = 1024;                      // samples
constexpr std::size_t kLeastOfSolid = 64;                     // samples
constexpr std::size_t kBallSamples = 512;
constexpr double kSamplesInCell = 4;                          // on average, of cells with any

double volume_of(const Box& box) {
  const Vec3 size = box.size();
  return size.x * size.y * size.z;
}

/// The digits of i behind the point, turned round: places of [0, 1) that fill it evenly (van der Corput 1935).
double turned_round(std::size_t i, std::size_t base) {
  double place = 0, step = 1;
  for (; i > 0; i /= base) place += static_cast<double>(i % base) * (step /= static_cast<double>(base));
  return place;
}

/// In the unit ball, evenly (Halton 1960); not by the sequence that spreads places over the volume, or the two would go together.
Vec3 place_in_ball(std::size_t i) {
  const Vec3 u{turned_round(i + 1, 2), turned_round(i + 1, 3), turned_round(i + 1, 5)};
  const double z = 2 * u.x - 1, turn = 2 * std::numbers::pi * u.y, across = std::sqrt(1 - z * z);
  return std::cbrt(u.z) * Vec3{across * std::cos(turn), across * std::sin(turn), z};
}
const std::array<Vec3, kBallSamples>& places_in_ball() {
  static const std::array<Vec3, kBallSamples> places = [] {
    std::array<Vec3, kBallSamples> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = place_in_ball(i);
    return all;
  }();
  return places;
}

}  // namespace

VolumeProbe::VolumeProbe(const GraphVolume& volume, std::size_t samples, const RunOptions& run) : of_(volume) {
  for (;; samples *= 8) {
    samples = std::min(samples, kMostSamples);
    sample(samples, run);
    if (inside_.size() >= kFewInside || samples == kMostSamples || run.cancelled()) break;
  }
  if (inside_.size() < kTooFewInside) inside_.clear(), volume_ = 0;
  if (!empty()) mark_cells();
}

void VolumeProbe::sample(std::size_t samples, const RunOptions& run) {
  const std::vector<SolidFrame>& frames = of_.frames();
  std::vector<Box> boxes;             // of the solids in their own frames
  std::vector<double> sizes;          // cubic metres
  double total = 0;
  for (std::size_t s = 0; s < frames.size(); ++s) {
    boxes.push_back(bounds(of_.solids()[s].solid));
    sizes.push_back(volume_of(boxes[s]) * std::pow(of_.solids()[s].scale, 3));
    total += sizes[s];
  }
  // Where solids overlap, the first has the place.
  const auto first_with = [&](const Vec3& p) {
    return static_cast<std::size_t>(std::find_if(frames.begin(), frames.end(), [&](const SolidFrame& f) { return f.contains(p); }) - frames.begin());
  };
  inside_.clear();
  volume_ = 0;
  for (std::size_t s = 0; s < frames.size(); ++s) {
    const auto count = std::max(kLeastOfSolid, static_cast<std::size_t>(static_cast<double>(samples) * sizes[s] / total));
    const std::size_t before = inside_.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (i % kPollEvery == 0 && run.cancelled()) return;
      const Vec3 p = frames[s].placed(boxes[s].lo + boxes[s].size() * spread_place(i));
      if (first_with(p) == s && of_.contains(p)) inside_.push_back(p);
    }
    volume_ += sizes[s] * static_cast<double>(inside_.size() - before) / static_cast<double>(count);
  }
}

void VolumeProbe::mark_cells() {
  const Vec3 size = of_.bounds().size();
  side_ = std::cbrt(kSamplesInCell * volume_ / static_cast<double>(inside_.size()));
  side_ = std::max(side_, std::cbrt(volume_of(of_.bounds()) / double(1 << 21)));
  for (;; side_ *= 1.25) {
    for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(size[k] / side_) + 1;
    marked_.assign(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]), 0);
    for (const Vec3& p : inside_) {
      const auto [x, y, z] = cell_of(p);
      marked_[index(x, y, z)] = 1;
    }
    const auto marked = static_cast<double>(std::count(marked_.begin(), marked_.end(), 1));
    if (inside_.size() < kFewInside || marked * kSamplesInCell <= static_cast<double>(inside_.size()) || marked_.size() == 1) break;
  }
}

VolumeProbe::Cell VolumeProbe::cell_of(const Vec3& p) const {
  Cell cell;
  for (int k = 0; k < 3; ++k) cell[k] = std::clamp(static_cast<int>(std::floor((p[k] - of_.bounds().lo[k]) / side_)), 0, size_[k] - 1);
  return cell;
}

double VolumeProbe::share_of_ball(double radius) const {
  const std::size_t count = std::min(kBallSamples, inside_.size());
  const auto& places = places_in_ball();
  std::size_t inside = 1;
  for (std::size_t i = 0; i < count; ++i) inside += of_.contains(inside_[i * inside_.size() / count] + radius * places[i]);
  return static_cast<double>(inside) / static_cast<double>(count + 1);
}

bool VolumeProbe::may_hold(const Box& box) const {
  const Cell from = cell_of(box.lo - side_), to = cell_of(box.hi + side_);
  for (int z = from[2]; z <= to[2]; ++z)
    for (int y = from[1]; y <= to[1]; ++y)
      for (int x = from[0]; x <= to[0]; ++x)
        if (marked_[index(x, y, z)]) return true;
  return false;
}

}  // namespace cambium
