// The promise that all speed rests on: a pruned field is the whole field in its box, to the last bit in double, whatever the tree
// and whatever the box; and it costs what is active in the box, whatever the tree around it.
//
// 11,250 trees in all. Under sanitizers (told by the compiler's macros) every eighth of them.
#include "blobtree/field.h"
#include "random_blobtrees.h"
#include "reference_field.h"
#include "strained_blobtrees.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace cambium {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CAMBIUM_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define CAMBIUM_SANITIZED 1
#endif
#endif
#ifdef CAMBIUM_SANITIZED
constexpr std::uint64_t kStep = 8;
#else
constexpr std::uint64_t kStep = 1;
#endif
constexpr std::uint64_t kTreesPerStrain = 1250;
constexpr int kProbes = 32, kBoxes = 12, kPointsPerBox = 6;

struct Probe {
  Vec3 p;
  Sample exact;  ///< of the whole field
};

/// Up to three representable steps aside, on every axis.
Vec3 nudged(Vec3 p, Draws& draws) {
  for (int k = 0; k < 3; ++k)
    for (int steps = draws.below(7) - 3; steps != 0; steps += steps < 0 ? 1 : -1)
      p[k] = std::nextafter(p[k], steps < 0 ? -kInfinity : kInfinity);
  return p;
}

/// Where the field is likely not 0, or just about to be: marks of the tree, inside, on and beside the supports of its atoms.
Vec3 telling_point(const Field& field, const StrainedBlobTree& strained, Draws& draws) {
  if (!strained.marks.empty() && draws.chance(0.3)) {
    const Vec3 mark = strained.marks[draws.next() % strained.marks.size()];
    return draws.chance(0.5) ? mark : nudged(mark, draws);
  }
  const Box support = field.atom_bounds(static_cast<std::uint32_t>(draws.next() % field.atom_count()));
  if (!support.bounded()) return draws.point(field.bounds().empty() ? Box{Vec3(-1), Vec3(1)} : field.bounds());
  Vec3 p = draws.point(support);
  switch (draws.below(6)) {
    case 0: return support.center() + 0.3 * (p - support.center());
    case 1: {
      const int axis = draws.below(3);
      p[axis] = draws.chance(0.5) ? support.lo[axis] : support.hi[axis];
      return draws.chance(0.5) ? p : nudged(p, draws);
    }
    case 2: {  // the middle of a face: there the support of a ball, a capsule or a box ends, within its bounds' slack
      const int axis = draws.below(3);
      p = support.center();
      p[axis] = draws.chance(0.5) ? support.lo[axis] : support.hi[axis];
      return support.center() + (p - support.center()) * (1 - draws.in(0, 4e-9));
    }
    default: return p;
  }
}

/// Around a point: of any size and shape down to a plane, a line and the point itself; or one that touches an atom's support.
Box telling_box(const Field& field, const Vec3& p, Draws& draws) {
  const double largest = field.bounds().empty() ? 1 : glm::length(field.bounds().size());
  const Vec3 sides = draws.point({Vec3(0), Vec3(1)}) * (largest * std::pow(10.0, -draws.in(0, 4)));
  const Vec3 before = draws.point({Vec3(0), Vec3(1)});
  Box box{p - sides * before, p + sides * (1.0 - before)};
  switch (draws.below(10)) {
    case 0: return {p, p};
    case 1: {
      const int axis = draws.below(3);
      box.lo[axis] = box.hi[axis] = p[axis];
      return box;
    }
    case 2: {
      const int axis = draws.below(3);
      box.lo = box.hi = p;
      box.hi[axis] += sides[axis];
      return box;
    }
    case 3: {
      const Box support = field.atom_bounds(static_cast<std::uint32_t>(draws.next() % field.atom_count()));
      if (!support.bounded()) return box;
      box = support;
      const int axis = draws.below(3);
      box.lo[axis] = support.hi[axis];
      box.hi[axis] += sides[axis];
      return box;
    }
    case 4: {  // begins at the point
      box.lo = p;
      return box;
    }
    default: return box;
  }
}

Box part_of(const Box& box, Draws& draws) {
  const Vec3 a = draws.point(box), b = draws.point(box);
  return {glm::min(a, b), glm::max(a, b)};
}

/// How much the checks had to bite on.
struct Tally {
  std::size_t checked = 0, nonzero = 0, reduced = 0;
};

