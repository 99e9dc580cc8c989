#include "polygonize/crease_point.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace cambium {
namespace {

using Operator = std::function<Node(std::vector<NodeId>)>;

struct Made {
  Field field;
  PrunedField whole;
  explicit Made(const BlobTree& tree) : field(tree), whole(field.whole()) {}
};

Made made_of(const std::vector<Node>& nodes, const Operator& op) {
  BlobTreeBuilder b;
  std::vector<NodeId> ids;
  for (const Node& n : nodes) ids.push_back(b.add(n));
  return Made(b.build(b.add(op(ids))));
}
Field alone(const Node& node) {
  BlobTreeBuilder b;
  return Field(b.build(b.add(node)));
}

Choices choice(std::vector<std::uint32_t> winners) { return {std::move(winners)}; }
Box around(const Vec3& p, double reach) { return {p - reach, p + reach}; }

struct Jitter {
  std::mt19937 random{11};
  Vec3 operator()(double size) {
    std::uniform_real_distribution<> number(-size, size);
    const double x = number(random), y = number(random);
    return {x, y, number(random)};
  }
};

/// Where spheres of this radius round (0, 0, 0) and (2 half, 0, 0) are both at distance `away`.
Vec3 on_circle(double half, double away, double angle) {
  const double r = std::sqrt(away * away - half * half);
  return {half, r * std::cos(angle), r * std::sin(angle)};
}
/// Distance from the centre of a sphere of radius 1 at which its field is f.
double distance_of(double f) { return kSupportPerRadius * std::sqrt(1 - std::cbrt(f)); }

const std::vector<Node> kTwoSpheres{Sphere{{0, 0, 0}, 1, 1}, Sphere{{1.4, 0, 0}, 1, 1}};

TEST(Crease, OfAUnionOfSpheresIsTheirCircle) {
  const Made made = made_of(kTwoSpheres, [](auto ids) { return Union{ids}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({0}), choice({1})};
  Jitter jitter;
  for (int i = 0; i < 200; ++i) {
    const Vec3 exact = on_circle(0.7, 1, 0.1 * i), start = exact + jitter(0.2);
    const auto found = find_crease(evaluator, made.whole, sides, start, around(exact, 0.4));
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->kind, CreaseKind::kCurve);
    EXPECT_FALSE(found->cusp);
    EXPECT_LT(found->miss, 1e-9);
    const Vec3& p = found->position;
    EXPECT_NEAR(p.x, 0.7, 1e-9);
    EXPECT_NEAR(std::hypot(p.y, p.z), exact.y * exact.y + exact.z * exact.z > 0 ? std::sqrt(1 - 0.49) : 0, 1e-9);
    EXPECT_LT(glm::length(p - exact), 0.4);    // near the start, not elsewhere on the circle
    EXPECT_NEAR(glm::length(found->normals[0] - p), 0, 1e-9);
    EXPECT_NEAR(glm::length(found->normals[1] - (p - Vec3(1.4, 0, 0))), 0, 1e-9);
  }
}

TEST(Crease, OfACutIsALineOfItsPlane) {
  // A slab with its top at z = 0.5, cut away above the plane x + z = 0.6.
  const std::vector<Node> nodes{RotatedBox{{0, 0, 0}, {1, 1, 0.4}, {1, 0, 0, 0}, 0.1, 1},
                                HalfSpace{{0.1, 0, 0.5}, glm::normalize(Vec3(-1, 0, -1)), 0.2}};
  const Made made = made_of(nodes, [](auto ids) { return Difference{ids}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({0}), choice({1})};
  Jitter jitter;
  for (int i = 0; i < 100; ++i) {
    const Vec3 exact(0.1, -0.5 + 0.01 * i, 0.5);
    const auto found = find_crease(evaluator, made.whole, sides, exact + jitter(0.05), around(exact, 0.1));
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->kind, CreaseKind::kCurve);
    EXPECT_NEAR(found->position.x, 0.1, 1e-10);
    EXPECT_NEAR(found->position.z, 0.5, 1e-10);
    EXPECT_NEAR(glm::length(found->normals[0] - Vec3(0, 0, 1)), 0, 1e-9);
    EXPECT_NEAR(glm::length(found->normals[1] - glm::normalize(Vec3(1, 0, 1))), 0, 1e-9);
  }
}

TEST(Crease, OfThreePlanesIsACorner) {
  const Vec3 corner(0.1, 0.05, -0.02);
  const std::array<Vec3, 3> normals{Vec3(1, 0, 0), glm::normalize(Vec3(0.3, 1, 0)), glm::normalize(Vec3(0, 0.4, 1))};
  std::vector<Node> nodes{Sphere{{0, 0, 0}, 1, 1}};
  for (const Vec3& n : normals) nodes.push_back(HalfSpace{corner, n, 0.4});
  const Made made = made_of(nodes, [](auto ids) { return Intersection{ids}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({1}), choice({2}), choice({3})};
  Jitter jitter;
  for (int i = 0; i < 50; ++i) {
    const auto found = find_crease(evaluator, made.whole, sides, corner + jitter(0.1), around(corner, 0.2));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kind, CreaseKind::kCorner);
    EXPECT_NEAR(glm::length(found->position - corner), 0, 1e-10);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(glm::length(found->normals[k] - normals[k]), 0, 1e-10);
  }
}

// With a lip of 2 and less the sheets close up where both spheres are at their surface, above that sooner.
TEST(Crease, OfAContactIsWhereItsSheetsMeet) {
  for (const double width : {0.5, 0.2}) {
    for (const double lip : {0.0, 1.0, 1.5, 2.5, 3.0, 4.0}) {
      SCOPED_TRACE(testing::Message() << "width " << width << ", lip " << lip);
      const Made made = made_of(kTwoSpheres, [&](auto ids) { return Contact{ids, width, lip}; });
      ChoiceEvaluator evaluator;
      const std::array sides{choice({0}), choice({1})};
      // (1 - u)^2 (1 + lip u) = 1: the push of a child is then its own depth.
      const double u = lip > 2 ? (2 * lip - 1 - std::sqrt(4 * lip + 1)) / (2 * lip) : 0;
      const double away = distance_of(kIso - u * width);
      Jitter jitter;
      for (int i = 0; i < 200; ++i) {
        const Vec3 exact = on_circle(0.7, away, 0.3 * i);
        const auto found = find_crease(evaluator, made.whole, sides, exact + jitter(0.1), around(exact, 0.4));
        ASSERT_TRUE(found) << i;
        const Vec3& p = found->position;
        EXPECT_EQ(found->kind, CreaseKind::kCurve);
        EXPECT_NEAR(p.x, 0.7, 1e-9);
        EXPECT_NEAR(std::hypot(p.y, p.z), std::sqrt(away * away - 0.49), 1e-9);
        if (lip < 2) {
          EXPECT_TRUE(found->cusp);
          EXPECT_NEAR(glm::dot(found->normals[0], found->normals[1]), -1, 1e-9);
        } else {
          EXPECT_GT(glm::dot(found->normals[0], found->normals[1]), -1 + 1e-4);
        }
        EXPECT_GT(found->normals[0].x, 0.05);   // the left sheet looks right, into the crack
        EXPECT_LT(found->normals[1].x, -0.05);
      }
    }
  }
}

TEST(Crease, OfTwigsFarFromTheOriginIsAsExactAsDoublesAre) {
  const Vec3 place(-21.3, 9.1, 33.7);
  const double r = 5e-4;
  for (const double lip : {0.0, 3.0}) {
    const std::vector<Node> twigs{Sphere{place, r, 1}, Sphere{place + Vec3(1.4 * r, 0, 0), r, 1}};
    const Made made = made_of(twigs, [&](auto ids) { return Contact{ids, 0.5, lip}; });
    const double u = lip > 2 ? (2 * lip - 1 - std::sqrt(4 * lip + 1)) / (2 * lip) : 0;
    ChoiceEvaluator evaluator;
    const std::array sides{choice({0}), choice({1})};
    Jitter jitter;
    for (int i = 0; i < 100; ++i) {
      const Vec3 offset = r * on_circle(0.7, distance_of(kIso - 0.5 * u), 0.3 * i), start = place + offset + jitter(0.1 * r);
      const auto found = find_crease(evaluator, made.whole, sides, start, around(place + offset, 0.4 * r));
      ASSERT_TRUE(found) << i;
      const Vec3 p = (found->position - place) / r;
      EXPECT_NEAR(p.x, 0.7, 1e-9);
      EXPECT_NEAR(std::hypot(p.y, p.z), glm::length(Vec3(0, offset.y, offset.z)) / r, 1e-9);
    }
  }
}

TEST(Crease, OfConesInContactIsWhereTheirSurfacesCross) {
  const Cone one{{0, 0, 0}, {-0.4, 0, 1}, 0.2, 0.15, 1}, other{{0, 0, 0}, {0.5, 0.1, 1}, 0.16, 0.12, 1};
  const Field left = alone(one), right = alone(other);
  for (const double lip : {0.0, 1.5}) {
    const Made made = made_of({one, other}, [&](auto ids) { return Contact{ids, 0.5, lip}; });
    ChoiceEvaluator evaluator;
    const std::array sides{choice({0}), choice({1})};
    Jitter jitter;
    int found_some = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 start = Vec3(0, 0, 0.35) + jitter(0.15);
      const auto found = find_crease(evaluator, made.whole, sides, start, around(start, 0.2));
      if (!found) continue;
      ++found_some;
      EXPECT_TRUE(found->cusp);
      EXPECT_NEAR(left.value(found->position), kIso, 1e-9);
      EXPECT_NEAR(right.value(found->position), kIso, 1e-9);
    }
    EXPECT_GT(found_some, 200);
  }
}

