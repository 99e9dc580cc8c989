#include "blobtree/field.h"
#include "conformance_cases.h"
#include "reference_field.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <queue>

namespace cambium {
namespace {

// Several nodes below one operator, each also as a field by itself.
struct Parts {
  std::vector<Node> nodes;
  Field combined(const std::function<Node(std::vector<NodeId>)>& op) const {
    BlobTreeBuilder b;
    std::vector<NodeId> ids;
    for (const Node& n : nodes) ids.push_back(b.add(n));
    return Field(b.build(b.add(op(ids))));
  }
  std::vector<Field> alone() const {
    std::vector<Field> fields;
    for (const Node& n : nodes) {
      BlobTreeBuilder b;
      const NodeId id = b.add(n);
      fields.emplace_back(b.build(id));
    }
    return fields;
  }
};

Parts three_branches(double lean) {
  Parts parts;
  for (int i = 0; i < 3; ++i) {
    const double a = 2 * std::numbers::pi * i / 3;
    parts.nodes.push_back(Cone{{0.02 * std::cos(a), 0.02 * std::sin(a), 0}, {lean * std::cos(a), lean * std::sin(a), 0.6}, 0.13, 0.1, 1});
  }
  return parts;
}

TEST(Contact, OfTwoOutsideEachOtherIsPairwise) {
  const Parts parts{{Sphere{{-0.15, 0, 0}, 0.2, 1}, Sphere{{0.15, 0, 0}, 0.25, 1}}};
  for (const double lip : {0.0, 4.0}) {
    const Field contact = parts.combined([&](auto ids) { return Contact{ids, 0.4, lip}; });
    const auto alone = parts.alone();
    Draws draws(1);
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = draws.point(contact.bounds());
      const double a = alone[0].value(p), b = alone[1].value(p);
      if (a >= kIso && b >= kIso) continue;
      const double pushed = std::max(a + reference::pushed(b, 0.4, lip), b + reference::pushed(a, 0.4, lip));
      ASSERT_NEAR(contact.value(p), pushed, 1e-12);
      met += a > 0.1 && b > 0.1;
    }
    EXPECT_GT(met, 20);
  }
}

TEST(Contact, BoundsOverASmallBoxAreCloseAroundTheValue) {
  const Parts parts{{Sphere{{-0.15, 0, 0}, 0.2, 1}, Sphere{{0.15, 0, 0}, 0.25, 1}}};
  const Field contact = parts.combined([](auto ids) { return Contact{ids, 0.4, 1.5}; });
  const auto alone = parts.alone();
  Draws draws(4);
  int lifted = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = draws.point(contact.bounds());
    const double f = contact.value(p);
    const Interval bounds = contact.interval({p - 1e-7, p + 1e-7});
    ASSERT_TRUE(bounds.contains(f));
    ASSERT_LT(bounds.hi - bounds.lo, 1e-4);
    lifted += f > std::max(alone[0].value(p), alone[1].value(p)) + 0.01;
  }
  EXPECT_GT(lifted, 20);
}

TEST(Contact, OfOneIsItself) {
  const Parts parts{{Sphere{{0, 0, 0}, 0.2, -0.7}}};
  EXPECT_EQ(parts.combined([](auto ids) { return Contact{ids, 0.5, 1}; }).value({0, 0, 0}), -0.7);
}

TEST(Contact, RaisesARidgeWhereTheTwoMeet) {
  const Parts parts{{Capsule{{-0.12, 0, -1}, {-0.12, 0, 1}, 0.1, 1}, Capsule{{0.12, 0, -1}, {0.12, 0, 1}, 0.1, 1}}};
  const Field contact = parts.combined([](auto ids) { return Contact{ids, 0.5, 0}; });
  const auto alone = parts.alone();
  const Vec3 between(0, 0.02, 0);
  EXPECT_LT(std::max(alone[0].value(between), alone[1].value(between)), kIso);
  EXPECT_GT(contact.value(between), alone[0].value(between) + 0.05);
  // A crease: the slope across it changes sign at once.
  EXPECT_LT(contact.sample({-1e-6, 0.06, 0}).gradient.x * contact.sample({1e-6, 0.06, 0}).gradient.x, -1e-3);
}