void expect_whole(Evaluator& evaluator, const PrunedField& pruned, const std::vector<Probe>& probes, std::size_t all_atoms,
                  Tally& tally) {
  const Interval range = pruned.box().bounded() ? evaluator.interval(pruned, pruned.box()) : Interval{-kInfinity, kInfinity};
  for (const Probe& probe : probes) {
    if (!pruned.box().contains(probe.p)) continue;
    const Sample sample = evaluator.sample(pruned, probe.p);
    const Vec3 &p = probe.p, &lo = pruned.box().lo, &hi = pruned.box().hi;
    const auto place = [&] {
      std::ostringstream out;
      out.precision(17);
      out << "at (" << p.x << ", " << p.y << ", " << p.z << ") in (" << lo.x << ", " << lo.y << ", " << lo.z << ") to (" << hi.x
          << ", " << hi.y << ", " << hi.z << ")";
      return out.str();
    };
    ASSERT_EQ(evaluator.value(pruned, p), probe.exact.value) << place();
    ASSERT_EQ(sample.value, probe.exact.value) << place();
    // A value that rounds to exactly 0 beside a skeleton (1 - f) ties with a child that is 0; either's gradient is the field's.
    const double slack = probe.exact.value == 0 ? 1e-10 : 1e-12 * (1 + glm::length(probe.exact.gradient));
    ASSERT_LE(glm::length(sample.gradient - probe.exact.gradient), slack) << place();
    ASSERT_TRUE(!pruned.empty() || probe.exact.value == 0) << place();
    ASSERT_TRUE(range.contains(probe.exact.value)) << place();
    ++tally.checked;
    tally.nonzero += probe.exact.value != 0;
    tally.reduced += pruned.atom_count() < all_atoms;
  }
}

class PruningProperty : public testing::TestWithParam<std::size_t> {};

TEST_P(PruningProperty, PrunedIsTheWholeToTheLastBit) {
  Evaluator evaluator;
  Tally tally;
  for (std::uint64_t seed = 0; seed < kTreesPerStrain; seed += kStep) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const StrainedBlobTree strained = strained_blobtree(GetParam(), seed);
    const Field field(strained.tree);
    const PrunedField whole = field.whole();
    const std::size_t atoms = field.atom_count();
    Draws draws(1000 + seed);
    std::vector<Probe> probes;
    for (int i = 0; i < kProbes; ++i) {
      Vec3 p = telling_point(field, strained, draws);
      for (int tries = i % 8; tries > 0 && evaluator.value(whole, p) == 0; --tries) p = telling_point(field, strained, draws);
      probes.push_back({p, evaluator.sample(whole, p)});
      const Sample& exact = probes.back().exact;
      ASSERT_TRUE(std::isfinite(exact.value) && std::isfinite(glm::length(exact.gradient)));
      ASSERT_EQ(evaluator.value(whole, p), exact.value);
      ASSERT_EQ(field.value(p), exact.value);
      ASSERT_EQ(field.sample(p).value, exact.value);
      if (seed % 8 == 0) {
        ASSERT_NEAR(exact.value, reference::value(strained.tree, p), 1e-9);
      }
    }
    for (const Box& box : {field.bounds(), Box{Vec3(-kInfinity), Vec3(kInfinity)}}) {
      ASSERT_NO_FATAL_FAILURE(expect_whole(evaluator, field.prune(box), probes, atoms, tally));
    }
    for (int i = 0; i < kBoxes; ++i) {
      const Box box = telling_box(field, probes[static_cast<std::size_t>(draws.below(kProbes))].p, draws);
      const Box inner = part_of(box, draws), innermost = part_of(inner, draws);
      const ActiveSet in_box = field.active(box), in_inner = field.narrow(in_box, inner);
      const std::array<PrunedField, 5> fields{field.prune(box), field.prune(in_box, box), field.prune(in_inner, inner),
                                              field.prune(field.narrow(in_inner, innermost), innermost),
                                              field.prune(in_box, inner)};  // more than are active is no harm
      ASSERT_GE(fields[0].atom_count(), fields[2].atom_count());
      ASSERT_GE(fields[2].atom_count(), fields[3].atom_count());
      // Points of these boxes too, rather where there is something: few probes lie in the small ones.
      std::vector<Probe> here = probes;
      for (int k = 0; k < 3 * kPointsPerBox; ++k) {
        const PrunedField& chosen = fields[std::array{0, 2, 3}[static_cast<std::size_t>(k % 3)]];
        Vec3 p = draws.point(chosen.box());
        for (int tries = k % 6; tries > 0 && evaluator.value(chosen, p) == 0; --tries) p = draws.point(chosen.box());
        here.push_back({p, evaluator.sample(whole, p)});
      }
      for (const PrunedField& pruned : fields) {
        ASSERT_NO_FATAL_FAILURE(expect_whole(evaluator, pruned, here, atoms, tally));
      }
    }
  }
  EXPECT_GT(tally.checked, 40 * kTreesPerStrain / kStep);
  EXPECT_GT(tally.nonzero, tally.checked / 4);
  EXPECT_GT(tally.reduced, tally.checked / 4);
}

INSTANTIATE_TEST_SUITE_P(Strains, PruningProperty, testing::Range<std::size_t>(0, kFlaredStrain + 1), [](const auto& strain) {
  return strain.param == kFlaredStrain ? "Flared" : strains()[strain.param];
});