// A blend with something else opens the cusp, the less there is of it the less.
TEST(Crease, OfAContactThatIsPartOfASumOpensLittleByLittle) {
  for (const double lip : {0.0, 1.5}) {
    for (const double strength : {0.3, 0.1, 1e-2, 1e-4, 1e-6}) {
      SCOPED_TRACE(testing::Message() << "lip " << lip << ", strength " << strength);
      BlobTreeBuilder b;
      const NodeId pair = b.add(Contact{{b.add(kTwoSpheres[0]), b.add(kTwoSpheres[1])}, 0.5, lip});
      const NodeId both = b.add(Sum{{pair, b.add(Sphere{{0.7, 0, 0}, 1, strength})}});
      const Made made(b.build(both));
      const Field left = alone(kTwoSpheres[0]), right = alone(kTwoSpheres[1]);
      ChoiceEvaluator evaluator;
      const std::array sides{choice({0}), choice({1})};
      Jitter jitter;
      for (int i = 0; i < 60; ++i) {
        const Vec3 guess = on_circle(0.7, 1, 0.7 * i), start = guess + jitter(0.1);
        const auto found = find_crease(evaluator, made.whole, sides, start, around(guess, 0.8));
        ASSERT_TRUE(found) << i;
        const Vec3& p = found->position;
        EXPECT_NEAR(left.value(p), right.value(p), 1e-9);
        EXPECT_LT(left.value(p), kIso + 1e-9);
        EXPECT_NEAR(made.field.value(p), kIso, 1e-9);
        // Out of the crack along its middle: outside at once.
        const Vec3 out = glm::normalize(Vec3(0, p.y, p.z));
        EXPECT_LT(made.field.value(p + 1e-3 * out), kIso);
        EXPECT_GT(made.field.value(p - 1e-3 * out), kIso);
        EXPECT_LT(glm::dot(found->normals[0], found->normals[1]), 0.9);
      }
    }
  }
}

