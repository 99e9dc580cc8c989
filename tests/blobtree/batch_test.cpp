// Float batches where float is weak: thin twigs far from the origin, wide trees. And whatever the vector instructions, the
// number of points and what the evaluator did before: the same bits.
#include "blobtree/batch_kernels.h"
#include "blobtree/field.h"
#include "conformance_cases.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <bit>
#include <optional>

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

/// While it lives, only one of Highway's sets of vector instructions is used.
class OnlyVectorTarget {
 public:
  explicit OnlyVectorTarget(std::int64_t target) { use(target); }
  ~OnlyVectorTarget() { use(0); }   // as detected

 private:
  static void use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

std::vector<std::int64_t> vector_targets() {
  std::vector<std::int64_t> targets;
  const std::int64_t here = hwy::SupportedTargets() & compiled_vector_targets();
  for (int bit = 0; bit < 63; ++bit)
    if (here >> bit & 1) targets.push_back(std::int64_t{1} << bit);
  return targets;   // the best first, plain C++ last
}

/// Points in a box and what a batch says of them. Arrays begin `shift` floats into their memory, so that they are not
/// aligned.
struct PointBatch {
  PointBatch(const PrunedField& field, Draws& draws, std::size_t n, std::size_t shift) : n_(n), shift_(shift) {
    for (std::vector<float>* v : {&x, &y, &z, &f, &gx, &gy, &gz}) v->resize(n + shift, -7.0f);
    for (std::size_t i = shift; i < n + shift; ++i) {
      const Vec3 p = draws.point(field.box()) - field.origin();
      x[i] = static_cast<float>(p.x), y[i] = static_cast<float>(p.y), z[i] = static_cast<float>(p.z);
    }
  }
  void values(Evaluator& evaluator, const PrunedField& field) { evaluator.values(field, of(x), of(y), of(z), of(f)); }
  void samples(Evaluator& evaluator, const PrunedField& field) {
    evaluator.samples(field, of(x), of(y), of(z), of(f), of(gx), of(gy), of(gz));
  }
  std::span<float> of(std::vector<float>& v) { return {v.data() + shift_, n_}; }

  std::vector<float> x, y, z, f, gx, gy, gz;

 private:
  std::size_t n_, shift_;
};

void expect_same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i]), std::bit_cast<std::uint32_t>(b[i])) << i;
}

