#include "blobtree/blobtree.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace cambium {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Sphere kSphere{{0, 0, 0}, 1, 1};

struct Illegal {
  const char* key;
  std::function<Node(BlobTreeBuilder&)> node;
};

Mat4 shear() {
  Mat4 m(1.0);
  m[1][0] = 0.1;
  return m;
}
Mat4 mirror() {
  Mat4 m(1.0);
  m[0][0] = -1;
  return m;
}
Mat4 stretch() {
  Mat4 m(1.0);
  m[2][2] = 1.00001;
  return m;
}
Mat4 projective() {
  Mat4 m(1.0);
  m[0][3] = 0.5;
  return m;
}

TEST(BlobTreeBuilder, RefusesIllegalNodesNamingTheKey) {
  const Vec3 o(0.0), z(0, 0, 1), bad(0, kNan, 0);
  const auto child = [](BlobTreeBuilder& b) { return b.add(kSphere); };
  const Illegal table[] = {
      {"radius", [=](auto&) { return Sphere{o, 0, 1}; }},
      {"radius", [=](auto&) { return Sphere{o, -1, 1}; }},
      {"radius", [=](auto&) { return Sphere{o, kNan, 1}; }},
      {"radius", [=](auto&) { return Sphere{o, kInfinity, 1}; }},
      {"radius", [=](auto&) { return Sphere{o, 1e-300, 1}; }},
      {"center", [=](auto&) { return Sphere{bad, 1, 1}; }},
      {"center", [=](auto&) { return Sphere{{1e300, 0, 0}, 1, 1}; }},
      {"strength", [=](auto&) { return Sphere{o, 1, kInfinity}; }},
      {"base", [=](auto&) { return Cone{bad, z, 1, 1, 1}; }},
      {"tip", [=](auto&) { return Cone{o, bad, 1, 1, 1}; }},
      {"radius_base", [=](auto&) { return Cone{o, z, 0, 1, 1}; }},
      {"radius_tip", [=](auto&) { return Cone{o, z, 1, 0, 1}; }},
      {"radius_tip", [=](auto&) { return RoundCone{o, z, 1, -1, 1}; }},
      {"nodes", [=](auto&) { return Chain{}; }},
      {"nodes[1]", [=](auto&) { return Chain{{{o, 1}, {z, 0}}, 1}; }},
      {"nodes[0]", [=](auto&) { return Chain{{{bad, 1}}, 1}; }},
      {"a", [=](auto&) { return Capsule{bad, z, 1, 1}; }},
      {"normal", [=](auto&) { return Disc{o, o, 1, 1, 1}; }},
      {"disc_radius", [=](auto&) { return Disc{o, z, 0, 1, 1}; }},
      {"ring_radius", [=](auto&) { return Torus{o, z, 0, 1, 1}; }},
      {"half_size", [=](auto&) { return RotatedBox{o, {1, -1, 1}, {1, 0, 0, 0}, 1, 1}; }},
      {"rotation", [=](auto&) { return RotatedBox{o, {1, 1, 1}, {0, 0, 0, 0}, 1, 1}; }},
      {"width", [=](auto&) { return HalfSpace{o, z, 0}; }},
      {"normal", [=](auto&) { return HalfSpace{o, bad, 1}; }},
      {"children", [=](auto&) { return Sum{}; }},
      {"children", [=](auto&) { return Union{}; }},
      {"children", [=](auto&) { return Intersection{}; }},
      {"children", [=](auto&) { return Difference{}; }},
      {"exponent", [=](auto& b) { return Ricci{{child(b)}, 0.5}; }},
      {"exponent", [=](auto& b) { return Ricci{{child(b)}, kInfinity}; }},
      {"width", [=](auto& b) { return Contact{{child(b)}, 0.51, 0}; }},
      {"width", [=](auto& b) { return Contact{{child(b)}, 0, 0}; }},
      {"lip", [=](auto& b) { return Contact{{child(b)}, 0.5, 4.1}; }},
      {"lip", [=](auto& b) { return Contact{{child(b)}, 0.5, -0.1}; }},
      {"laterals", [=](auto& b) { return Fork{child(b), {}, 0.5, 0}; }},
      {"laterals[0].softness", [=](auto& b) { return Fork{child(b), {{child(b), o, z, 0, 1}}, 0.5, 0}; }},
      {"laterals[0].reach", [=](auto& b) { return Fork{child(b), {{child(b), o, z, 1, kNan}}, 0.5, 0}; }},
      {"laterals[0].direction", [=](auto& b) { return Fork{child(b), {{child(b), o, o, 1, 1}}, 0.5, 0}; }},
      {"factor", [=](auto& b) { return ScaleField{kNan, child(b)}; }},
      {"matrix", [=](auto& b) { return Transform{shear(), child(b)}; }},
      {"matrix", [=](auto& b) { return Transform{mirror(), child(b)}; }},
      {"matrix", [=](auto& b) { return Transform{stretch(), child(b)}; }},
      {"matrix", [=](auto& b) { return Transform{projective(), child(b)}; }},
      {"matrix", [=](auto& b) { return Transform{Mat4(0.0), child(b)}; }},
      {"to", [=](auto& b) { return Bend{o, o, {1, 0, 0}, 1, child(b)}; }},
      {"direction", [=](auto& b) { return Bend{o, z, 2.0 * z, 1, child(b)}; }},
      {"angle_degrees", [=](auto& b) { return Bend{o, z, {1, 0, 0}, 6.2831853071795865, child(b)}; }},
      {"angle_degrees", [=](auto& b) { return Bend{o, z, {1, 0, 0}, kNan, child(b)}; }},
      {"axis", [=](auto& b) { return Twist{o, o, 1, child(b)}; }},
      {"rate_degrees_per_metre", [=](auto& b) { return Twist{o, z, kNan, child(b)}; }},
      {"from[1]", [=](auto& b) { return Taper{o, z, 0, 0, 1, 1, child(b)}; }},
      {"to[1]", [=](auto& b) { return Taper{o, z, 0, 1, 1, -1, child(b)}; }},
      {"to[0]", [=](auto& b) { return Taper{o, z, 1, 1, 1, 1, child(b)}; }},
      {"child", [=](auto&) { return ScaleField{1, 7}; }},
      {"children[1]", [=](auto& b) { return Sum{{child(b), 99}}; }},
      {"laterals[0].child", [=](auto& b) { return Fork{child(b), {{99, o, z, 1, 1}}, 0.5, 0}; }},
      {"axis", [=](auto&) { return Fork{0, {{1, o, z, 1, 1}}, 0.5, 0}; }},
  };
  for (const Illegal& row : table) {
    BlobTreeBuilder builder;
    const Node node = row.node(builder);
    const std::size_t before = builder.size();
    try {
      builder.add(node);
      ADD_FAILURE() << "accepted an illegal `" << row.key << "` of alternative " << node.index();
    } catch (const InvalidNode& error) {
      EXPECT_EQ(error.key(), row.key) << error.what();
      EXPECT_FALSE(error.found().empty());
      EXPECT_FALSE(error.expected().empty());
    }
    EXPECT_EQ(builder.size(), before);
  }
}

