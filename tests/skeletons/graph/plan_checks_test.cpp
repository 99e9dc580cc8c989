#include "skeletons/graph/plan_checks.h"

#include <gtest/gtest.h>

#include <functional>

namespace cambium {
namespace {

GraphOptions legal() {
  GraphOptions options;
  options.volume = {PlacedSolid{.solid = BallSolid{1}}};
  options.levels.resize(2);
  return options;
}

TEST(PlanChecks, LetLegalSettingsThrough) { EXPECT_NO_THROW(check_plan(legal())); }

TEST(PlanChecks, NameTheSettingAtFault) {
  struct Case {
    std::string named;
    std::function<void(GraphOptions&)> spoil;
  };
  const double nan = std::nan("");
  const Case cases[] = {
      {"root", [&](auto& o) { o.root.x = nan; }},
      {"no level", [](auto& o) { o.levels.clear(); }},
      {"level 1: k", [](auto& o) { o.levels[0].nodes = 0; }},
      {"level 2: k", [](auto& o) { o.levels[1].nodes = 200'000'000; }},
      {"level 2: d", [](auto& o) { o.levels[1].spacing = 0; }},
      {"level 2: alpha", [](auto& o) { o.levels[1].alpha = 0; }},
      {"level 2: alpha", [](auto& o) { o.levels[1].alpha = 3.2; }},
      {"level 2: alpha", [&](auto& o) { o.levels[1].alpha = nan; }},
      {"level 2: r ", [](auto& o) { o.levels[1].radius = -1; }},
      {"level 2: a ", [](auto& o) { o.levels[1].shrink = 0; }},
      {"level 2: a turn", [](auto& o) { o.levels[1].turn.angle = kInfinity; }},
      {"level 2: a turn", [](auto& o) { o.levels[1].turn.axis = Vec3{0.0}; }},
      {"level 2: height", [](auto& o) { o.levels[1].shape = {PlacedSolid{.solid = CylinderSolid{1, 0}}}; }},
      {"level 1: b = ", [](auto& o) { o.levels[0].endpoints = {5, 4}; }},
      {"level 1: b = ", [](auto& o) { o.levels[0].endpoints = {-1, 4}; }},
      {"level 1: b = 0", [](auto& o) { o.levels[0].endpoints = {0, 4}; }},
      {"level 2: b = 300 endpoints", [](auto& o) { o.levels[1].endpoints = {1, 300}; }},
      {"level 2: endpoints given by hand", [](auto& o) { o.levels[1].given_endpoints = {Vec3{0.0}}; }},
      {"level 1: an endpoint", [&](auto& o) { o.levels[0].given_endpoints = {Vec3{nan}}; }},
      {"level 1: d_e", [](auto& o) { o.levels[0].placement = EndpointPlacement::kShell; }},
      {"level 2: zeta", [](auto& o) { o.levels[1].zeta = 0; }},
      {"edges: sectors", [](auto& o) { o.edges.sectors = 3; }},
      {"edges: threshold", [](auto& o) { o.edges = {EdgeRule::kThreshold, 8, 1.0}; }},
      {"weights: ", [](auto& o) { o.weight_high = 0; }},
      {"weights: ", [](auto& o) { o.weight_low = 2; }},
      {"lifespan: L", [](auto& o) { o.lifespan.initial = -2; }},
      {"light: ", [](auto& o) { o.light = GraphLight{Vec3{0.0}}; }},
      {"wind: a direction", [](auto& o) { o.wind = GraphWind{Vec3{0.0}, 1}; }},
      {"wind: strength", [](auto& o) { o.wind = GraphWind{Vec3{1.0}, -1}; }},
      {"thickness: trunk_radius", [](auto& o) { o.thickness.trunk_radius = 0; }},
      {"thickness: tip_radius", [](auto& o) { o.thickness.tip_radius = 0.2; }},
      {"thickness: exponent", [](auto& o) { o.thickness.exponent = 0; }},
      {"thickness: unit", [](auto& o) { o.thickness.unit = -1; }},
      {"smoothing", [](auto& o) { o.smoothing = -1; }},
      {"more than one system of roots", [](auto& o) { o.roots = {legal(), legal()}; }},
      {"roots: roots", [](auto& o) { o.roots = {legal()}, o.roots[0].roots = {legal()}; }},
      {"roots: level 2: alpha", [](auto& o) { o.roots = {legal()}, o.roots[0].levels[1].alpha = -1; }},
  };
  for (const Case& c : cases) {
    GraphOptions options = legal();
    c.spoil(options);
    try {
      check_plan(options);
      ADD_FAILURE() << c.named << " was let through";
    } catch (const InputError& error) {
      EXPECT_EQ(error.found().substr(0, c.named.size()), c.named);
      EXPECT_FALSE(error.expected().empty());
    }
  }
}

}  // namespace
}  // namespace cambium
