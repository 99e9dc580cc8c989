#include "skeletons/graph/plan.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>

namespace cambium {
namespace {

constexpr double kPi = std::numbers::pi;

/// A trunk and a hemisphere on it; 9 + 9 * 5 + 9 * 5 * 3 endpoints.
GraphOptions small_tree() {
  GraphOptions options;
  options.volume = {PlacedSolid{.solid = CylinderSolid{0.5, 2}, .endpoints = false},
                    PlacedSolid{.solid = BallSolid{2, kPi / 2}, .origin = {0, 0, 1.8}}};
  options.levels.resize(3);
  options.levels[0].nodes = 900;
  options.levels[0].endpoints = {9, 9};
  options.levels[1].nodes = 120;
  options.levels[1].endpoints = {5, 5};
  options.levels[2].nodes = 60;
  options.levels[2].endpoints = {3, 3};
  options.seed = 5;
  return options;
}

std::vector<Vec3> endpoints_of_level(const GraphPlan& plan, int level) {
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < plan.endpoints.size(); ++i)
    if (plan.endpoint_levels[i] == level) places.push_back(plan.skeleton.nodes[plan.endpoints[i]].position);
  return places;
}

bool same_nodes(const Skeleton& a, const Skeleton& b) {
  if (a.nodes.size() != b.nodes.size()) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    if (a.nodes[i].position != b.nodes[i].position || a.nodes[i].radius != b.nodes[i].radius || a.nodes[i].parent != b.nodes[i].parent) return false;
  return true;
}

RunOptions on_threads(int threads) {
  RunOptions run;
  run.threads = threads;
  return run;
}

std::string refusal_of(const GraphOptions& options) {
  try {
    plan_tree(options);
  } catch (const InputError& error) {
    return error.found();
  }
  return "";
}

TEST(Plan, IsOneTreeInWhichParentsStandFirst) {
  const GraphPlan plan = plan_tree(small_tree()).value();
  ASSERT_GT(plan.skeleton.nodes.size(), 200u);
  EXPECT_EQ(plan.skeleton.nodes[0].parent, -1);
  EXPECT_EQ(plan.skeleton.nodes[0].position, Vec3(0.0));
  for (std::size_t i = 1; i < plan.skeleton.nodes.size(); ++i) {
    const SkeletonNode& node = plan.skeleton.nodes[i];
    ASSERT_TRUE(0 <= node.parent && node.parent < static_cast<std::int32_t>(i));
    EXPECT_LE(node.radius, plan.skeleton.nodes[static_cast<std::size_t>(node.parent)].radius);
    EXPECT_GE(node.radius, 0.001);
  }
  EXPECT_DOUBLE_EQ(plan.skeleton.nodes[0].radius, 0.1);
}

TEST(Plan, HasTheGraphsNodesAndEndpointsAskedFor) {
  const GraphPlan plan = plan_tree(small_tree()).value();
  ASSERT_EQ(plan.report.levels.size(), 3u);
  const std::size_t graphs[] = {1, 9, 45}, nodes[] = {900, 9 * 120, 45 * 60}, endpoints[] = {9, 45, 135};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(plan.report.levels[i].graphs, graphs[i]);
    EXPECT_EQ(plan.report.levels[i].nodes, nodes[i]);
    EXPECT_EQ(plan.report.levels[i].endpoints, endpoints[i]);
    EXPECT_EQ(endpoints_of_level(plan, i + 1).size(), endpoints[i]);
  }
  EXPECT_EQ(plan.report.endpoints, 189u);
  EXPECT_EQ(plan.report.nodes, 900u + 9 * 120 + 45 * 60);
}

TEST(Plan, EndsOnlyAtEndpoints) {
  const GraphPlan plan = plan_tree(small_tree()).value();
  std::set<std::int32_t> tips;
  for (std::size_t i = 0; i < plan.skeleton.nodes.size(); ++i) tips.insert(static_cast<std::int32_t>(i));
  for (const SkeletonNode& node : plan.skeleton.nodes) tips.erase(node.parent);
  const std::set<std::int32_t> endpoints(plan.endpoints.begin(), plan.endpoints.end());
  EXPECT_GT(tips.size(), 50u);
  for (const std::int32_t tip : tips) EXPECT_TRUE(endpoints.contains(tip)) << tip;
}