TEST(BlobTreeBuilder, AcceptsTheLimits) {
  const Vec3 o(0.0), z(0, 0, 1);
  BlobTreeBuilder b;
  const auto child = [&] { return b.add(kSphere); };
  EXPECT_NO_THROW(b.add(Cone{o, o, 1, 1, 0}));
  EXPECT_NO_THROW(b.add(RotatedBox{o, o, {0, 0, 0, 2}, 1, -1}));
  EXPECT_NO_THROW(b.add(Chain{{{o, 1}, {o, 2}}, 1}));
  EXPECT_NO_THROW(b.add(Ricci{{child()}, 1}));
  EXPECT_NO_THROW(b.add(Contact{{child()}, 0.5, 4}));
  EXPECT_NO_THROW(b.add(Bend{o, z, {1, 0, 0}, 0, child()}));
  EXPECT_NO_THROW(b.add(Bend{o, z, {1, 0, 0}, -6.28, child()}));
}

TEST(BlobTreeBuilder, UsesEveryChildOnce) {
  BlobTreeBuilder b;
  const NodeId a = b.add(kSphere), c = b.add(kSphere);
  EXPECT_THROW(b.add(Sum{{a, a}}), InvalidNode);
  const NodeId s = b.add(Sum{{a, c}});  // the refused one has claimed nothing
  EXPECT_THROW(b.add(Union{{a}}), InvalidNode);
  EXPECT_EQ(children_of(b.build(s).node(s)), (std::vector<NodeId>{a, c}));
}

TEST(BlobTreeBuilder, BuildsOnlyOneWholeTree) {
  BlobTreeBuilder b;
  const NodeId a = b.add(kSphere), s = b.add(Sum{{a}});
  EXPECT_THROW(b.build(a), InvalidNode);
  EXPECT_THROW(b.build(9), InvalidNode);
  const NodeId stray = b.add(kSphere);
  EXPECT_THROW(b.build(s), InvalidNode);
  const BlobTree tree = b.build(b.add(Sum{{s, stray}}));
  EXPECT_EQ(tree.size(), 4u);
  EXPECT_EQ(b.size(), 0u);
}

TEST(BlobTree, GivesNamesAndAttributesOfEachNode) {
  BlobTreeBuilder b;
  std::vector<NodeId> children;
  for (int i = 0; i < 5; ++i) children.push_back(b.add(kSphere));
  b.set_name(children[3], "late");
  b.set_name(children[1], "early");
  b.set_name(children[3], "later");
  b.set_attributes(children[2], {7, 2, 1.5, {1, 0, 0}});
  EXPECT_THROW(b.set_name(99, "x"), InvalidNode);
  EXPECT_THROW(b.set_attributes(99, {}), InvalidNode);
  const BlobTree tree = b.build(b.add(Sum{children}));
  EXPECT_EQ(tree.name(children[1]), "early");
  EXPECT_EQ(tree.name(children[3]), "later");
  EXPECT_EQ(tree.name(children[2]), "");
  EXPECT_EQ(tree.attributes(children[2]).branch, 7u);
  EXPECT_EQ(tree.attributes(children[2]).v_begin, 1.5);
  EXPECT_EQ(tree.attributes(children[1]).order, 0u);
}

TEST(ChildrenOf, GivesAForksAxisFirst) {
  EXPECT_EQ(children_of(Fork{4, {{2, {}, {}, 1, 1}, {3, {}, {}, 1, 1}}, 0.5, 0}), (std::vector<NodeId>{4, 2, 3}));
  EXPECT_EQ(children_of(ScaleField{2, 6}), std::vector<NodeId>{6});
  EXPECT_TRUE(children_of(kSphere).empty());
}

}  // namespace
}  // namespace cambium
