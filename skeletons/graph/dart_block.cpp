#include "skeletons/graph/dart_block.h"

#include "blobtree/place_hash.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr int kCells = DartLattice::kCells, kReach = DartLattice::kReach, kGroups = DartLattice::kGroups;
constexpr unsigned kRowMask = (1u << kGroups) - 1;
constexpr int kStep = 197;             // odd: cells of a cube are gone through in a scattered order
constexpr int kDarts = 4;              // at a whole cell
constexpr int kDartsAtHalf = 1;        // at each of its eighths, and theirs

/// Three numbers in (0, 1) from one draw, in steps of 2^-21.
Vec3 unit_place(std::uint64_t bits) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  const auto unit = [](std::uint64_t b) { return (static_cast<double>(b) + 0.5) * 0x1p-21; };
  return {unit(bits & kMask), unit(bits >> 21 & kMask), unit(bits >> 42 & kMask)};
}

/// A bit for each group of a cube and of those beside it, x in the bits, y and z in the rows; the cube's own first group is bit 1 of row 1.
using GroupRows = std::array<std::array<unsigned, kGroups + 2>, kGroups + 2>;

GroupRows rows_of(const std::array<GroupBits, 27>& around) {
  GroupRows rows{};
  for (int z = -1; z <= kGroups; ++z)
    for (int y = -1; y <= kGroups; ++y) {
      const int dz = (z + kGroups) / kGroups, dy = (y + kGroups) / kGroups;   // 0, 1, 2: the cube before, this, the next
      const int shift = ((z + kGroups) % kGroups * kGroups + (y + kGroups) % kGroups) * kGroups;
      const auto row = [&](int dx) { return static_cast<unsigned>(around[std::size_t((dz * 3 + dy) * 3 + dx)] >> shift) & kRowMask; };
      rows[std::size_t(z + 1)][std::size_t(y + 1)] = row(0) >> (kGroups - 1) | row(1) << 1 | (row(2) & 1) << (kGroups + 1);
    }
  return rows;
}

}  // namespace

GroupBits groups_inside(const GraphVolume& volume, const DartLattice& lattice, const std::array<int, 3>& cube) {
  GroupBits groups = 0;
  const Vec3 corner = lattice.corner(cube);
  for (unsigned i = 0; i < 64; ++i) {
    const Vec3 lo = corner + lattice.group_side() * Vec3(i % kGroups, i / kGroups % kGroups, i / (kGroups * kGroups));
    const Vec3 size = glm::min(lo + lattice.group_side(), lattice.hi) - lo;
    if (size.x < 0 || size.y < 0 || size.z < 0) continue;
    if (volume.contains(lo + size * unit_place(mix_bits(i)))) groups |= GroupBits{1} << i;
  }
  return groups;
}

GroupBits group_of(const DartLattice& lattice, const std::array<int, 3>& cube, const Vec3& p) {
  const Vec3 at = glm::clamp(glm::floor((p - lattice.corner(cube)) / lattice.group_side()), 0.0, kGroups - 1.0);
  return GroupBits{1} << static_cast<int>((at.z * kGroups + at.y) * kGroups + at.x);
}

GroupBits grown(const std::array<GroupBits, 27>& around) {
  const GroupRows rows = rows_of(around);
  GroupBits groups = 0;
  for (std::size_t z = 1; z <= kGroups; ++z)
    for (std::size_t y = 1; y <= kGroups; ++y) {
      const unsigned row = rows[z][y];
      const unsigned all = row >> 1 | row | row << 1 | rows[z - 1][y] | rows[z + 1][y] | rows[z][y - 1] | rows[z][y + 1];
      groups |= GroupBits{all >> 1 & kRowMask} << ((z - 1) * kGroups + y - 1) * kGroups;
    }
  return groups;
}

DartLattice::DartLattice(const Box& bounds, double least)
    : lo(bounds.lo), hi(bounds.hi), spacing(least), cell(least / std::numbers::sqrt3 * (1 - 1e-9)) {}

DartBlock::DartBlock(const GraphVolume& volume, const DartLattice& lattice, int halvings)
    : volume_(volume), lattice_(lattice), halvings_(halvings) {}

void DartBlock::open(const std::array<int, 3>& cube) {
  corner_ = lattice_.corner(cube);
  rows_.fill(0);
  near_.clear();
  before_.clear();
}

void DartBlock::put(int x, int y, int z, const Vec3& p) {
  const int row = (z + kReach) * kSide + y + kReach, bit = x + kReach;
  const bool first = !(rows_[row] >> bit & 1);
  rows_[row] |= static_cast<std::uint16_t>(1 << bit);
  before_.push_back(first ? kEnd : head_[row * kSide + bit]);
  head_[row * kSide + bit] = static_cast<std::uint16_t>(near_.size());
  near_.push_back(p);
}

void DartBlock::add(std::span<const Vec3> nodes) {
  const double per_metre = 1 / lattice_.cell;
  const auto beside = [](double c) { return c >= -kReach && c < kCells + kReach; };
  for (const Vec3& p : nodes) {
    const Vec3 at = (p - corner_) * per_metre;
    if (!beside(at.x) || !beside(at.y) || !beside(at.z) || near_.size() == kEnd) continue;
    put(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)), static_cast<int>(std::floor(at.z)), p);
  }
}

bool DartBlock::has_node(int x, int y, int z) const { return rows_[(z + kReach) * kSide + y + kReach] >> (x + kReach) & 1; }