// No inner sheet between overlapping branches, and no pocket that the outside cannot reach.
TEST(Contact, ThreeBranchesLeaveNoVoid) {
  for (const double lean : {0.1, 0.2, 0.35}) {
    const Parts parts = three_branches(lean);
    for (const double lip : {0.0, 2.0}) {
      const Field contact = parts.combined([&](auto ids) { return Contact{ids, 0.5, lip}; });
      const auto alone = parts.alone();
      constexpr int n = 44;
      const Box box = contact.bounds().padded(0.02);
      const auto at = [&](int x, int y, int z) { return (z * n + y) * n + x; };
      std::vector<bool> inside(n * n * n), reached(n * n * n);
      for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
          for (int x = 0; x < n; ++x) {
            const Vec3 p = box.lo + box.size() * Vec3(x, y, z) / double(n - 1);
            const double f = contact.value(p);
            double most = 0;
            for (const Field& field : alone) most = std::max(most, field.value(p));
            ASSERT_TRUE(most < kIso || f >= kIso);
            inside[at(x, y, z)] = f >= kIso;
          }
      std::queue<std::array<int, 3>> open;
      open.push({0, 0, 0});
      reached[0] = true;
      while (!open.empty()) {
        const auto [x, y, z] = open.front();
        open.pop();
        for (const auto& [dx, dy, dz] : {std::array{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
          const int X = x + dx, Y = y + dy, Z = z + dz;
          if (X < 0 || Y < 0 || Z < 0 || X >= n || Y >= n || Z >= n || reached[at(X, Y, Z)] || inside[at(X, Y, Z)]) continue;
          reached[at(X, Y, Z)] = true;
          open.push({X, Y, Z});
        }
      }
      int pockets = 0;
      for (std::size_t i = 0; i < inside.size(); ++i) pockets += !inside[i] && !reached[i];
      EXPECT_EQ(pockets, 0) << "lean " << lean << " lip " << lip;
    }
  }
}

TEST(Ricci, RunsFromSumToUnion) {
  const Parts parts{{Sphere{{-0.1, 0, 0}, 0.2, 1}, Sphere{{0.1, 0, 0}, 0.2, 1}}};
  const Vec3 p(0.02, 0.1, 0);
  const auto ricci = [&](double n) { return parts.combined([=](auto ids) { return Ricci{ids, n}; }).value(p); };
  EXPECT_NEAR(ricci(1), parts.combined([](auto ids) { return Sum{ids}; }).value(p), 1e-15);
  EXPECT_NEAR(ricci(1e5), parts.combined([](auto ids) { return Union{ids}; }).value(p), 1e-5);
  EXPECT_NEAR(ricci(1e9), ricci(1e5), 1e-5);
}

// Far side of the axis and crotch, over the range of radii and angles that field.md names.
TEST(Fork, LeavesTheFarSideAloneAndCreasesTheCrotch) {
  // The lateral starts where its support just reaches the far side.
  for (const double ratio : {0.3, 0.5, 0.8, 1.0})
    for (const double degrees : {20.0, 45.0, 80.0}) {
      SCOPED_TRACE(std::to_string(ratio) + " at " + std::to_string(degrees));
      constexpr double R = 0.1;
      const double r = ratio * R, angle = degrees * std::numbers::pi / 180;
      const Vec3 along(std::sin(angle), 0, std::cos(angle));
      const Vec3 start = std::max(0.0, 2.2016634851 * r - R) / std::sin(angle) * along;
      const Vec3 up = glm::normalize(Vec3(0, 0, 1) - along.z * along);
      BlobTreeBuilder b;
      const NodeId axis = b.add(Chain{{{{0, 0, -1}, R}, {{0, 0, 1}, R}}, 1});
      const NodeId lateral = b.add(Chain{{{start, r}, {start + along, r}}, 1});
      const Field field(b.build(b.add(Fork{axis, {{lateral, {0, 0, 0}, up, 0.6 * r, 2 * (R + r)}}, 0.5, 0})));
      for (int i = -50; i <= 50; ++i) {
        const Vec3 p(-1.02 * R, 0, 0.012 * i);
        ASSERT_LT(field.value(p), kIso) << "bulge at height " << p.z;
        ASSERT_GE(field.value({-0.98 * R, 0, p.z}), kIso) << "waist at height " << p.z;
      }
      // In the plane of both, from the axis round to the lateral: the normal turns at once where they meet.
      double sharpest = 0;
      Vec3 last(0.0);
      for (int i = 200; i <= 1800; ++i) {
        const double a = angle * i / 2000;
        const Vec3 direction(std::sin(a), 0, std::cos(a));
        double lo = 0, hi = 0;
        while (hi < 1 && field.value(hi * direction) >= kIso) hi += 0.01;
        for (int k = 0; k < 40; ++k) {
          lo = k == 0 ? hi - 0.01 : lo;
          const double mid = 0.5 * (lo + hi);
          (field.value(mid * direction) >= kIso ? lo : hi) = mid;
        }
        if (hi > 0.9) continue;  // along one of the two
        const Vec3 normal = -glm::normalize(field.sample(lo * direction).gradient);
        if (glm::length(last) > 0) sharpest = std::max(sharpest, glm::length(normal - last));
        last = normal;
      }
      EXPECT_GT(sharpest, 0.2);
    }
}

TEST(Fork, WithoutReachingLateralsIsItsAxis) {
  BlobTreeBuilder b;
  const NodeId axis = b.add(Sphere{{0, 0, 0}, 0.2, -0.5}), lateral = b.add(Sphere{{5, 0, 0}, 0.1, 1});
  const Field field(b.build(b.add(Fork{axis, {{lateral, {0, 0, 0}, {0, 0, 1}, 0.1, 1}}, 0.5, 0})));
  EXPECT_EQ(field.value({0, 0, 0}), -0.5);
  EXPECT_EQ(field.value({5, 0, 0}), 1);
}

TEST(Difference, TakesAwayAndCutsSharply) {
  const Parts parts{{Sphere{{0, 0, 0}, 0.3, 1}, HalfSpace{{0, 0, 0.1}, {0, 0, -1}, 0.05}}};
  const Field cut = parts.combined([](auto ids) { return Difference{ids}; });
  EXPECT_GE(cut.value({0, 0, 0.09}), kIso);
  EXPECT_LT(cut.value({0, 0, 0.11}), kIso);
  EXPECT_GE(cut.value({0, 0, -0.29}), kIso);
}

}  // namespace
}  // namespace cambium
