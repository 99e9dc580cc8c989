#include "skeletons/graph/dart_block.h"

#include "blobtree/place_hash.h"

#include <bit>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr int kCells = DartLattice::kCells, kReach = DartLattice::kReach;
constexpr int kStep = 197;             // odd: cells of a cube are gone through in a scattered order
constexpr int kDarts = 3;              // at a whole cell
constexpr int kDartsAtHalf = 1;        // at each of its eighths, and theirs

/// Three numbers in (0, 1) from one draw, in steps of 2^-21.
Vec3 unit_place(std::uint64_t bits) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  const auto unit = [](std::uint64_t b) { return (static_cast<double>(b) + 0.5) * 0x1p-21; };
  return {unit(bits & kMask), unit(bits >> 21 & kMask), unit(bits >> 42 & kMask)};
}

}  // namespace

DartLattice::DartLattice(const Box& bounds, double least)
    : lo(bounds.lo), hi(bounds.hi), spacing(least), cell(least / std::numbers::sqrt3 * (1 - 1e-9)) {}

DartBlock::DartBlock(const GraphVolume& volume, const DartLattice& lattice, int misses, int halvings)
    : volume_(volume), lattice_(lattice), misses_(misses), halvings_(halvings) {}

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

/// Whether visit is true of a node in the cells around one of the cube's own.
template <class Visit>
bool DartBlock::any_near(int x, int y, int z, const Visit& visit) const {
  static constexpr int kByNearness[2 * kReach + 1] = {0, -1, 1, -2, 2};
  for (const int dz : kByNearness)
    for (const int dy : kByNearness) {
      const int row = (z + kReach + dz) * kSide + y + kReach + dy;
      for (unsigned bits = rows_[row] >> x & 0b11111u; bits != 0; bits &= bits - 1)
        for (std::uint16_t i = head_[row * kSide + x + std::countr_zero(bits)]; i != kEnd; i = before_[i])
          if (visit(near_[i])) return true;
    }
  return false;
}

std::uint64_t DartBlock::draw() { return mix_bits(seed_ + 0x9e3779b97f4a7c15ull * ++drawn_); }

/// True: a node stuck.
bool DartBlock::throw_at(Place& place, int level, std::vector<Vec3>& nodes) {
  const double side = lattice_.cell / (1 << level);
  const Vec3 lo = corner_ + side * Vec3(place.x, place.y, place.z);
  const Vec3 p = lo + unit_place(draw()) * (glm::min(lo + side, lattice_.hi) - lo);
  const int x = place.x >> level, y = place.y >> level, z = place.z >> level;
  const double least2 = lattice_.spacing * lattice_.spacing;
  ++place.darts;
  if (any_near(x, y, z, [&](const Vec3& q) { return glm::dot(p - q, p - q) < least2; })) return false;
  if (!volume_.contains(p)) {
    ++place.outside;
    return false;
  }
  put(x, y, z, p);
  nodes.push_back(p);
  return true;
}

/// Leaves places that took no node, and of which something may be inside.
void DartBlock::throw_at_all(int level, int darts, std::vector<Vec3>& nodes) {
  std::vector<Place> done;
  while (!places_.empty()) {
    std::size_t kept = 0;
    for (Place& place : places_) {
      if (has_node(place.x >> level, place.y >> level, place.z >> level)) continue;
      if (throw_at(place, level, nodes)) continue;
      if (place.darts - place.outside >= darts)
        done.push_back(place);
      else if (place.outside < (level == 0 ? misses_ : 1))
        places_[kept++] = place;
    }
    places_.resize(kept);
  }
  places_.swap(done);
}

bool DartBlock::covered(const Vec3& middle, double half_side) const {
  const Vec3 at = (middle - corner_) / lattice_.cell;
  return any_near(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z), [&](const Vec3& q) {
    const Vec3 farthest = glm::abs(middle - q) + half_side;
    return glm::dot(farthest, farthest) < lattice_.spacing * lattice_.spacing;
  });
}

void DartBlock::halve_all(int level) {
  const double side = lattice_.cell / (1 << (level + 1));
  halves_.clear();
  for (const Place& place : places_) {
    if (has_node(place.x >> level, place.y >> level, place.z >> level)) continue;
    for (int i = 0; i < 8; ++i) {
      const Place half{static_cast<std::int16_t>(2 * place.x + (i & 1)), static_cast<std::int16_t>(2 * place.y + (i >> 1 & 1)),
                       static_cast<std::int16_t>(2 * place.z + (i >> 2))};
      const Vec3 lo = corner_ + side * Vec3(half.x, half.y, half.z);
      if (lo.x >= lattice_.hi.x || lo.y >= lattice_.hi.y || lo.z >= lattice_.hi.z) continue;
      if (!covered(lo + 0.5 * side, 0.5 * side)) halves_.push_back(half);
    }
  }
  places_.swap(halves_);
}

void DartBlock::fill(std::uint64_t seed, std::vector<Vec3>& nodes) {
  seed_ = seed;
  drawn_ = 0;
  places_.clear();
  for (int i = 0; i < kCells * kCells * kCells; ++i) {
    const int c = i * kStep % (kCells * kCells * kCells);
    const Place place{static_cast<std::int16_t>(c % kCells), static_cast<std::int16_t>(c / kCells % kCells),
                      static_cast<std::int16_t>(c / (kCells * kCells))};
    const Vec3 lo = corner_ + lattice_.cell * Vec3(place.x, place.y, place.z);
    if (lo.x <= lattice_.hi.x && lo.y <= lattice_.hi.y && lo.z <= lattice_.hi.z) places_.push_back(place);
  }
  throw_at_all(0, kDarts, nodes);
  for (int level = 1; level <= halvings_; ++level) {
    halve_all(level - 1);
    throw_at_all(level, kDartsAtHalf, nodes);
  }
}

}  // namespace cambium
