#include "skeletons/graph/poisson_disc.h"

#include "blobtree/input_error.h"
#include "blobtree/place_hash.h"
#include "skeletons/graph/dart_block.h"
#include "skeletons/graph/node_chunks.h"
#include "skeletons/graph/volume_probe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

namespace cambium {
namespace {

using Cube = std::array<int, 3>;

constexpr double kMostNodes = 2147483648.0;
constexpr double kMostCubes = 1e9;
constexpr std::size_t kSerialCubes = 64;   // not more: threads would cost more than they save
/// Balls of radius d around nodes d apart hold each place so many times over after one pass: 0.586 nodes to d^3 (0.733 is the most
/// that darts ever reach). Measured: within 2 % from a thousand nodes to a million, in balls, narrow cones and ellipsoids.
constexpr double kCoverage = 2.455;
constexpr double kTooMany = 1.25;          // times as many as wanted: the spacing is chosen anew
constexpr int kPasses = 16;                // with ever smaller spacings
constexpr int kHalvingsForCount = 0, kHalvings = 2;

/// The bits of v with two zeros between each.
std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}
std::uint64_t morton(const Cube& c) {
  return spread_bits(std::uint64_t(c[0])) | spread_bits(std::uint64_t(c[1])) << 1 | spread_bits(std::uint64_t(c[2])) << 2;
}

/// Nodes by cube. Cubes that have none and get none are not kept.
class NodeCubes {
 public:
  NodeCubes(const GraphVolume& volume, const VolumeProbe& probe, const DartLattice& lattice, std::span<const Vec3> there)
      : volume_(volume), probe_(probe), lattice_(lattice) {
    const Vec3 size = lattice.hi - lattice.lo;
    double cubes = 1;
    for (int k = 0; k < 3; ++k) cubes *= size_[k] = static_cast<int>(std::min(size[k] / lattice.cube_side(), kMostCubes)) + 1;
    if (cubes > kMostCubes) throw InputError({}, "spacing = " + std::to_string(lattice.spacing), "a spacing that the volume is not a thousand million of");
    find_cubes();
    for (const Vec3& p : there) at(cube_of(p)).nodes.push_back(p);
    for (Filled& cube : cubes_) cube.there = cube.nodes.size();
  }

  /// False if cancelled.
  bool fill(std::uint64_t seed, int halvings, const RunOptions& run) {
    if (!find_groups(run)) return false;
    for (int phase = 0; phase < 8; ++phase) {
      const std::vector<std::uint32_t> cubes = of_phase(phase);
      const bool finished = in_node_chunks(cubes.size(), grain(), run, [&](std::size_t begin, std::size_t end) {
        DartBlock block(volume_, lattice_, halvings);
        for (std::size_t i = begin; i < end && !run.cancelled(); ++i) fill(cubes_[cubes[i]], block, seed);
      });
      if (!finished) return false;
    }
    return true;
  }

  /// Those that were not there before, neighbours near each other.
  std::vector<Vec3> added() const {
    std::vector<Vec3> nodes;
    std::size_t count = 0;
    for (const Filled& cube : cubes_) count += cube.nodes.size() - cube.there;
    nodes.reserve(count);
    for (const Filled& cube : cubes_) nodes.insert(nodes.end(), cube.nodes.begin() + static_cast<std::ptrdiff_t>(cube.there), cube.nodes.end());
    return nodes;
  }

 private:
  struct Filled {
    Cube at;
    bool is_open;                      // may hold some of the volume
    std::vector<Vec3> nodes;
    std::size_t there = 0;             // of them
    GroupBits groups = 0;              // that hold some of the volume, as far as is known
    int hits = 0;                      // of one look at each of them
  };

