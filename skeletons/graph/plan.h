// A tree as least-cost paths through a sequence of random graphs (Xu and Mould, "A procedural method for irregular tree models",
// Computers & Graphics 2012, and its conference version; names of parameters are the papers').
//
// Level 1 is a graph in a volume that is given; paths lead from its endpoints to the root. Each endpoint with lifespan left is the
// root of a smaller graph, whose endpoints are joined to it, and so on. Every subgraph draws from a random stream of its own, named by
// the way of endpoints that leads to it, so that changing a level leaves the levels before it as they were.
#pragma once

#include "blobtree/run_options.h"
#include "skeletons/graph/edge_weights.h"
#include "skeletons/graph/graph_volume.h"
#include "skeletons/graph/node_graph.h"
#include "skeletons/graph/refinement.h"
#include "skeletons/skeleton.h"

#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace cambium {

// ---- one level -------------------------------------------------------------------------------------------------

/// Which way a subgraph points: v_g (section 3.3.2).
enum class GraphOrientation {
  kOutward,                          ///< from the root of the graph before to this one's
  kVertical,                         ///< up; with a turn of pi downwards, down
  kRandom,
};

/// A turn of v_g, the same at every subgraph of a level (figure 16).
struct GraphTurn {
  double angle = 0;                  ///< radians; about the horizontal it lifts for > 0 and lowers for < 0, not beyond the vertical
  std::optional<Vec3> axis;          ///< unset: the horizontal across v_g
};

/// Where endpoints are.
enum class EndpointPlacement {
  kUniform,                          ///< anywhere among the nodes
  kShell,                            ///< among nodes not deeper than `shell` below the volume's surface (figure 10)
  kTaproot,                          ///< around the path from one deep endpoint, not farther from it than `shell` (figure 24)
};

struct GraphLevel {
  // The graph
  std::size_t nodes = 300;           ///< k of each graph; 1: the root alone
  std::optional<double> spacing;     ///< d, metres: the least distance between nodes; unset: so that k nodes fill the volume
  // Its volume, from level 2 on
  double alpha = 0.3 * std::numbers::pi;   ///< radians, (0, pi]: the volume is the part of a ball that is within alpha of v_g
  std::optional<double> radius;      ///< r, metres; unset: a times that of the level before; level 1 counts half the mean way, as the
                                     ///< crow flies, from the root to its endpoints
  double shrink = 0.7;               ///< a, > 0
  std::vector<PlacedSolid> shape;    ///< in place of the ball's part: in units of r, z along v_g, its root in the origin
  GraphOrientation orientation = GraphOrientation::kOutward;
  GraphTurn turn;
  bool around_all = false;           ///< subgraphs around the endpoints of all levels before, not just of the last
  // Its endpoints
  std::array<int, 2> endpoints = {10, 10};   ///< b: least and most, drawn for each subgraph
  EndpointPlacement placement = EndpointPlacement::kUniform;
  double shell = 0;                  ///< d_e, metres; of a subgraph in units of r
  std::vector<Vec3> given_endpoints; ///< level 1 only: besides those drawn
  // Its wood
  double zeta = 0.3;                 ///< tapering: w = s^zeta, > 0
};

// ---- lifespan (section 3.3.3) ----------------------------------------------------------------------------------

/// One outcome of a draw, and by how much it lowers the lifespan.
struct LifespanOutcome {
  double probability = 1;            ///< relative to the others'
  double low = 1, high = 1;          ///< drawn evenly between
  bool relative = false;             ///< times the lifespan there is; 1 ends the branch
};

struct Lifespan {
  std::optional<double> initial = {};   ///< L of level 1's endpoints; unset: as many levels as are listed
  std::vector<LifespanOutcome> outcomes = {LifespanOutcome{}};
  bool sizes = false;                ///< subgraphs shrink with the lifespan left: r times L of its root over the initial L

  /// 30 in 100 end, the others lose an even part of what they have.
  static std::vector<LifespanOutcome> thirty_seventy() { return {{0.3, 1, 1, true}, {0.7, 0, 1, true}}; }
};

// ---- surroundings (section 3.4) --------------------------------------------------------------------------------

