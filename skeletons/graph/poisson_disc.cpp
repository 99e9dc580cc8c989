#include "skeletons/graph/poisson_disc.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "skeletons/graph/node_cubes.h"
#include "skeletons/graph/volume_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace cambium {
namespace {

constexpr double kMostNodes = 2147483648.0;
/// Balls of radius d around nodes d apart hold each place so many times over after one pass: 0.586 nodes to d^3 (0.733 is the most
/// that darts ever reach). Measured: within 5 % from three hundred nodes to a million, in balls, narrow cones and ellipsoids.
constexpr double kCoverage = 2.455;
constexpr double kTooMany = 1.25;          // times as many as wanted: the spacing is chosen anew
constexpr double kMostDrawnFrom = 8;       // nodes, for each that is wanted where more fit in
constexpr int kPasses = 16;                // with ever smaller spacings
constexpr int kHalvingsForCount = 0, kHalvings = 2;

/// How many nodes fit in at a spacing; about.
double room_for(const VolumeProbe& probe, double spacing) {
  const double ball = 4 * std::numbers::pi / 3 * spacing * spacing * spacing;
  return kCoverage * probe.volume() / (ball * probe.share_of_ball(spacing));
}

double spacing_for(const VolumeProbe& probe, double count) {
  double spacing = std::cbrt(kCoverage * probe.volume() / (4 * std::numbers::pi / 3 * count));
  for (int i = 0; i < 3; ++i) spacing *= std::cbrt(room_for(probe, spacing) / count);
  return spacing;
}

class Strewing {
 public:
  Strewing(const GraphVolume& volume, const VolumeProbe& probe, std::span<const Vec3> given, std::uint64_t seed, const RunOptions& run)
      : volume_(volume), probe_(probe), seed_(seed), run_(run), given_(given.size()), nodes_(given.begin(), given.end()) {}

  /// Adds what fits in at a spacing, not larger than the one before. False if cancelled.
  bool add(double spacing, int halvings) {
    const DartLattice lattice(volume_.bounds(), spacing);
    NodeCubes cubes(volume_, probe_, lattice, nodes_, run_);
    if (!cubes.fill(hash_of(seed_, ++passes_), halvings)) return false;
    const std::vector<Vec3> added = cubes.added();
    nodes_.insert(nodes_.end(), added.begin(), added.end());
    return true;
  }
  /// Takes back all that was added.
  void clear() { nodes_.resize(given_); }
  /// Takes back so many as are more than wanted, at random.
  void thin_out(std::size_t wanted);
  std::size_t added() const { return nodes_.size() - given_; }
  int passes() const { return passes_; }
  std::vector<Vec3> take() { return std::move(nodes_); }

 private:
  const GraphVolume& volume_;
  const VolumeProbe& probe_;
  std::uint64_t seed_;
  const RunOptions& run_;
  std::size_t given_;
  std::vector<Vec3> nodes_;            // the given ones first
  int passes_ = 0;
};

void Strewing::thin_out(std::size_t wanted) {
  if (added() <= wanted) return;
  using Lot = std::pair<std::uint64_t, std::uint32_t>;   // (drawn, node)
  std::vector<Lot> lots;
  lots.reserve(added());
  for (auto i = static_cast<std::uint32_t>(given_); i < nodes_.size(); ++i) lots.push_back({hash_of(seed_, i), i});
  const auto first_out = lots.begin() + static_cast<std::ptrdiff_t>(wanted);
  std::nth_element(lots.begin(), first_out, lots.end());
  std::sort(first_out, lots.end(), [](const Lot& a, const Lot& b) { return a.second < b.second; });
  auto out = first_out;
  std::size_t kept = given_;
  for (std::size_t i = given_; i < nodes_.size(); ++i) {
    if (out != lots.end() && out->second == i)
      ++out;
    else
      nodes_[kept++] = nodes_[i];
  }
  nodes_.resize(kept);
}

/// More nodes than are wanted, to be aimed at lest chance make a second pass needed: three times how far counts stray.
double with_spare(double count) { return 1.01 * count + 0.6 * std::sqrt(count); }

/// Nullopt if cancelled, else the spacing.
std::optional<double> strew_count(Strewing& strewing, const VolumeProbe& probe, std::size_t count) {
  const auto wanted = static_cast<double>(count);
  double spacing = spacing_for(probe, with_spare(wanted));
  for (;;) {
    if (!strewing.add(spacing, kHalvingsForCount)) return std::nullopt;
    const auto found = static_cast<double>(strewing.added());
    if (strewing.passes() == kPasses) break;
    if (found >= wanted) {
      if (found <= kTooMany * wanted + 4 || strewing.passes() > 3) break;
      strewing.clear();
      spacing *= std::cbrt(found / with_spare(wanted));
    } else {
      spacing *= std::clamp(0.98 * std::cbrt(found / wanted), 0.5, 0.98);
    }
  }
  return spacing;
}

std::size_t samples_for(double nodes) { return static_cast<std::size_t>(std::clamp(4 * nodes, 1024.0, 131072.0)); }

void validate(const PoissonDiscOptions& options) {
  if (options.count && static_cast<double>(*options.count) > kMostNodes)
    throw InputError({}, "nodes = " + std::to_string(*options.count), "at most 2^31 nodes");
  if (options.spacing && (!(*options.spacing > 0) || !std::isfinite(*options.spacing)))
    throw InputError({}, "spacing = " + std::to_string(*options.spacing), "a finite spacing above 0");
  if (!options.count && !options.spacing) throw InputError({}, "neither a count of nodes nor a spacing", "one of them");
}

}  // namespace

std::optional<PoissonDiscNodes> poisson_disc(const GraphVolume& volume, std::span<const Vec3> given, const PoissonDiscOptions& options,
                                             const RunOptions& run) {
  validate(options);
  PoissonDiscNodes result{{given.begin(), given.end()}, options.spacing.value_or(glm::length(volume.bounds().size()))};
  if (options.count && *options.count <= given.size()) return result;
  const std::size_t wanted = options.count.value_or(given.size()) - given.size();
  const Vec3 size = volume.bounds().size();
  const VolumeProbe probe(volume, samples_for(options.spacing ? size.x * size.y * size.z / std::pow(*options.spacing, 3) : double(wanted)), run);
  if (run.cancelled()) return std::nullopt;
  if (probe.empty()) return result;
  Strewing strewing(volume, probe, given, options.seed, run);
  if (options.spacing) {
    const double spacing = options.count ? std::max(*options.spacing, spacing_for(probe, kMostDrawnFrom * double(wanted))) : *options.spacing;
    if (room_for(probe, spacing) > kMostNodes)
      throw InputError({}, "spacing = " + std::to_string(spacing), "a spacing that leaves room for at most 2^31 nodes");
    if (!strewing.add(spacing, kHalvings)) return std::nullopt;
  } else {
    const std::optional<double> spacing = strew_count(strewing, probe, wanted);
    if (!spacing) return std::nullopt;
    result.spacing = *spacing;
  }
  if (options.count) strewing.thin_out(wanted);
  result.positions = strewing.take();
  return result;
}

}  // namespace cambium
