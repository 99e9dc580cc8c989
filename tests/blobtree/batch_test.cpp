// Float batches where float is weak: thin twigs far from the origin, wide trees.
#include "blobtree/field.h"
#include "conformance_cases.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

// Compares n random points of a box; gradients to 1e-4 of 1/(thinnest radius), their natural size.
void expect_batches_agree(const Field& field, const Box& box, std::uint64_t seed, int& telling) {
  Evaluator evaluator;
  const PrunedField pruned = field.prune(box);
  if (pruned.empty()) return;
  Draws draws(seed);
  constexpr std::size_t n = 100;
  std::vector<float> x, y, z, f(n), gx(n), gy(n), gz(n);
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 p = draws.point(box);
    for (int tries = 0; tries < 20 && field.value(p) == 0; ++tries) p = draws.point(box);
    p -= pruned.origin();
    x.push_back(static_cast<float>(p.x)), y.push_back(static_cast<float>(p.y)), z.push_back(static_cast<float>(p.z));
  }
  evaluator.samples(pruned, x, y, z, f, gx, gy, gz);
  int off_crease = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Sample exact = evaluator.sample(pruned, pruned.origin() + Vec3(x[i], y[i], z[i]));
    ASSERT_NEAR(f[i], exact.value, 1e-4);
    off_crease += glm::length(Vec3(gx[i], gy[i], gz[i]) - exact.gradient) * pruned.smallest_radius() < 1e-3;
    telling += exact.value > 0.1 && exact.value < 0.9;
  }
  EXPECT_GE(off_crease, 98);
}

// A crown's worth of 1 mm twigs, forked, about 30 m from the origin.
Field twigs(const Vec3& place) {
  BlobTreeBuilder b;
  Draws draws(7);
  std::vector<NodeId> parts;
  for (int i = 0; i < 30; ++i) {
    Vec3 p = place + draws.point({Vec3(-0.05), Vec3(0.05)});
    Chain axis;
    for (int k = 0; k < 12; ++k, p += 0.01 * glm::normalize(draws.direction() + Vec3(0, 0, 1))) axis.nodes.push_back({p, 0.001});
    Chain side{{{axis.nodes[6].position, 0.001}, {axis.nodes[6].position + 0.03 * draws.direction(), 0.0008}}, 1};
    const Vec3 point = axis.nodes[6].position, m = glm::normalize(Vec3(0.2, 0.1, 1));
    parts.push_back(b.add(Fork{b.add(axis), {{b.add(side), point, m, 0.0006, 0.004}}, 0.5, 0}));
  }
  return Field(b.build(b.add(Contact{parts, 0.5, 0})));
}

TEST(Batch, MillimetreTwigsThirtyMetresUpLoseNothing) {
  const Vec3 place(10, 8, 27);
  const Field field = twigs(place);
  int telling = 0;
  for (const double half : {0.002, 0.02, 0.1})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const Vec3 center = place + Draws(seed).point({Vec3(-0.05), Vec3(0.05)});
      expect_batches_agree(field, {center - half, center + half}, seed, telling);
    }
  EXPECT_GT(telling, 300);
}

TEST(Batch, TrunksAHundredMetresWideAgree) {
  BlobTreeBuilder b;
  Chain chain;
  for (int i = 0; i <= 100; ++i) chain.nodes.push_back({{i - 50.0, 3 * std::sin(0.3 * i), 0.2 * i}, 0.5});
  const NodeId trunk = b.add(chain);
  const NodeId limb = b.add(Cone{{20, 0, 10}, {25, 40, 30}, 0.6, 0.3, 1});
  const Field field(b.build(b.add(Sum{{trunk, limb}})));
  int telling = 0;
  for (const double half : {0.2, 2.0, 60.0})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const Vec3 center = half > 50 ? Vec3(0, 0, 10) : chain.nodes[seed * 10].position;
      expect_batches_agree(field, {center - half, center + half}, seed, telling);
    }
  EXPECT_GT(telling, 300);
}

// The hardest that field.md promises: both at once, in one box.
TEST(Batch, MillimetreTwigsAgreeInABoxAHundredMetresWide) {
  BlobTreeBuilder b;
  Draws draws(9);
  Chain chain;
  for (int i = 0; i < 8; ++i) chain.nodes.push_back({{49 + 0.01 * i, 30, 40 + 0.003 * i * i}, 0.001});
  const NodeId twig = b.add(chain), capsule = b.add(Capsule{{-48, 2, 3}, {-48.1, 2, 3}, 0.001, 1});
  const Field field(b.build(b.add(Sum{{twig, capsule}})));
  Evaluator evaluator;
  const PrunedField pruned = field.prune({Vec3(-50), Vec3(50)});
  int telling = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 on = i % 2 == 0 ? chain.nodes[static_cast<std::size_t>(draws.below(8))].position : Vec3(-48.05, 2, 3);
    const Vec3 p = on + draws.point({Vec3(-0.002), Vec3(0.002)}) - pruned.origin();
    const float x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
    float f = 0;
    evaluator.values(pruned, {&x, 1}, {&y, 1}, {&z, 1}, {&f, 1});
    const double exact = evaluator.value(pruned, pruned.origin() + Vec3(x, y, z));
    ASSERT_NEAR(f, exact, 1e-4);
    telling += exact > 0.1 && exact < 0.9;
  }
  EXPECT_GT(telling, 500);
}

TEST(Batch, OfNoPointsDoesNothing) {
  BlobTreeBuilder b;
  const NodeId id = b.add(Sphere{{0, 0, 0}, 1, 1});
  const Field field(b.build(id));
  Evaluator().values(field.prune({Vec3(-1), Vec3(1)}), {}, {}, {}, {});
  std::vector<float> x{0}, f{7};
  Evaluator().values(field.prune({Vec3(9), Vec3(10)}), x, x, x, f);  // an empty field writes zeros
  EXPECT_EQ(f[0], 0);
}

}  // namespace
}  // namespace cambium