/// Subgraphs of a level are ranked by the angle between v_g and the light: the draws of endpoint counts and of lifespan decrements are
/// dealt out in that order, best to who sees most.
struct GraphLight {
  Vec3 direction{0, 0, 1};           ///< to the light
  bool on_endpoints = true;
  bool on_lifespan = true;
};

/// v_g is drawn towards where the wind blows.
struct GraphWind {
  Vec3 direction{1, 0, 0};
  double strength = 0;               ///< v_g + strength * direction, made unit again
};

// ---- wood ------------------------------------------------------------------------------------------------------

enum class ThicknessRule {
  kPath,                             ///< w = s^zeta, s being the way to the farthest endpoint beyond; the largest over levels
  kPipe,                             ///< r^e = sum of the children's r^e (Shinozaki's pipe model, Murray's and da Vinci's exponents)
};

struct GraphThickness {
  ThicknessRule rule = ThicknessRule::kPath;
  double trunk_radius = 0.1;         ///< metres, at the root; every other is scaled along
  double tip_radius = 0.001;         ///< metres, at least; kPipe: of every tip
  std::optional<double> exponent = {};   ///< e of kPipe; unset: such that tips of tip_radius make a trunk of trunk_radius
  std::optional<double> unit = {};     ///< metres, what s is counted in; unset: a thousandth of the longest way
  bool every_level = true;           ///< endpoints of every level count with their level's zeta, not only of the last
};

// ---- all of it -------------------------------------------------------------------------------------------------

struct GraphOptions {
  Vec3 root{0.0};                    ///< metres; in the first volume or on its surface
  std::vector<PlacedSolid> volume;   ///< of level 1, at least one solid
  std::optional<GraphRefinement> refinement;
  std::vector<GraphLevel> levels;    ///< at least one; with more lifespan than levels the last goes on
  EdgeOptions edges;
  double weight_low = 0, weight_high = 1;      ///< EdgeWeights
  bool weight_times_length = false;
  std::shared_ptr<const WeightPaint> paint;
  std::shared_ptr<const Obstacles> obstacles;
  Lifespan lifespan;
  std::optional<GraphLight> light;
  std::optional<GraphWind> wind;
  GraphThickness thickness;
  int smoothing = 3;                 ///< passes over the paths that take out zigzag; the root and all endpoints stay; 0: none
  /// Below the ground: planned by the same rules from the same root, thickness.trunk_radius its own; not more than one, without roots.
  std::vector<GraphOptions> roots;
  bool with_roots = true;            ///< unset: they are left out of the skeleton
  std::uint64_t seed = 0;
};

/// What happened on the way. Counts.
struct GraphReport {
  struct Level {
    std::size_t graphs = 0, nodes = 0, edges = 0, endpoints = 0;
  };
  std::vector<Level> levels;
  std::size_t nodes = 0, edges = 0, endpoints = 0;   ///< in all, roots included
  std::size_t repaired = 0;          ///< edges added because a graph was not connected
  std::size_t short_of_nodes = 0;    ///< graphs that had room for fewer nodes than wanted
  std::size_t short_of_endpoints = 0;  ///< subgraphs that had room for fewer endpoints than drawn
  std::vector<std::string> notes;    ///< one sentence each
};

struct GraphPlan {
  Skeleton skeleton;                 ///< one tree (roots' nodes last); node 0 is the root
  std::size_t below_ground = 0;      ///< that many of the last nodes are of the roots
  std::vector<std::uint32_t> endpoints;        ///< nodes of the skeleton, those of the first level first
  std::vector<std::uint8_t> endpoint_levels;   ///< of each: 1, 2, ...
  GraphReport report;
};

/// Deterministic for a seed at any thread count. nullopt if cancelled. Cost: linear in the nodes of all graphs; about 100 bytes each for
/// the largest graph, 60 for each node on a path.
/// Errors: InputError (no location) that names the setting by its key in a recipe, `level 2: alpha` for one of a level.
std::optional<GraphPlan> plan_tree(const GraphOptions& options, const RunOptions& run = {});

}  // namespace cambium