TEST(Crease, OfThreeInContactIsACorner) {
  const double h = std::sqrt(3.0) / 2;
  const std::vector<Node> nodes{Sphere{{0, 0, 0}, 1, 1}, Sphere{{1.2, 0, 0}, 1, 1}, Sphere{{0.6, 1.2 * h, 0}, 1, 1}};
  const double from_centre = 1.2 / std::sqrt(3.0);
  const Vec3 exact(0.6, 0.4 * h, std::sqrt(1 - from_centre * from_centre));
  ChoiceEvaluator evaluator;
  Jitter jitter;
  for (const double lip : {0.0, 1.5}) {
    const Made made = made_of(nodes, [&](auto ids) { return Contact{ids, 0.5, lip}; });
    const std::vector<Choices> all{choice({0, 1}), choice({0, 2}), choice({1, 0}), choice({1, 2}), choice({2, 0}), choice({2, 1})};
    const std::vector<Choices> three{all[0], all[3], all[4]};
    for (int i = 0; i < 50; ++i) {
      for (const auto& sides : {all, three}) {
        const auto found = find_crease(evaluator, made.whole, sides, exact + jitter(0.1), around(exact, 0.2));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->kind, CreaseKind::kCorner);
        EXPECT_NEAR(glm::length(found->position - exact), 0, 1e-9);
        EXPECT_LT(found->miss, 1e-9);
      }
    }
    // The two that push the third: their crease runs over its sheet, from the corner on.
    const std::array pushed{all[0], all[1]};
    const auto found = find_crease(evaluator, made.whole, pushed, exact + Vec3(-0.05, -0.03, 0.03), around(exact, 0.2));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kind, CreaseKind::kCurve);
    const double second = alone(nodes[1]).value(found->position), third = alone(nodes[2]).value(found->position);
    EXPECT_NEAR(second, third, 1e-9);
    EXPECT_GT(alone(nodes[0]).value(found->position), second);
    EXPECT_NEAR(made.field.value(found->position), kIso, 1e-9);
  }
}