TEST(Plan, PutsTheFirstEndpointsWhereTheVolumeBearsThem) {
  const GraphOptions options = small_tree();
  const GraphVolume volume(options.volume);
  for (const Vec3& p : endpoints_of_level(plan_tree(options).value(), 1)) EXPECT_TRUE(volume.bears_endpoints(p));
}

TEST(Plan, IsTheSameAtAnyThreadCountAndAnotherForAnotherSeed) {
  GraphOptions options = small_tree();
  const GraphPlan plan = plan_tree(options, on_threads(1)).value();
  for (const int threads : {2, 4}) EXPECT_TRUE(same_nodes(plan.skeleton, plan_tree(options, on_threads(threads)).value().skeleton));
  options.seed = 6;
  EXPECT_FALSE(same_nodes(plan.skeleton, plan_tree(options).value().skeleton));
}

TEST(Plan, KeepsEarlierLevelsWhereALaterOneChanges) {
  GraphOptions options = small_tree();
  const GraphPlan plan = plan_tree(options).value();
  options.levels[2].alpha = 1.2;
  options.levels[2].endpoints = {1, 6};
  options.levels[2].nodes = 77;
  const GraphPlan changed = plan_tree(options).value();
  for (const int level : {1, 2}) EXPECT_EQ(endpoints_of_level(plan, level), endpoints_of_level(changed, level));
  EXPECT_NE(endpoints_of_level(plan, 3), endpoints_of_level(changed, 3));
}

TEST(Plan, ShrinksSubgraphsByALevelAfterLevel) {
  GraphOptions options = small_tree();
  options.levels[1].radius = 0.8;
  options.levels[2].shrink = 0.25;
  const GraphPlan plan = plan_tree(options).value();
  const auto parents = endpoints_of_level(plan, 2), children = endpoints_of_level(plan, 3);
  double farthest = 0;
  for (std::size_t i = 0; i < children.size(); ++i) farthest = std::max(farthest, glm::length(children[i] - parents[i / 3]));
  EXPECT_LE(farthest, 0.2 + 1e-12);
  EXPECT_GT(farthest, 0.17);
}

TEST(Plan, StopsWhereLifeEnds) {
  GraphOptions options = small_tree();
  options.lifespan.initial = 1;
  EXPECT_EQ(plan_tree(options).value().report.levels.size(), 2u);
  options.lifespan.initial = 0;
  EXPECT_EQ(plan_tree(options).value().report.levels.size(), 1u);
  options.lifespan.initial = 4;
  EXPECT_EQ(plan_tree(options).value().report.levels.size(), 5u) << "the last level goes on";
  options.lifespan.initial = 2;
  options.lifespan.outcomes = Lifespan::thirty_seventy();
  const auto report = plan_tree(options).value().report;
  EXPECT_LT(report.levels[1].graphs, 10u);
  EXPECT_LT(report.levels[2].graphs, 45u);
}

TEST(Plan, BuildsAroundTheEndpointsOfAllLevelsBefore) {
  GraphOptions options = small_tree();
  options.levels[2].around_all = true;
  const auto report = plan_tree(options).value().report;
  EXPECT_EQ(report.levels[2].graphs, 9u + 45);
}

/// How much steeper than its level 1 the tree's level 2 rises, as the mean change of a unit way's height.
double mean_lift(GraphOptions options, double angle) {
  options.levels[1].turn.angle = angle;
  options.levels[1].alpha = 0.1 * kPi;
  const GraphPlan plan = plan_tree(options).value();
  const auto first = endpoints_of_level(plan, 1), second = endpoints_of_level(plan, 2);
  double lift = 0;
  for (std::size_t i = 0; i < second.size(); ++i)
    lift += (glm::normalize(second[i] - first[i / 5]).z - glm::normalize(first[i / 5]).z) / static_cast<double>(second.size());
  return lift;
}

TEST(Plan, TurnsBranchesUpOrDown) {
  const double straight = mean_lift(small_tree(), 0);
  EXPECT_LT(mean_lift(small_tree(), -0.4), straight - 0.1);
  EXPECT_GT(mean_lift(small_tree(), 0.4), straight + 0.03);
}