TEST(PruningStrains, HoldEveryNode) {
  std::set<std::size_t> seen;
  for (std::size_t strain = 0; strain <= kFlaredStrain; ++strain) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      const BlobTree tree = strained_blobtree(strain, seed).tree;
      for (NodeId id = 0; id < tree.size(); ++id) seen.insert(tree.node(id).index());
    }
  }
  EXPECT_EQ(seen.size(), std::variant_size_v<Node>);
}

// ---- cost: counted, not timed -------------------------------------------------------------------------------------

constexpr int kSegments = 100000;
constexpr double kStep_m = 0.05, kThickness = 0.02;

Vec3 joint(int i) { return {0.02 * (i % 2), 0.01 * (i % 3), kStep_m * i}; }
NodeId internode(BlobTreeBuilder& b, int i) { return b.add(Capsule{joint(i), joint(i + 1), kThickness, 1}); }

/// Each internode bears all that follow, as the galbraith profile makes an axis.
Field one_sided_axis(int segments) {
  BlobTreeBuilder b;
  NodeId top = internode(b, segments - 1);
  for (int i = segments - 1; i-- > 0;) top = b.add(Sum{{internode(b, i), b.add(Contact{{top}, 0.5, 0})}});
  return Field(b.build(top));
}

/// The same internodes under sums of two of equal size.
Field balanced(int segments) {
  BlobTreeBuilder b;
  std::vector<NodeId> level;
  for (int i = 0; i < segments; ++i) level.push_back(internode(b, i));
  while (level.size() > 1) {
    std::vector<NodeId> above;
    for (std::size_t i = 0; i + 1 < level.size(); i += 2) above.push_back(b.add(Sum{{level[i], level[i + 1]}}));
    if (level.size() % 2 != 0) above.push_back(level.back());
    level = std::move(above);
  }
  return Field(b.build(level[0]));
}

TEST(PruningCost, IsThatOfTheBoxAndNotOfTheDepth) {
  const Field deep = one_sided_axis(kSegments), flat = balanced(kSegments), small = one_sided_axis(100);
  ASSERT_EQ(deep.atom_count(), flat.atom_count());
  Evaluator evaluator;
  Draws draws(5);
  for (int i = 0; i < 300; ++i) {
    const int middle = 20 + 6 * draws.below(kSegments / 6 - 20);  // the axis repeats itself every six joints
    const Vec3 half = draws.point({Vec3(0.01), Vec3(0.15)});
    const Vec3 shift(0, 0, joint(middle).z - joint(50).z);
    const Box box{joint(middle) - half, joint(middle) + half};
    const PrunedField in_deep = deep.prune(box), in_flat = flat.prune(box), in_small = small.prune({box.lo - shift, box.hi - shift});
    ASSERT_GT(in_deep.atom_count(), 0u);
    ASSERT_LE(in_deep.atom_count(), 2 * (0.15 + kSupportPerRadius * kThickness) / kStep_m + 2);
    ASSERT_EQ(in_deep.atom_count(), in_flat.atom_count());
    // Bounds are kept as floats: kilometres up they may let in, at each end, one that only just touches the box.
    ASSERT_LE(in_deep.atom_count() - in_small.atom_count(), 2u);
    // One sum of two per active internode but the last, whether they hang on each other or are paired.
    ASSERT_EQ(in_deep.memory_bytes(), in_flat.memory_bytes());
    ASSERT_LE(in_deep.memory_bytes() - in_small.memory_bytes(), 128u);
    for (int k = 0; k < 5; ++k) {
      const Vec3 p = draws.point(box);
      ASSERT_NEAR(evaluator.value(in_deep, p), evaluator.value(in_flat, p), 1e-12);
      ASSERT_NEAR(evaluator.value(in_deep, p), evaluator.value(in_small, p - shift), 1e-9);
    }
  }
}

// Every internode's subtree is cut once more: away from the cuts none of them is left, however many are above.
TEST(PruningCost, CutsThatTakeNothingAwayHereCostNothing) {
  constexpr int kCuts = 2000;
  BlobTreeBuilder b;
  NodeId top = internode(b, kCuts);
  for (int i = kCuts; i-- > 0;) {
    const NodeId knife = b.add(Sphere{joint(i) + Vec3(0.5 * kThickness, 0, 0), 0.2 * kThickness, 1});
    top = b.add(Difference{{b.add(Sum{{internode(b, i), top}}), knife}});
  }
  const Field field(b.build(top));
  Evaluator evaluator;
  const PrunedField whole = field.whole();
  std::size_t most = 0;
  for (const int i : {10, 500, 1990}) {
    const Vec3 center = joint(i) - Vec3(0.9 * kThickness, 0, 0);
    const PrunedField pruned = field.prune({center - 0.05 * kThickness, center + 0.05 * kThickness});
    const Vec3 p = pruned.box().center();
    EXPECT_GT(pruned.atom_count(), 0u);
    EXPECT_EQ(evaluator.value(pruned, p), evaluator.value(whole, p));
    most = std::max(most, pruned.memory_bytes());
  }
  EXPECT_LT(most, 1000u);   // of 2,000 instructions of 16 bytes
}

}  // namespace
}  // namespace cambium