TEST(Crease, OfACutThroughAContactEndsItInACorner) {
  BlobTreeBuilder b;
  const NodeId pair = b.add(Contact{{b.add(kTwoSpheres[0]), b.add(kTwoSpheres[1])}, 0.5, 0});
  const Made made(b.build(b.add(Difference{{pair, b.add(HalfSpace{{0, 0, 0.3}, {0.1, 0, -1}, 0.2})}})));
  ChoiceEvaluator evaluator;
  const double r = std::sqrt(1 - 0.49), z = 0.3 + 0.07;
  const Vec3 exact(0.7, std::sqrt(r * r - z * z), z);
  const std::array sides{choice({0, 0}), choice({1, 0}), choice({Choices::kDoesNotMatter, 1})};
  Jitter jitter;
  for (int i = 0; i < 50; ++i) {
    const auto found = find_crease(evaluator, made.whole, sides, exact + jitter(0.1), around(exact, 0.2));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kind, CreaseKind::kCorner);
    EXPECT_TRUE(found->cusp);
    EXPECT_NEAR(glm::length(found->position - exact), 0, 1e-9);
  }
}

// ---- a fork: cells around the joint, sides as a mesher meets them ---------------------------------------------------
struct Joint {
  Field axis, lateral;
  Made made;
};
Joint joint(double ratio, double degrees, double lip) {
  const double R = 0.1, r = ratio * R, angle = degrees * std::numbers::pi / 180;
  const Vec3 along(std::sin(angle), 0, std::cos(angle));
  const Vec3 start = std::max(0.0, kSupportPerRadius * r - R) / std::sin(angle) * along;
  const Vec3 up = glm::normalize(Vec3(0, 0, 1) - along.z * along);
  const Chain trunk{{{{0, 0, -1}, R}, {{0, 0, 1}, R}}, 1}, branch{{{start, r}, {start + along, r}}, 1};
  BlobTreeBuilder b;
  const NodeId axis = b.add(trunk), lateral = b.add(branch);
  return {alone(trunk), alone(branch), Made(b.build(b.add(Fork{axis, {{lateral, {0, 0, 0}, up, 0.6 * r, 2 * (R + r)}}, 0.5, lip})))};
}