TEST(Batch, EverySetOfVectorInstructionsGivesTheSameBits) {
  const std::vector<std::int64_t> targets = vector_targets();
  ASSERT_FALSE(targets.empty());
  constexpr std::size_t kSizes[] = {1, 3, 15, 16, 17, 100, 729, 1600};
  std::size_t turn = 0, nonzero = 0, total = 0;
  for (const ConformanceCase& c : conformance_cases()) {
    SCOPED_TRACE(c.name);
    const Field field(c.tree);
    Draws draws(++turn);
    const Box around = field.bounds().empty() ? Box{Vec3(-1), Vec3(1)} : field.bounds();
    for (int k = 0; k < 4; ++k) {
      const PrunedField pruned = field.prune(k == 0 ? around : draws.box(around));
      const std::size_t n = kSizes[(turn + static_cast<std::size_t>(k)) % std::size(kSizes)];
      const PointBatch points(pruned, draws, n, turn % 4);
      std::optional<PointBatch> expected_values, expected_samples;
      for (const std::int64_t target : targets) {
        SCOPED_TRACE(hwy::TargetName(target));
        const OnlyVectorTarget only(target);
        ASSERT_EQ(running_vector_target(), target);
        PointBatch values = points, samples = points;
        Evaluator evaluator;
        values.values(evaluator, pruned);
        samples.samples(evaluator, pruned);
        if (!expected_values) {
          for (const float f : values.of(values.f)) {
            ASSERT_TRUE(std::isfinite(f));
            nonzero += f != 0;
            ++total;
          }
          expected_values = values;
          expected_samples = samples;
          continue;
        }
        expect_same_bits(expected_values->f, values.f);
        expect_same_bits(expected_samples->f, samples.f);
        expect_same_bits(expected_samples->gx, samples.gx);
        expect_same_bits(expected_samples->gy, samples.gy);
        expect_same_bits(expected_samples->gz, samples.gz);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(nonzero, total / 10);
}

TEST(Batch, PointsDoNotKnowTheirNeighbours) {
  int turn = 0;
  for (const ConformanceCase& c : conformance_cases()) {
    SCOPED_TRACE(c.name);
    const Field field(c.tree);
    Draws draws(static_cast<std::uint64_t>(++turn));
    const Box around = field.bounds().empty() ? Box{Vec3(-1), Vec3(1)} : field.bounds();
    const PrunedField pruned = field.prune(draws.box(around));
    PointBatch all(pruned, draws, 200, 0);
    Evaluator evaluator;
    all.samples(evaluator, pruned);
    for (const std::size_t n : {1, 3, 15, 17, 50}) {
      const std::size_t from = static_cast<std::size_t>(draws.below(static_cast<int>(200 - n)));
      std::vector<float> f(n + 1, -7.0f), gx = f, gy = f, gz = f;
      const auto part = [&](const std::vector<float>& v) { return std::span<const float>(v).subspan(from, n); };
      evaluator.samples(pruned, part(all.x), part(all.y), part(all.z), {f.data(), n}, {gx.data(), n},
                        {gy.data(), n}, {gz.data(), n});
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(f[i], all.f[from + i]);
        ASSERT_EQ(gx[i], all.gx[from + i]);
        ASSERT_EQ(gy[i], all.gy[from + i]);
        ASSERT_EQ(gz[i], all.gz[from + i]);
      }
      ASSERT_EQ(f[n], -7.0f);   // nothing is written past the end
      ASSERT_EQ(gz[n], -7.0f);
    }
  }
}

// In cells as large as branches are thick, floats keep a millionth.
TEST(Batch, OnePrimitiveInACellAgreesWithPointsToAMillionth) {
  const auto primitives = [](Draws& d) {
    const Vec3 a = 0.03 * d.direction(), u = d.direction();
    Chain chain;
    for (int i = -4; i <= 4; ++i) chain.nodes.push_back({a + 0.06 * i * u + 0.005 * d.direction(), 0.05 - 0.002 * i});
    return std::vector<Node>{Cone{a - 0.4 * u, a + 0.4 * u, 0.08, 0.05, 1}, Sphere{a, 0.05, 1},
                             Capsule{a - u, a + 0.1 * u, 0.05, -1},
                             Disc{a, u, 0.04, 0.05, 1}, Torus{a + 0.2 * d.direction(), u, 0.2, 0.05, 1},
                             RotatedBox{a, {0.02, 0.03, 0.04}, {1, u.x, u.y, u.z}, 0.05, 1}, chain};
  };
  Draws draws(11);
  Evaluator evaluator;
  int telling = 0;
  for (int turn = 0; turn < 20; ++turn)
    for (const Node& node : primitives(draws)) {
      BlobTreeBuilder b;
      const NodeId id = b.add(node);
      const Field field(b.build(id));
      const Vec3 center = 0.08 * draws.direction();
      const PrunedField pruned = field.prune({center - 0.05, center + 0.05});
      PointBatch batch(pruned, draws, 300, 0);
      batch.values(evaluator, pruned);
      for (std::size_t i = 0; i < 300; ++i) {
        const double exact = evaluator.value(pruned, pruned.origin() + Vec3(batch.x[i], batch.y[i], batch.z[i]));
        ASSERT_NEAR(batch.f[i], exact, 1e-6) << "node " << node.index();
        telling += std::abs(exact) > 0.1 && std::abs(exact) < 0.9;
      }
    }
  EXPECT_GT(telling, 10000);
}

// An evaluator keeps what it made of the last field: whatever else has come to stand in its place, it must not be taken for
// it.
TEST(Batch, AnEvaluatorIsNotMisledByTheLastField) {
  Evaluator kept;
  Draws draws(5);
  for (int turn = 0; turn < 200; ++turn) {
    BlobTreeBuilder b;
    const NodeId cone = b.add(Cone{{0, 0, 0}, {0, 0.1 * (turn % 3), 1}, draws.in(0.2, 0.3), 0.2, 1});
    const NodeId id = b.add(ScaleField{draws.in(0.5, 1), cone});
    const Field field(b.build(id));   // most likely where the last one was
    for (int place = 0; place < 3; ++place) {
      const Vec3 center = 0.2 * draws.direction();
      const double half = place == 1 ? 20 : 0.1;   // in double, in float
      const PrunedField pruned = field.prune({center - half, center + half});
      PointBatch batch(pruned, draws, 20, 0), again = batch;
      batch.samples(kept, pruned);
      again.values(kept, pruned);
      PointBatch expected = batch;
      Evaluator fresh;
      expected.samples(fresh, pruned);
      expect_same_bits(batch.f, expected.f);
      expect_same_bits(batch.gz, expected.gz);
      expected.values(fresh, pruned);
      expect_same_bits(again.f, expected.f);
    }
  }
}

TEST(Batch, MayWriteOverItsPoints) {
  BlobTreeBuilder b;
  const NodeId first = b.add(Sphere{{0, 0, 0}, 0.5, 1}), second = b.add(Capsule{{0, 0, 0}, {0, 1, 0}, 0.3, 1});
  const Field field(b.build(b.add(Contact{{first, second}, 0.5, 1})));
  const PrunedField pruned = field.prune(field.bounds());
  Draws draws(3);
  PointBatch apart(pruned, draws, 1000, 1), over = apart;
  Evaluator evaluator;
  apart.samples(evaluator, pruned);
  evaluator.samples(pruned, over.of(over.x), over.of(over.y), over.of(over.z), over.of(over.f), over.of(over.x),
                    over.of(over.y), over.of(over.z));
  expect_same_bits(apart.f, over.f);
  for (std::size_t i = 1; i < 1001; ++i) ASSERT_EQ(apart.gy[i], over.y[i]);
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