TEST(Plan, DealsMostEndpointsToTheBranchThatLooksMostIntoTheLight) {
  GraphOptions options = small_tree();
  options.levels[1].endpoints = {1, 12};
  options.levels.pop_back();
  options.light = GraphLight{{1, 0, 0}, true, false};
  const GraphPlan plan = plan_tree(options).value();
  std::map<std::uint32_t, int> counts;                     // of endpoints of level 2, by the one of level 1 that bears them
  for (std::size_t i = 0; i < plan.endpoints.size(); ++i)
    if (plan.endpoint_levels[i] == 1) counts[plan.endpoints[i]] = 0;
  const std::size_t first = counts.size();
  for (std::size_t i = first; i < plan.endpoints.size(); ++i) {
    auto node = static_cast<std::int32_t>(plan.endpoints[i]);
    while (!counts.contains(static_cast<std::uint32_t>(node))) node = plan.skeleton.nodes[static_cast<std::size_t>(node)].parent;
    ++counts[static_cast<std::uint32_t>(node)];
  }
  std::vector<std::pair<double, int>> ranked;              // by the cosine of the angle to the light
  for (const auto& [node, count] : counts) ranked.emplace_back(glm::normalize(plan.skeleton.nodes[node].position).x, count);
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t i = 1; i < ranked.size(); ++i) EXPECT_LE(ranked[i - 1].second, ranked[i].second);
  EXPECT_GT(ranked.back().second, ranked.front().second + 3);
}

TEST(Plan, LetsBranchesInTheLightLiveLongest) {
  GraphOptions options = small_tree();
  options.lifespan.outcomes = {{1, 1, 3, false}};
  options.lifespan.initial = 2;                            // so that half of the branches end after level 2
  options.light = GraphLight{{1, 0, 0}, false, true};
  const GraphPlan plan = plan_tree(options).value();
  double first = 0, last = 0;
  const auto level1 = endpoints_of_level(plan, 1), level3 = endpoints_of_level(plan, 3);
  for (const Vec3& p : level1) first += p.x / static_cast<double>(level1.size());
  for (const Vec3& p : level3) last += p.x / static_cast<double>(level3.size());
  EXPECT_GT(last, first + 0.1);
}

TEST(Plan, KeepsOutOfObstacles) {
  GraphOptions options = small_tree();
  const auto obstacles = std::make_shared<const Obstacles>(
      std::vector{PlacedSolid{.solid = BallSolid{1}, .origin = {1.2, 0, 2.8}}}, std::vector{HalfSpaceObstacle{{0, -0.6, 0}, {0, 1, 0}}});
  options.obstacles = obstacles;
  const GraphPlan plan = plan_tree(options).value();
  for (const SkeletonNode& node : plan.skeleton.nodes) EXPECT_FALSE(obstacles->holds(node.position));
}

TEST(Plan, ReachesEndpointsGivenByHand) {
  GraphOptions options = small_tree();
  options.levels[0].given_endpoints = {{1, 1, 2.5}, {-1.5, 0, 2}};
  options.levels[0].endpoints = {0, 0};
  options.lifespan.initial = 0;
  const GraphPlan plan = plan_tree(options).value();
  EXPECT_EQ(endpoints_of_level(plan, 1), options.levels[0].given_endpoints);
}

TEST(Plan, EndpointsOfATaprootStayNearIt) {
  GraphOptions options;
  options.volume = {PlacedSolid{.solid = BallSolid{2, kPi / 2}, .axis = {0, 0, -1}}};
  options.levels.resize(1);
  options.levels[0].nodes = 2000;
  options.levels[0].endpoints = {20, 20};
  options.levels[0].placement = EndpointPlacement::kTaproot;
  options.levels[0].shell = 0.4;
  options.smoothing = 0;
  const GraphPlan plan = plan_tree(options).value();
  ASSERT_EQ(plan.endpoints.size(), 21u);
  std::vector<Vec3> taproot;
  for (std::int32_t node = static_cast<std::int32_t>(plan.endpoints[0]); node >= 0; node = plan.skeleton.nodes[static_cast<std::size_t>(node)].parent)
    taproot.push_back(plan.skeleton.nodes[static_cast<std::size_t>(node)].position);
  EXPECT_LT(taproot.front().z, -1.8);
  for (std::size_t i = 1; i < plan.endpoints.size(); ++i) {
    double nearest = 9;
    for (const Vec3& p : taproot) nearest = std::min(nearest, glm::length(p - plan.skeleton.nodes[plan.endpoints[i]].position));
    EXPECT_LE(nearest, 0.4);
  }
}