TEST(Crease, OfAForkIsInItsCrotchAndFadesIntoItsCollar) {
  for (const double lip : {0.0, 1.5, 4.0}) {
    int sharp = 0, fading = 0, smooth = 0, outside = 0;
    for (const double ratio : {0.35, 0.6, 0.85}) {
      const Joint j = joint(ratio, 45, lip);
      SCOPED_TRACE(testing::Message() << "lip " << lip << ", ratio " << ratio);
      ChoiceEvaluator evaluator;
      Evaluator plain;
      Jitter jitter;
      const double cell = 0.03;
      for (int i = 0; i < 10000; ++i) {
        // Two points of the surface within a cell, of different choices.
        const Vec3 centre = Vec3(0.12, 0, 0.08) + jitter(0.2);
        const Sample middle_of_cell = plain.sample(j.made.whole, centre);
        if (std::abs(middle_of_cell.value - kIso) > cell * glm::length(middle_of_cell.gradient)) continue;   // far from the surface
        std::vector<Vec3> points;
        std::vector<Choices> sides;
        for (int k = 0; k < 12 && sides.size() < 2; ++k) {
          Vec3 p = centre + jitter(0.5 * cell);
          for (int step = 0; step < 20; ++step) {
            const Sample s = plain.sample(j.made.whole, p);
            const double square = glm::dot(s.gradient, s.gradient);
            if (!(square > 0)) break;
            p -= (s.value - kIso) / square * s.gradient;
          }
          Choices at;
          if (!around(centre, 0.5 * cell).contains(p) || std::abs(evaluator.choose(j.made.whole, p, at) - kIso) > 1e-9) continue;
          if (!sides.empty() && at == sides[0]) continue;
          sides.push_back(at);
          points.push_back(p);
        }
        if (sides.size() < 2) continue;
        const Vec3 middle = 0.5 * (points[0] + points[1]);
        const auto found = find_crease(evaluator, j.made.whole, sides, middle, around(centre, cell));
        if (!found) {   // both sheets run through the cell, and meet outside of it
          const auto beyond = find_crease(evaluator, j.made.whole, sides, middle, around(centre, 0.3));
          ++outside;
          ASSERT_TRUE(beyond);
          EXPECT_FALSE(around(centre, 0.9 * cell).contains(beyond->position));
          EXPECT_NEAR(j.axis.value(beyond->position), j.lateral.value(beyond->position), 1e-9);
          continue;
        }
        const Vec3& p = found->position;
        if (found->kind == CreaseKind::kNone) {
          ++smooth;
          EXPECT_NEAR(plain.value(j.made.whole, p), kIso, 1e-3);
          continue;
        }
        EXPECT_NEAR(plain.value(j.made.whole, p), kIso, 1e-10);
        (glm::dot(found->normals[0], found->normals[1]) < 0.5 ? sharp : fading) += 1;
        EXPECT_EQ(found->kind, CreaseKind::kCurve);
        EXPECT_NEAR(j.axis.value(p), j.lateral.value(p), 1e-7);
      }
    }
    EXPECT_GT(sharp, 50);
    EXPECT_GT(fading, 20);
    EXPECT_GT(smooth, 20);
    EXPECT_LT(outside, (sharp + fading + smooth) / 4);
  }
}

TEST(Crease, StaysInAPlaneWhereToldTo) {
  const Made made = made_of(kTwoSpheres, [](auto ids) { return Union{ids}; });
  const Made touching = made_of(kTwoSpheres, [](auto ids) { return Contact{ids, 0.5, 0}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({0}), choice({1})};
  Jitter jitter;
  for (int i = 0; i < 100; ++i) {
    const Vec3 exact = on_circle(0.7, 1, 0.8), start = exact + jitter(0.1);
    for (const PrunedField* field : {&made.whole, &touching.whole}) {
      for (const int axis : {1, 2}) {
        const auto found = find_crease(evaluator, *field, sides, start, around(exact, 0.3), axis);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->kind, CreaseKind::kCurve);
        EXPECT_EQ(found->position[axis], start[axis]);
        EXPECT_NEAR(found->position.x, 0.7, 1e-9);
        EXPECT_NEAR(found->position.y * found->position.y + found->position.z * found->position.z, 0.51, 1e-9);
      }
      EXPECT_FALSE(find_crease(evaluator, *field, sides, start + Vec3(0.01, 0, 0), around(exact, 0.3), 0));   // it runs beside that one
    }
  }
}