/// A node in the cells around one of the cube's own, of which the test is true; kEnd: there is none.
template <class Test>
std::uint16_t DartBlock::first_near(int x, int y, int z, const Test& test) const {
  static constexpr int kByNearness[2 * kReach + 1] = {0, -1, 1, -2, 2};
  for (const int dz : kByNearness)
    for (const int dy : kByNearness) {
      const int row = (z + kReach + dz) * kSide + y + kReach + dy;
      for (unsigned bits = rows_[row] >> x & 0b11111u; bits != 0; bits &= bits - 1)
        for (std::uint16_t i = head_[row * kSide + x + std::countr_zero(bits)]; i != kEnd; i = before_[i])
          if (test(i)) return i;
    }
  return kEnd;
}

bool DartBlock::too_near(const Vec3& p, std::uint16_t node) const {
  const Vec3 way = p - near_[node];
  return glm::dot(way, way) < lattice_.spacing * lattice_.spacing;
}

std::uint64_t DartBlock::draw() { return mix_bits(seed_ + 0x9e3779b97f4a7c15ull * ++drawn_); }

/// True: a node stuck.
bool DartBlock::throw_at(Place& place, int level, std::vector<Vec3>& nodes) {
  const double side = lattice_.cell / (1 << level);
  const Vec3 lo = corner_ + side * Vec3(place.x, place.y, place.z);
  const Vec3 p = lo + unit_place(draw()) * (glm::min(lo + side, lattice_.hi) - lo);
  const int x = place.x >> level, y = place.y >> level, z = place.z >> level;
  const bool surely_inside = place.darts > place.outside;   // of some of the place; then what is near is the cheaper question
  ++place.darts;
  if (place.blocker != kEnd && too_near(p, place.blocker)) return false;
  if (!surely_inside && !volume_.contains(p)) return ++place.outside, false;
  place.blocker = first_near(x, y, z, [&](std::uint16_t node) { return too_near(p, node); });
  if (place.blocker != kEnd) return false;
  if (surely_inside && !volume_.contains(p)) return ++place.outside, false;
  put(x, y, z, p);
  nodes.push_back(p);
  return true;
}

/// Leaves places that took no node, and of which something may be inside.
void DartBlock::throw_at_all(int level, int darts, int misses, std::vector<Vec3>& nodes) {
  std::vector<Place> done;
  while (!places_.empty()) {
    std::size_t kept = 0;
    for (Place& place : places_) {
      if (has_node(place.x >> level, place.y >> level, place.z >> level)) continue;
      if (throw_at(place, level, nodes)) continue;
      if (place.darts - place.outside >= darts)
        done.push_back(place);
      else if (place.outside < misses)
        places_[kept++] = place;
    }
    places_.resize(kept);
  }
  places_.swap(done);
}

/// Whether a ball around that node holds all of a cube.
bool DartBlock::covers(std::uint16_t node, const Vec3& middle, double half_side) const {
  const Vec3 farthest = glm::abs(middle - near_[node]) + half_side;
  return glm::dot(farthest, farthest) < lattice_.spacing * lattice_.spacing;
}

void DartBlock::halve_all(int level) {
  const double side = lattice_.cell / (1 << (level + 1));
  halves_.clear();
  for (const Place& place : places_) {
    const int x = place.x >> level, y = place.y >> level, z = place.z >> level;
    if (has_node(x, y, z)) continue;
    // What holds all of a half holds the middle of the whole, which is a corner of it.
    const Vec3 middle = corner_ + side * Vec3(2 * place.x + 1, 2 * place.y + 1, 2 * place.z + 1);
    over_middle_.clear();
    first_near(x, y, z, [&](std::uint16_t node) {
      if (too_near(middle, node)) over_middle_.push_back(node);
      return false;
    });
    for (int i = 0; i < 8; ++i) {
      const Vec3 half_middle = middle + 0.5 * side * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      const Vec3 lo = half_middle - 0.5 * side;
      if (lo.x >= lattice_.hi.x || lo.y >= lattice_.hi.y || lo.z >= lattice_.hi.z) continue;
      const auto holds_half = [&](std::uint16_t node) { return covers(node, half_middle, 0.5 * side); };
      if (std::any_of(over_middle_.begin(), over_middle_.end(), holds_half)) continue;
      Place half{.blocker = place.blocker};
      half.x = static_cast<std::int16_t>(2 * place.x + (i & 1));
      half.y = static_cast<std::int16_t>(2 * place.y + (i >> 1 & 1));
      half.z = static_cast<std::int16_t>(2 * place.z + (i >> 2));
      halves_.push_back(half);
    }
  }
  places_.swap(halves_);
}

void DartBlock::find_places(const DartTargets& targets) {
  places_.clear();
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const int c = i * kStep % (kCells * kCells * kCells);
    const int x = c % kCells, y = c / kCells % kCells, z = c / (kCells * kCells);
    const GroupBits group = GroupBits{1} << ((z / 2 * kGroups + y / 2) * kGroups + x / 2);
    if (!((targets.likely | targets.possible) & group) || has_node(x, y, z)) continue;
    const Vec3 lo = corner_ + lattice_.cell * Vec3(x, y, z);
    if (lo.x > lattice_.hi.x || lo.y > lattice_.hi.y || lo.z > lattice_.hi.z) continue;
    Place place{.x = static_cast<std::int16_t>(x), .y = static_cast<std::int16_t>(y), .z = static_cast<std::int16_t>(z)};
    if (!(targets.likely & group)) place.darts = place.outside = 1;   // one miss fewer
    places_.push_back(place);
  }
}

void DartBlock::fill(std::uint64_t seed, const DartTargets& targets, std::vector<Vec3>& nodes) {
  seed_ = seed;
  drawn_ = 0;
  find_places(targets);
  throw_at_all(0, kDarts, targets.misses, nodes);
  for (int level = 1; level <= halvings_; ++level) {
    halve_all(level - 1);
    throw_at_all(level, kDartsAtHalf, std::max(1, targets.misses / 2), nodes);
  }
}

}  // namespace cambium
