#include "blobtree/blobtree.h"

#include <gtest/gtest.h>

#include <numbers>

#include <functional>
#include <limits>
#include <set>

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

template <class Spoil>
Flare flare(const Spoil& spoil) {
  Flare node{{{{0, 0, 0}, 1}, {{0, 0, 3}, 1}}, {0, 0, 0}, {0, 0, 1}, 1, 0.5, 0.7, {{0, 1}, {1, 1}, {2, 1}}};
  spoil(node);
  return node;
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
      {"nodes", [=](auto&) { return flare([](Flare& f) { f.nodes.clear(); }); }},
      {"nodes[1]", [=](auto&) { return flare([](Flare& f) { f.nodes[1].radius = 0; }); }},
      {"base", [=](auto&) { return flare([=](Flare& f) { f.base = bad; }); }},
      {"axis", [=](auto&) { return flare([=](Flare& f) { f.axis = o; }); }},
      {"height", [=](auto&) { return flare([](Flare& f) { f.height = 0; }); }},
      {"height", [=](auto&) { return flare([](Flare& f) { f.height = kNan; }); }},
      {"spread", [=](auto&) { return flare([](Flare& f) { f.spread = -0.1; }); }},
      {"spread", [=](auto&) { return flare([](Flare& f) { f.spread = 1001; }); }},
      {"sharpness", [=](auto&) { return flare([](Flare& f) { f.sharpness = 0.96; }); }},
      {"sharpness", [=](auto&) { return flare([](Flare& f) { f.sharpness = -0.1; }); }},
      {"prongs", [=](auto&) { return flare([](Flare& f) { f.prongs.clear(); }); }},
      {"prongs[1].length", [=](auto&) { return flare([](Flare& f) { f.prongs[1].length = -1; }); }},
      {"prongs[0].angle_degrees", [=](auto&) { return flare([](Flare& f) { f.prongs[0].angle = kInfinity; }); }},
      {"prongs[2].angle_degrees", [=](auto&) { return flare([](Flare& f) { f.prongs[2].angle = f.prongs[0].angle; }); }},
      {"prongs[2].angle_degrees", [=](auto&) { return flare([](Flare& f) { f.prongs[2].angle = f.prongs[1].angle + 2 * std::numbers::pi; }); }},
      {"strength", [=](auto&) { return flare([](Flare& f) { f.strength = kNan; }); }},
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
  EXPECT_NO_THROW(b.add(flare([](Flare& f) { f.sharpness = 0.95; })));
  EXPECT_NO_THROW(b.add(flare([](Flare& f) { f.sharpness = f.spread = 0; })));
  EXPECT_NO_THROW(b.add(flare([](Flare& f) { f.prongs = {{400, 0}}; })));
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
  const NodeId free = b.add(kSphere);
  EXPECT_THROW(b.add(Union{{free, a}}), InvalidNode);
  EXPECT_THROW(b.add(Fork{free, {{free, {}, {1, 0, 0}, 1, 1}}, 0.5, 0}), InvalidNode);
  const NodeId root = b.add(Contact{{s, free}});
  const BlobTree tree = b.build(root);
  EXPECT_EQ(children_of(tree.node(s)), (std::vector<NodeId>{a, c}));
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

TEST(BlobTree, TakesAttributesInAnyOrder) {
  BlobTreeBuilder b;
  std::vector<NodeId> children;
  for (int i = 0; i < 1000; ++i) children.push_back(b.add(kSphere));
  const auto has_some = [](NodeId id) { return id % 7 == 3 || id / 64 == 5; };
  for (NodeId i = 0; i < 1000; ++i)  // a permutation of all ids
    if (const NodeId id = i * 617 % 1000; has_some(id)) b.set_attributes(id, {id + 1, 1, 0.5 * id, {0, 0, 1}});
  b.set_attributes(3, {77, 1, 0, {0, 0, 1}});
  const BlobTree tree = b.build(b.add(Sum{children}));
  for (NodeId id = 0; id < tree.size(); ++id) {
    const std::uint32_t wanted = id == 3 ? 77 : has_some(id) && id < 1000 ? id + 1 : 0;
    ASSERT_EQ(tree.attributes(id).branch, wanted) << id;
  }
}

// Two of every node with lists, so that the second begins inside the pools.
TEST(BlobTree, GivesBackEveryNodeAsItWasAdded) {
  const Vec3 o(1, 2, 3), p(4, 5, 7), x(1, 0, 0), z(0, 0, 1);
  Mat4 moved(1.0);
  moved[3] = {5, 6, 7, 1};
  BlobTreeBuilder b;
  std::vector<NodeId> of;
  const auto add = [&](Node node) { return of.emplace_back(b.add(std::move(node))); };
  add(Cone{o, p, 3, 2, 0.5});
  add(RoundCone{p, o, 1, 2, 0.25});
  add(Chain{{{o, 1}, {p, 2}, {x, 3}}, 1});
  add(Chain{{{z, 4}, {o, 5}}, -2});
  add(Sphere{o, 4, 3});
  add(Capsule{o, p, 5, 4});
  add(Disc{o, z, 6, 5, 0.1});
  add(Torus{o, z, 8, 7, 0.2});
  add(RotatedBox{o, p, {0, 1, 0, 0}, 9, 0.3});
  add(HalfSpace{o, z, 11});
  const NodeId flare = b.add(Flare{{{o, 1}, {z, 2}}, p, x, 3, 4, 0.5, {{1, 2}, {3, 4}}, FlareSection::kCircle, 0.6});
  const NodeId other_flare = b.add(Flare{{{z, 3}}, x, z, 5, 6, 0.7, {{5, 6}}, FlareSection::kQuadrifolium, 0.8});
  const NodeId sum = b.add(Sum{{of[0], of[1]}}), other_sum = b.add(Sum{{of[2]}}), all = b.add(Union{{sum, other_sum}});
  const NodeId ricci = b.add(Ricci{{of[3]}, 3}), contact = b.add(Contact{{all, ricci}, 0.25, 2});
  const NodeId fork = b.add(Fork{of[4], {{of[5], o, x, 2, 3}, {of[6], p, z, 4, 5}}, 0.125, 3});
  const NodeId other_fork = b.add(Fork{of[7], {{of[8], p, x, 6, 7}}, 0.375, 1});
  const NodeId cut = b.add(Intersection{{fork, of[9]}}), less = b.add(Difference{{cut, other_fork}});
  const NodeId scaled = b.add(ScaleField{2, less}), rigid = b.add(Transform{moved, scaled});
  const NodeId bend = b.add(Bend{o, p, x, 0.5, rigid}), twist = b.add(Twist{o, z, 6, bend});
  const NodeId taper = b.add(Taper{p, z, 1, 2, 3, 4, twist});
  const BlobTree tree = b.build(b.add(Sum{{contact, taper, flare, other_flare}}));

  const Cone cone = tree.get<Cone>(of[0]);
  EXPECT_TRUE(cone.base == o && cone.tip == p && cone.radius_base == 3 && cone.radius_tip == 2 && cone.strength == 0.5);
  EXPECT_EQ(tree.get<RoundCone>(of[1]).base, p);
  EXPECT_EQ(tree.get<Chain>(of[2]).nodes.size(), 3u);
  const Chain chain = tree.get<Chain>(of[3]);
  ASSERT_EQ(chain.nodes.size(), 2u);
  EXPECT_TRUE(chain.nodes[0].position == z && chain.nodes[0].radius == 4 && chain.nodes[1].position == o);
  EXPECT_EQ(chain.strength, -2);
  EXPECT_EQ(tree.get<Sphere>(of[4]).strength, 3);
  EXPECT_EQ(tree.get<Capsule>(of[5]).radius, 5);
  EXPECT_EQ(tree.get<Disc>(of[6]).disc_radius, 6);
  EXPECT_EQ(tree.get<Torus>(of[7]).ring_radius, 8);
  EXPECT_EQ(tree.get<RotatedBox>(of[8]).rotation, glm::dvec4(0, 1, 0, 0));
  EXPECT_EQ(tree.get<HalfSpace>(of[9]).width, 11);
  const Flare first_flare = tree.get<Flare>(flare), second_flare = tree.get<Flare>(other_flare);
  ASSERT_EQ(first_flare.prongs.size(), 2u);
  EXPECT_TRUE(first_flare.prongs[1].angle == 3 && first_flare.prongs[1].length == 4 && first_flare.section == FlareSection::kCircle);
  EXPECT_TRUE(second_flare.base == x && second_flare.axis == z && second_flare.height == 5 && second_flare.spread == 6);
  EXPECT_TRUE(second_flare.sharpness == 0.7 && second_flare.prongs[0].angle == 5 && second_flare.strength == 0.8);
  EXPECT_EQ(second_flare.section, FlareSection::kQuadrifolium);
  EXPECT_EQ(tree.chain_nodes(other_flare)[0].radius, 3);
  EXPECT_EQ(tree.get<Sum>(other_sum).children, std::vector<NodeId>{of[2]});
  EXPECT_EQ(tree.get<Union>(all).children, (std::vector<NodeId>{sum, other_sum}));
  EXPECT_EQ(tree.get<Intersection>(cut).children, (std::vector<NodeId>{fork, of[9]}));
  EXPECT_EQ(tree.get<Difference>(less).children, (std::vector<NodeId>{cut, other_fork}));
  EXPECT_EQ(tree.get<Ricci>(ricci).exponent, 3);
  EXPECT_EQ(tree.get<Ricci>(ricci).children, std::vector<NodeId>{of[3]});
  EXPECT_EQ(tree.get<Contact>(contact).width, 0.25);
  EXPECT_EQ(tree.get<Contact>(contact).lip, 2);
  const Fork second = tree.get<Fork>(other_fork);
  EXPECT_TRUE(second.axis == of[7] && second.width == 0.375 && second.lip == 1);
  ASSERT_EQ(second.laterals.size(), 1u);
  const Lateral& lateral = second.laterals[0];
  EXPECT_TRUE(lateral.child == of[8] && lateral.point == p && lateral.direction == x);
  EXPECT_TRUE(lateral.softness == 6 && lateral.reach == 7);
  EXPECT_EQ(tree.get<ScaleField>(scaled).factor, 2);
  EXPECT_EQ(tree.get<Transform>(rigid).matrix, moved);
  EXPECT_EQ(tree.get<Bend>(bend).angle, 0.5);
  EXPECT_EQ(tree.get<Twist>(twist).rate, 6);
  EXPECT_EQ(tree.get<Taper>(taper).to_scale, 4);

  std::set<std::size_t> kinds;
  for (NodeId id = 0; id < tree.size(); ++id) {
    const Node node = tree.node(id);
    kinds.insert(tree.kind(id));
    EXPECT_EQ(tree.kind(id), node.index());
    const auto children = tree.children(id);
    EXPECT_EQ(children_of(node), std::vector<NodeId>(children.begin(), children.end()));
    const std::size_t in_flare = std::holds_alternative<Flare>(node) ? std::get<Flare>(node).nodes.size() : 0;
    EXPECT_EQ(tree.chain_nodes(id).size(), std::holds_alternative<Chain>(node) ? std::get<Chain>(node).nodes.size() : in_flare);
    EXPECT_EQ(tree.laterals(id).size(), node.index() == kNodeKind<Fork> ? std::get<Fork>(node).laterals.size() : 0);
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<Node>);
  EXPECT_EQ(tree.chain_nodes(of[3])[1].radius, 5);
  EXPECT_EQ(tree.laterals(fork)[1].reach, 5);
  EXPECT_THROW(tree.get<Sphere>(fork), std::bad_variant_access);
}

TEST(BlobTree, CountsTheBytesOfWhatItHolds) {
  BlobTreeBuilder b;
  std::vector<NodeId> children;
  const int count = 1000;
  for (int i = 0; i < count; ++i) children.push_back(b.add(Chain{{{{0, 0, 0}, 1}, {{0, 0, 1}, 1}, {{0, 1, 1}, 1}}, 1}));
  b.set_name(children[7], std::string(5000, 'x'));
  const std::size_t bytes = b.build(b.add(Sum{children})).memory_bytes();
  const std::size_t least = count * (3 * sizeof(ChainNode) + sizeof(NodeId)) + 5000;
  EXPECT_GE(bytes, least);
  EXPECT_LE(bytes, least + count * 24);  // an entry of the node table and a range per chain
}

TEST(ChildrenOf, GivesAForksAxisFirst) {
  EXPECT_EQ(children_of(Fork{4, {{2, {}, {}, 1, 1}, {3, {}, {}, 1, 1}}, 0.5, 0}), (std::vector<NodeId>{4, 2, 3}));
  EXPECT_EQ(children_of(ScaleField{2, 6}), std::vector<NodeId>{6});
  EXPECT_TRUE(children_of(kSphere).empty());
}

}  // namespace
}  // namespace cambium