TEST(Crease, IsNoneWhereSidesAgree) {
  // The third sphere is out of the contact's width: which of two pushes makes no difference.
  const std::vector<Node> nodes{Sphere{{0, 0, 0}, 1, 1}, Sphere{{1.9, 0, 0}, 1, 1}, Sphere{{-1.9, 0, 0}, 1, 1}};
  const Made made = made_of(nodes, [](auto ids) { return Contact{ids, 0.3, 0}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({0, 1}), choice({0, 2})};
  const auto found = find_crease(evaluator, made.whole, sides, {0, 0.95, 0.1}, around({0, 1, 0}, 0.3));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, CreaseKind::kNone);
  EXPECT_NEAR(glm::length(found->position), 1, 1e-9);
  EXPECT_NEAR(glm::dot(found->normals[0], found->normals[1]), 1, 1e-12);
}

TEST(Crease, IsNotGivenWhereItIsElsewhereOrHidden) {
  const Made two = made_of(kTwoSpheres, [](auto ids) { return Union{ids}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({0}), choice({1})};
  const Vec3 off(-0.5, 0.8, 0);
  EXPECT_FALSE(find_crease(evaluator, two.whole, sides, off, around(off, 0.2)));
  const Made apart = made_of({Sphere{{0, 0, 0}, 1, 1}, Sphere{{2.2, 0, 0}, 1, 1}}, [](auto ids) { return Union{ids}; });
  EXPECT_FALSE(find_crease(evaluator, apart.whole, sides, {1.1, 0.1, 0}, around({1.1, 0, 0}, 1)));
  const Made near = made_of({Sphere{{0, 0, 0}, 1, 1}, Sphere{{2.2, 0, 0}, 1, 1}}, [](auto ids) { return Contact{ids, 0.5, 0}; });
  EXPECT_FALSE(find_crease(evaluator, near.whole, sides, {1.1, 0.1, 0}, around({1.1, 0, 0}, 1)));
  // A third sphere covers a part of the circle.
  std::vector<Node> nodes = kTwoSpheres;
  const Vec3 covered = on_circle(0.7, 1, 0), free = on_circle(0.7, 1, std::numbers::pi);
  nodes.push_back(Sphere{covered, 0.3, 1});
  const std::array<Operator, 2> orders{[](auto ids) { return Union{ids}; }, [](auto ids) { return Union{{ids[2], ids[0], ids[1]}}; }};
  for (const Operator& op : orders) {
    const Made three = made_of(nodes, op);
    Choices a, b;
    evaluator.choose(three.whole, free - Vec3(0.1, 0, 0), a);
    evaluator.choose(three.whole, free + Vec3(0.1, 0, 0), b);
    const std::array of_spheres{a, b};
    EXPECT_TRUE(find_crease(evaluator, three.whole, of_spheres, free, around(free, 0.2)));
    EXPECT_FALSE(find_crease(evaluator, three.whole, of_spheres, covered + Vec3(0.01), around(covered, 0.2)));
  }
}

// Four planes seldom meet in a point.
TEST(Crease, OfMoreThanThreeSidesIsTheBestFit) {
  std::vector<Node> nodes{Sphere{{0, 0, 0}, 1, 1}};
  const std::array<Vec3, 4> normals{glm::normalize(Vec3(1, 0, 1)), glm::normalize(Vec3(-1, 0, 1)), glm::normalize(Vec3(0, 1, 1)),
                                    glm::normalize(Vec3(0, -1, 1))};
  for (int k = 0; k < 4; ++k) nodes.push_back(HalfSpace{Vec3(0, 0, k < 2 ? 0.02 : -0.02), normals[k], 0.4});
  const Made made = made_of(nodes, [](auto ids) { return Intersection{ids}; });
  ChoiceEvaluator evaluator;
  const std::array sides{choice({1}), choice({2}), choice({3}), choice({4})};
  const auto found = find_crease(evaluator, made.whole, sides, {0.05, 0.03, 0.04}, around(Vec3(0), 0.2));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, CreaseKind::kCorner);
  EXPECT_NEAR(glm::length(found->position), 0, 1e-9);
  EXPECT_NEAR(found->miss, 0.02 / std::sqrt(2.0), 1e-9);
}

}  // namespace
}  // namespace cambium
