#include "conformance_cases.h"

#include <array>

namespace cambium {
namespace {

const std::array kSections{FlareSection::kEnvelope, FlareSection::kQuadrifolium, FlareSection::kCircle};

/// Flares of all kinds by themselves, inside every operator that is apt to have one, and nests of them.
void add_flares(std::vector<ConformanceCase>& cases) {
  const auto build = [&](std::string name, auto&& root) {
    BlobTreeBuilder b;
    const NodeId id = root(b);
    cases.push_back({"flare " + std::move(name), b.build(id)});
  };
  for (const std::size_t prongs : {1u, 2u, 3u, 4u, 7u}) {
    for (const double sharpness : {0.2, 0.6, 0.95})
      for (const FlareSection section : kSections)
        build(std::to_string(prongs) + " prongs, sharpness " + std::to_string(sharpness),
              [&](BlobTreeBuilder& b) { return b.add(flared_trunk(prongs, sharpness, section)); });
    build("tilted", [&](BlobTreeBuilder& b) { return b.add(flared_trunk(prongs, 0.7, FlareSection::kEnvelope, {1, 2, 3}, {1, 0.2, 0.5})); });
    const auto trunk = [&](BlobTreeBuilder& b) { return b.add(flared_trunk(prongs, 0.8)); };
    const auto limb = [](BlobTreeBuilder& b) { return b.add(Chain{{{{0, 0, 0.5}, 0.2}, {{1, 0, 1}, 0.1}}}); };
    build("in a contact", [&](BlobTreeBuilder& b) { return b.add(Contact{{trunk(b), limb(b)}, 0.4, 1}); });
    build("in a difference", [&](BlobTreeBuilder& b) { return b.add(Difference{{trunk(b), b.add(HalfSpace{{0, 0, 0.1}, {0, 0, -1}, 0.1})}}); });
    build("in a fork", [&](BlobTreeBuilder& b) {
      return b.add(Fork{trunk(b), {{limb(b), {0, 0, 0.5}, {0, 0, 1}, 0.1, 0.8}}});
    });
    build("that is a fork's lateral", [&](BlobTreeBuilder& b) {
      return b.add(Fork{limb(b), {{trunk(b), {0, 0, 0.5}, {0, 0, 1}, 0.1, 0.8}}});
    });
    build("bent", [&](BlobTreeBuilder& b) { return b.add(Bend{{0, 0, 0}, {0, 0, 3}, {1, 0, 0}, 0.4, trunk(b)}); });
    build("turned and scaled", [&](BlobTreeBuilder& b) {
      Mat4 m(0.0);
      m[0][2] = m[1][0] = m[2][1] = 1.3;
      m[3] = {0.2, -0.4, 0.6, 1};
      return b.add(Transform{m, trunk(b)});
    });
  }
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    BlobTreeGrower grower(1000 + seed);
    const NodeId id = grower.flare();
    cases.push_back({"flare, seed " + std::to_string(seed), grower.finish(id)});
  }
  for (std::uint64_t seed = 400; seed < 600; ++seed)
    cases.push_back({"nest with flares, seed " + std::to_string(seed), random_flared_blobtree(seed, 1 + static_cast<int>(seed % 3))});
}

std::vector<ConformanceCase> make_cases() {
  std::vector<ConformanceCase> cases;
  const auto grow = [&](std::string name, std::uint64_t seed, auto&& root) {
    BlobTreeGrower grower(seed);
    const NodeId id = root(grower);
    cases.push_back({std::move(name), grower.finish(id)});
  };
  for (int kind = 0; kind < BlobTreeGrower::kPrimitives; ++kind)
    for (std::uint64_t seed : {11u, 12u, 13u})
      grow("primitive " + std::to_string(kind) + " seed " + std::to_string(seed), seed,
           [&](BlobTreeGrower& g) { return g.primitive(kind); });
  for (int kind = 0; kind < BlobTreeGrower::kOperators; ++kind)
    for (std::uint64_t seed : {21u, 22u, 23u, 24u, 25u, 26u})
      grow("operator " + std::to_string(kind) + " seed " + std::to_string(seed), seed,
           [&](BlobTreeGrower& g) { return g.op(kind, 1); });
  for (std::uint64_t seed = 100; seed < 400; ++seed)
    cases.push_back({"nest, seed " + std::to_string(seed), random_blobtree(seed, 2 + static_cast<int>(seed % 3))});
  add_flares(cases);
  return cases;
}

}  // namespace

const std::vector<ConformanceCase>& conformance_cases() {
  static const std::vector<ConformanceCase> cases = make_cases();
  return cases;
}

}  // namespace cambium