  void find_cubes() {
    std::vector<std::pair<std::uint64_t, Cube>> found;
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) {
          const Vec3 corner = lattice_.corner({x, y, z});
          if (probe_.may_hold({corner, corner + lattice_.cube_side()})) found.push_back({morton({x, y, z}), {x, y, z}});
        }
    std::sort(found.begin(), found.end());
    number_.assign(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]), kNone);
    for (const auto& [code, cube] : found) {
      number_[index(cube)] = static_cast<std::uint32_t>(cubes_.size());
      cubes_.push_back({cube, true, {}});
    }
  }

  std::size_t index(const Cube& c) const {
    return (std::size_t(c[2]) * std::size_t(size_[1]) + std::size_t(c[1])) * std::size_t(size_[0]) + std::size_t(c[0]);
  }
  /// What is beyond the cubes counts to the nearest.
  Cube cube_of(const Vec3& p) const {
    Cube cube;
    for (int k = 0; k < 3; ++k)
      cube[k] = static_cast<int>(std::clamp(std::floor((p[k] - lattice_.lo[k]) / lattice_.cube_side()), 0.0, size_[k] - 1.0));
    return cube;
  }
  Filled& at(const Cube& c) {
    std::uint32_t& number = number_[index(c)];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(cubes_.size());
      cubes_.push_back({c, false, {}});
    }
    return cubes_[number];
  }

  std::size_t grain() const { return cubes_.size() <= kSerialCubes ? kSerialCubes : 8; }

  bool find_groups(const RunOptions& run) {
    for (const Vec3& p : probe_.inside()) {
      Filled& cube = at(cube_of(p));
      cube.groups |= group_of(lattice_, cube.at, p);
    }
    return in_node_chunks(cubes_.size(), grain(), run, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!cubes_[i].is_open) continue;
        const GroupBits found = groups_inside(volume_, lattice_, cubes_[i].at);
        cubes_[i].hits = std::popcount(found);
        cubes_[i].groups |= found;
      }
    });
  }

  /// The fewer looks at groups hit the volume, the more darts may miss it.
  static int misses(int hits, GroupBits groups) { return std::clamp(std::popcount(groups) / (4 * hits + 2), 2, 64); }

  /// Of the cube and those around it, x fastest; null where there are none.
  std::array<const Filled*, 27> around(const Cube& c) const {
    std::array<const Filled*, 27> cubes{};
    for (int i = 0; i < 27; ++i) {
      const Cube at{c[0] + i % 3 - 1, c[1] + i / 3 % 3 - 1, c[2] + i / 9 - 1};
      bool is_in = true;
      for (std::size_t k = 0; k < 3; ++k) is_in = is_in && 0 <= at[k] && at[k] < size_[k];
      if (is_in && number_[index(at)] != kNone) cubes[std::size_t(i)] = &cubes_[number_[index(at)]];
    }
    return cubes;
  }

  /// Every second cube along each axis: none of them can see into another.
  std::vector<std::uint32_t> of_phase(int phase) const {
    std::vector<std::uint32_t> cubes;
    for (std::uint32_t i = 0; i < cubes_.size(); ++i) {
      const Cube& c = cubes_[i].at;
      if (cubes_[i].is_open && ((c[0] & 1) | (c[1] & 1) << 1 | (c[2] & 1) << 2) == phase) cubes.push_back(i);
    }
    return cubes;
  }

  void fill(Filled& cube, DartBlock& block, std::uint64_t seed) const {
    const std::array<const Filled*, 27> cubes = around(cube.at);
    std::array<GroupBits, 27> bits{};
    for (std::size_t i = 0; i < 27; ++i)
      if (cubes[i]) bits[i] = cubes[i]->groups;
    const GroupBits groups = grown(bits);
    if (groups == 0) return;
    block.open(cube.at);
    for (const Filled* other : cubes)
      if (other) block.add(other->nodes);
    std::vector<Vec3> found;
    block.fill(hash_of(seed, morton(cube.at)), groups, misses(cube.hits, groups), found);
    cube.nodes.insert(cube.nodes.end(), found.begin(), found.end());
  }

  static constexpr std::uint32_t kNone = 0xffffffff;

  const GraphVolume& volume_;
  const VolumeProbe& probe_;
  const DartLattice& lattice_;
  Cube size_{1, 1, 1};
  std::vector<std::uint32_t> number_;  // of each cube of the bounds, in cubes_
  std::vector<Filled> cubes_;          // those that may hold some of the volume, in Morton's order; then others that have nodes
};

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

