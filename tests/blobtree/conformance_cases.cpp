#include "conformance_cases.h"

namespace cambium {
namespace {

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
  return cases;
}

}  // namespace

const std::vector<ConformanceCase>& conformance_cases() {
  static const std::vector<ConformanceCase> cases = make_cases();
  return cases;
}

}  // namespace cambium
