// One graph of a plan: its nodes, its endpoints, and the least-cost paths between those and its root (Xu and Mould 2012, section 3.1).
#pragma once

#include "skeletons/graph/plan.h"

#include <span>

namespace cambium {

/// What all graphs of a plan have in common.
struct GraphRules {
  EdgeOptions edges;
  EdgeWeights weights;
};

/// What one graph has of its own.
struct GraphTask {
  const GraphVolume* volume = nullptr;
  Vec3 root{0.0};
  const GraphLevel* level = nullptr;
  int endpoints = 0;                 ///< to draw, besides those given
  double shell = 0;                  ///< metres
  std::uint64_t stream = 0;
};

struct GraphPaths {
  std::vector<Vec3> positions;           ///< of the nodes on paths; the root first, parents before children
  std::vector<std::uint32_t> parents;    ///< of each; the root's is itself
  std::vector<std::uint32_t> endpoints;  ///< indices into positions, each once: those given, then those drawn
  std::size_t nodes = 0, edges = 0, repaired = 0;   ///< of the graph
  std::size_t endpoints_missing = 0;     ///< that had no node left to be at
};

/// nullopt if cancelled. Errors: as poisson_disc.
std::optional<GraphPaths> plan_graph(const GraphTask& task, const GraphRules& rules, const RunOptions& run);

}  // namespace cambium