/// Takes out as many as are too many, at random.
void thin_out(std::vector<Vec3>& nodes, std::size_t count, std::uint64_t seed) {
  if (nodes.size() <= count) return;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> lots(nodes.size());
  for (std::uint32_t i = 0; i < nodes.size(); ++i) lots[i] = {hash_of(seed, i), i};
  const auto last = lots.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(lots.begin(), last, lots.end());
  std::vector<bool> out(nodes.size());
  for (auto lot = last; lot != lots.end(); ++lot) out[lot->second] = true;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!out[i]) nodes[kept++] = nodes[i];
  nodes.resize(kept);
}

class Strewing {
 public:
  Strewing(const GraphVolume& volume, const VolumeProbe& probe, std::span<const Vec3> given, std::uint64_t seed, const RunOptions& run)
      : volume_(volume), probe_(probe), given_(given), seed_(seed), run_(run) {}

  /// Adds what fits in at a spacing, not larger than the one before. False if cancelled.
  bool add(double spacing, int halvings) {
    const DartLattice lattice(volume_.bounds(), spacing);
    std::vector<Vec3> there(given_.begin(), given_.end());
    there.insert(there.end(), nodes_.begin(), nodes_.end());
    NodeCubes cubes(volume_, probe_, lattice, there);
    if (!cubes.fill(hash_of(seed_, ++passes_), halvings, run_)) return false;
    std::vector<Vec3> added = cubes.added();
    nodes_.insert(nodes_.end(), added.begin(), added.end());
    return true;
  }
  void clear() { nodes_.clear(); }
  std::vector<Vec3>& nodes() { return nodes_; }
  int passes() const { return passes_; }

 private:
  const GraphVolume& volume_;
  const VolumeProbe& probe_;
  std::span<const Vec3> given_;
  std::uint64_t seed_;
  const RunOptions& run_;
  std::vector<Vec3> nodes_;
  int passes_ = 0;
};

/// More nodes than are wanted, to be aimed at lest chance make a second pass needed: three times how far counts stray.
double with_spare(double count) { return 1.01 * count + 0.6 * std::sqrt(count); }

/// Nullopt if cancelled, else the spacing.
std::optional<double> strew_count(Strewing& strewing, const VolumeProbe& probe, std::size_t count) {
  const auto wanted = static_cast<double>(count);
  double spacing = spacing_for(probe, with_spare(wanted));
  for (;;) {
    if (!strewing.add(spacing, kHalvingsForCount)) return std::nullopt;
    const auto found = static_cast<double>(strewing.nodes().size());
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
  const VolumeProbe probe(volume, samples_for(options.spacing ? size.x * size.y * size.z / std::pow(*options.spacing, 3) : double(wanted)));
  if (probe.empty()) return result;
  Strewing strewing(volume, probe, given, options.seed, run);
  if (options.spacing) {
    if (room_for(probe, *options.spacing) > kMostNodes)
      throw InputError({}, "spacing = " + std::to_string(*options.spacing), "a spacing that leaves room for at most 2^31 nodes");
    if (!strewing.add(*options.spacing, kHalvings)) return std::nullopt;
  } else {
    const std::optional<double> spacing = strew_count(strewing, probe, wanted);
    if (!spacing) return std::nullopt;
    result.spacing = *spacing;
  }
  if (options.count) thin_out(strewing.nodes(), wanted, hash_of(options.seed, 0));
  result.positions.insert(result.positions.end(), strewing.nodes().begin(), strewing.nodes().end());
  return result;
}

}  // namespace cambium
