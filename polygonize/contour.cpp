#include "polygonize/contour.h"

#include "polygonize/cube_edges.h"
#include "polygonize/hermite.h"
#include "polygonize/patch_vertices.h"

#include <algorithm>

namespace cambium {
namespace {

template <class T>
void sort_unique(std::vector<T>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

/// The patch on the other side of the face that two edges of a patch bound.
std::uint32_t patch_across(const Contour& contour, const CreaseExit& exit) {
  const auto& a = contour.patch_of_quadrant[exit.edge];
  const auto& b = contour.patch_of_quadrant[exit.next_edge];
  const auto beside = [&](const std::array<std::uint32_t, 4>& around, int k) {
    return around[kRing[(k + 1) % 4]] == exit.patch || around[kRing[(k + 3) % 4]] == exit.patch;
  };
  for (int k = 0; k < 4; ++k) {
    const std::uint32_t other = a[kRing[k]];
    if (other == exit.patch || !beside(a, k)) continue;
    for (int j = 0; j < 4; ++j) {
      if (b[kRing[j]] == other && beside(b, j)) return other;
    }
  }
  return kNoPatch;
}

LeafEdges grouped(std::vector<LeafEdge>& pairs) {
  sort_unique(pairs);
  LeafEdges around;
  for (const LeafEdge& pair : pairs) {
    if (around.leaves.empty() || around.leaves.back() != pair.leaf) {
      around.leaves.push_back(pair.leaf);
      around.first.push_back(around.first.back());
    }
    around.edges.push_back(pair.edge);
    ++around.first.back();
  }
  return around;
}

}  // namespace

Vec3 edge_point(const SurfaceOctree& tree, const MinimalEdge& edge, double t) {
  const OctreeLeaf& owner = tree.leaves()[edge.owner()];
  const int corner = edge_low_corner(edge.edge_of_owner());
  CellPlace place = owner.place;
  for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(corner >> a & 1) << owner.level;
  Vec3 p = tree.point(place);
  if (t > 0) {
    place[edge.axis] += 1u << owner.level;
    p[edge.axis] += t * (tree.point(place)[edge.axis] - p[edge.axis]);
  }
  return p;
}

std::vector<std::array<std::uint32_t, 2>> crease_edges(const Contour& contour) {
  std::vector<std::array<std::uint32_t, 2>> creases;
  for (const CreaseExit& exit : contour.exits) {
    const std::uint32_t other = patch_across(contour, exit);
    if (other == kNoPatch || !contour.vertices[other].crease) continue;
    creases.push_back({std::min(exit.patch, other), std::max(exit.patch, other)});
  }
  sort_unique(creases);
  return creases;
}

Contour compacted(const Contour& contour) {
  Contour result;
  std::vector<std::uint32_t> edge_now(contour.edges.size(), kNoPatch), patch_now(contour.patches.size(), kNoPatch);
  for (std::size_t e = 0; e < contour.edges.size(); ++e) {
    if (!contour.edge_alive[e]) continue;
    edge_now[e] = static_cast<std::uint32_t>(result.edges.size());
    result.edges.push_back(contour.edges[e]);
    result.crossings.push_back(contour.crossings[e]);
  }
  result.edge_alive.assign(result.edges.size(), true);
  for (std::uint32_t p = 0; p < contour.patches.size(); ++p) {
    if (!contour.patches[p].alive()) continue;
    patch_now[p] = static_cast<std::uint32_t>(result.patches.size());
    Patch patch = contour.patches[p];
    patch.first_edge = static_cast<std::uint32_t>(result.rings.size());
    for (const std::uint32_t e : contour.ring(p)) result.rings.push_back(edge_now[e]);
    result.patches.push_back(patch);
    result.vertices.push_back(contour.vertices[p]);
  }
  result.patch_of_quadrant.reserve(result.edges.size());
  for (std::size_t e = 0; e < contour.edges.size(); ++e) {
    if (!contour.edge_alive[e]) continue;
    std::array<std::uint32_t, 4> patches;
    for (int q = 0; q < 4; ++q) patches[q] = patch_now[contour.patch_of_quadrant[e][q]];
    result.patch_of_quadrant.push_back(patches);
  }
  for (const CreaseExit& exit : contour.exits) {
    if (contour.patches[exit.patch].alive()) result.exits.push_back({patch_now[exit.patch], edge_now[exit.edge], edge_now[exit.next_edge]});
  }
  std::sort(result.exits.begin(), result.exits.end());
  return result;
}

std::optional<ContourRefiner> ContourRefiner::begin(SurfaceOctree tree, const SurfaceCover& cover, const RunOptions& run) {
  ContourRefiner refiner(std::move(tree), cover);
  auto found = crossed_minimal_edges(refiner.tree_, run);
  if (!found) return std::nullopt;
  Contour& contour = refiner.contour_;
  contour.edges = std::move(found->edges);
  contour.edge_alive.assign(contour.edges.size(), true);
  contour.patch_of_quadrant.assign(contour.edges.size(), {kNoPatch, kNoPatch, kNoPatch, kNoPatch});
  refiner.unplaced_edges_.resize(contour.edges.size());
  for (std::uint32_t e = 0; e < contour.edges.size(); ++e) refiner.unplaced_edges_[e] = e;
  refiner.patches_of_leaf_.assign(refiner.tree_.leaves().size(), {0, 0});
  const LeafEdges around = edges_around_leaves(refiner.tree_.leaves().size(), contour.edges);
  LeafCycles cycles = trace_cycles(refiner.tree_, contour.edges, around, refiner.relinked_);
  refiner.replace_patches(around, cycles);
  std::vector<std::uint32_t> to_split = std::move(cycles.to_split);
  to_split.insert(to_split.end(), found->to_split.begin(), found->to_split.end());
  if (run.cancelled() || !refiner.split(std::move(to_split), run)) return std::nullopt;
  return refiner;
}

bool ContourRefiner::split(std::vector<std::uint32_t> leaves, const RunOptions& run) {
  while (!leaves.empty()) {
    const std::size_t first_new = tree_.leaves().size();
    const std::vector<std::uint32_t> cut = tree_.split(*cover_, std::move(leaves), run);
    if (run.cancelled()) return false;
    leaves = update(cut, first_new);
    sort_unique(leaves);
  }
  return !run.cancelled();
}

void ContourRefiner::append_edge(const MinimalEdge& edge, std::vector<std::uint32_t>& added) {
  const auto id = static_cast<std::uint32_t>(contour_.edges.size());
  contour_.edges.push_back(edge);
  contour_.edge_alive.push_back(true);
  contour_.patch_of_quadrant.push_back({kNoPatch, kNoPatch, kNoPatch, kNoPatch});
  added.push_back(id);
  unplaced_edges_.push_back(id);
}

void ContourRefiner::retire(std::uint32_t leaf) {
  auto& [first, count] = patches_of_leaf_[leaf];
  for (std::uint32_t p = first; p < first + count; ++p) contour_.patches[p].leaf = Patch::kDead;
  count = 0;
}

// The edges around leaves that were cut are gone; what comes in their place are edges of the new leaves, and edges of old ones
// that now lie beside new leaves. Leaves that any of these touch are traced again.
std::vector<std::uint32_t> ContourRefiner::update(const std::vector<std::uint32_t>& cut, std::size_t first_new) {
  const std::size_t leaf_count = tree_.leaves().size();
  patches_of_leaf_.resize(leaf_count, {0, 0});
  std::vector<bool> is_cut(leaf_count, false);
  for (const std::uint32_t leaf : cut) is_cut[leaf] = true;
  std::vector<std::uint32_t> gone, added, touched, to_split;
  for (const std::uint32_t leaf : cut) {
    const auto [first, count] = patches_of_leaf_[leaf];
    for (std::uint32_t p = first; p < first + count; ++p) gone.insert(gone.end(), contour_.ring(p).begin(), contour_.ring(p).end());
    retire(leaf);
  }
  sort_unique(gone);
  for (const std::uint32_t e : gone) {
    const MinimalEdge was = contour_.edges[e];
    contour_.edge_alive[e] = false;
    for (const std::uint32_t leaf : was.leaves)
      if (!is_cut[leaf]) touched.push_back(leaf);
    if (is_cut[was.owner()]) continue;
    const auto now = minimal_edge_of(tree_, was.owner(), was.edge_of_owner());
    if (now && now->owner() == was.owner()) append_edge(*now, added);   // else it is a new leaf's
  }
  for (std::size_t leaf = first_new; leaf < leaf_count; ++leaf) {
    const std::uint8_t mask = tree_.leaves()[leaf].mask;
    if (mask == 0 || mask == 255) continue;
    const auto id = static_cast<std::uint32_t>(leaf);
    if (tree_.find(tree_.leaves()[leaf].place) != id) continue;   // cut again while it was made
    for (int e = 0; e < 12; ++e) {
      const auto now = minimal_edge_of(tree_, id, e);
      if (now && now->owner() == id) append_edge(*now, added);
    }
  }
  for (const std::uint32_t e : added) {
    append_unsettled(tree_, contour_.edges[e], to_split);
    for (const std::uint32_t leaf : contour_.edges[e].leaves) touched.push_back(leaf);
  }
  sort_unique(touched);
  std::vector<LeafEdge> around = around_of(touched);
  for (const std::uint32_t e : added)
    for (const std::uint32_t leaf : contour_.edges[e].leaves) around.push_back({leaf, e});
  for (const std::uint32_t leaf : touched) retire(leaf);
  const auto more = trace(std::move(around));
  to_split.insert(to_split.end(), more.begin(), more.end());
  return to_split;
}

/// The living edges around the leaves listed: those of their patches, and of those just added.
std::vector<LeafEdge> ContourRefiner::around_of(const std::vector<std::uint32_t>& leaves) const {
  std::vector<LeafEdge> around;
  for (const std::uint32_t leaf : leaves) {
    const auto [first, count] = patches_of_leaf_[leaf];
    for (std::uint32_t p = first; p < first + count; ++p)
      for (const std::uint32_t e : contour_.ring(p))
        if (contour_.edge_alive[e]) around.push_back({leaf, e});
  }
  return around;
}

// Puts the cycles of the leaves in place of their old patches. Returns leaves that must be cut.
std::vector<std::uint32_t> ContourRefiner::trace(std::vector<LeafEdge> pairs) {
  LeafEdges around = grouped(pairs);
  std::vector<std::uint32_t> across = leaves_across_many_lines(tree_, contour_.edges, around);
  if (!across.empty()) {
    std::vector<bool> listed(tree_.leaves().size(), false);
    for (const std::uint32_t leaf : around.leaves) listed[leaf] = true;
    while (!across.empty()) {
      for (const std::uint32_t leaf : across) listed[leaf] = true;
      std::vector<LeafEdge> more = around_of(across);
      pairs.insert(pairs.end(), more.begin(), more.end());
      across = leaves_across_many_lines(tree_, contour_.edges, grouped(more));
      std::erase_if(across, [&](std::uint32_t leaf) { return listed[leaf]; });
    }
    around = grouped(pairs);
  }
  LeafCycles cycles = trace_cycles(tree_, contour_.edges, around, relinked_);
  replace_patches(around, cycles);
  return std::move(cycles.to_split);
}

void ContourRefiner::replace_patches(const LeafEdges& around, const LeafCycles& cycles) {
  const std::uint32_t *length = cycles.lengths.data(), *edge = cycles.edges.data();
  for (std::size_t i = 0; i < around.leaves.size(); ++i) {
    const std::uint32_t leaf = around.leaves[i];
    retire(leaf);
    patches_of_leaf_[leaf] = {static_cast<std::uint32_t>(contour_.patches.size()), cycles.counts[i]};
    for (std::uint32_t k = 0; k < cycles.counts[i]; ++k, ++length) {
      const auto patch = static_cast<std::uint32_t>(contour_.patches.size());
      contour_.patches.push_back({leaf, static_cast<std::uint32_t>(contour_.rings.size()), *length});
      unplaced_patches_.push_back(patch);
      for (std::uint32_t j = 0; j < *length; ++j, ++edge) {
        contour_.rings.push_back(*edge);
        for (int q = 0; q < 4; ++q) {
          if (contour_.edges[*edge].leaves[q] == leaf) contour_.patch_of_quadrant[*edge][q] = patch;
        }
      }
    }
  }
}

std::size_t ContourRefiner::relinked_faces() const {
  return static_cast<std::size_t>(std::count_if(relinked_.begin(), relinked_.end(), [&](const auto& face) {
    return std::all_of(face.second.begin(), face.second.end(),
                       [&](const auto& line) { return contour_.edge_alive[line[0]] && contour_.edge_alive[line[1]]; });
  }));
}

bool ContourRefiner::place(const RunOptions& run) {
  std::erase_if(unplaced_edges_, [&](std::uint32_t e) { return !contour_.edge_alive[e]; });
  std::erase_if(unplaced_patches_, [&](std::uint32_t p) { return !contour_.patches[p].alive(); });
  contour_.crossings.resize(contour_.edges.size());
  contour_.vertices.resize(contour_.patches.size());
  if (!find_crossings(tree_, *cover_, unplaced_edges_, contour_, run)) return false;
  if (!place_vertices(tree_, *cover_, unplaced_patches_, contour_, run)) return false;
  new_patches_ = std::move(unplaced_patches_);
  unplaced_edges_ = unplaced_patches_ = {};
  return true;
}

}  // namespace cambium