TEST(Plan, JoinsRootsBelowTheTrunkIntoOneSkeleton) {
  GraphOptions options = small_tree();
  const std::size_t above = plan_tree(options).value().skeleton.nodes.size();
  GraphOptions roots;
  roots.volume = {PlacedSolid{.solid = BallSolid{1.5, kPi / 2}, .axis = {0, 0, -1}}};
  roots.levels.resize(1);
  roots.thickness.trunk_radius = 0.08;
  options.roots = {roots};
  const GraphPlan plan = plan_tree(options).value();
  EXPECT_EQ(plan.skeleton.nodes.size(), above + plan.below_ground);
  ASSERT_GT(plan.below_ground, 10u);
  for (std::size_t i = above; i < plan.skeleton.nodes.size(); ++i) {
    const SkeletonNode& node = plan.skeleton.nodes[i];
    EXPECT_LE(node.position.z, 1e-12);
    EXPECT_LE(node.radius, 0.08 + 1e-12);
    EXPECT_TRUE(node.parent == 0 || node.parent >= static_cast<std::int32_t>(above));
    EXPECT_EQ(node.lateral.value_or(false), node.parent == 0);
  }
  options.with_roots = false;
  EXPECT_EQ(plan_tree(options).value().skeleton.nodes.size(), above);
}

/// Sizes of the groups that places fall into where those nearer to each other than `gap` are of one.
std::vector<std::size_t> clusters(const std::vector<Vec3>& places, double gap) {
  std::vector<std::size_t> group(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) group[i] = i;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (glm::length(places[i] - places[j]) < gap) std::replace(group.begin(), group.end(), std::size_t{group[j]}, std::size_t{group[i]});
  std::map<std::size_t, std::size_t> sizes;
  for (const std::size_t g : group) ++sizes[g];
  std::vector<std::size_t> all;
  for (const auto& [g, size] : sizes) all.push_back(size);
  return all;
}

TEST(Plan, GivesEachSubvolumeAsManyEndpoints) {
  GraphOptions options = small_tree();
  options.refinement = GraphRefinement{2, 0.25, 0.5};
  options.levels[0].endpoints = {60, 60};
  options.levels.resize(1);
  const auto endpoints = endpoints_of_level(plan_tree(options).value(), 1);
  double widest = 0;
  for (const Vec3& a : endpoints)
    for (const Vec3& b : endpoints) widest = std::max(widest, glm::length(a - b));
  EXPECT_EQ(clusters(endpoints, 0.3 * widest), (std::vector<std::size_t>{30, 30}));
}

TEST(Plan, RefusesWhatHasNoRoomByTheKeyThatSaysSo) {
  GraphOptions options = small_tree();
  options.obstacles = std::make_shared<const Obstacles>(std::vector<PlacedSolid>{}, std::vector{HalfSpaceObstacle{{0, 0, 100}, {0, 0, 1}}});
  EXPECT_EQ(refusal_of(options).substr(0, 7), "volume:");

  options = small_tree();
  options.volume[1].solid = BallSolid{0};
  EXPECT_EQ(refusal_of(options).substr(0, 16), "volume 2: radius");

  options = small_tree();
  options.levels[0].placement = EndpointPlacement::kShell;
  options.levels[0].shell = 0.001;
  EXPECT_EQ(refusal_of(options).substr(0, 15), "level 1: b = 9 ");

  options = small_tree();
  options.root = {0, 0, -1};
  EXPECT_EQ(refusal_of(options).substr(0, 5), "root:");

  options = small_tree();
  options.levels[2].endpoints = {50, 50};
  options.lifespan.initial = 20;
  EXPECT_EQ(refusal_of(options), "level 6: 5625000 graphs of k = 60 nodes") << "at once, not when it is reached";

  options = small_tree();
  options.levels[1].nodes = 90'000'000;
  EXPECT_EQ(refusal_of(options).substr(0, 17), "level 2: 9 graphs");
}

TEST(Plan, StopsWhenCancelled) {
  const std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(plan_tree(small_tree(), run).has_value());
}

}  // namespace
}  // namespace cambium
