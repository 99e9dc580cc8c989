#include "polygonize/contour_refiner.h"

#include "polygonize/hermite.h"
#include "polygonize/patch_vertices.h"

#include <tbb/blocked_range.h>

#include <algorithm>
#include <numeric>

namespace cambium {
namespace {

constexpr std::size_t kGrain = 256;

template <class Body>
void for_each_below(std::size_t n, Body&& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) body(i);
  });
}

/// Grows a list by the numbers from its owner's old size to its new one.
void append_numbers(std::vector<std::uint32_t>& list, std::size_t from, std::size_t to) {
  const std::size_t before = list.size();
  list.resize(before + to - from);
  std::iota(list.begin() + static_cast<std::ptrdiff_t>(before), list.end(), static_cast<std::uint32_t>(from));
}

}  // namespace

std::optional<ContourRefiner> ContourRefiner::begin(SurfaceOctree tree, const SurfaceCover& cover, const RunOptions& run) {
  ContourRefiner refiner(std::move(tree), cover);
  if (!refiner.add_leaves(0, run)) return std::nullopt;
  return refiner;
}

bool ContourRefiner::fill(const RunOptions& run) {
  const std::size_t first_new = tree_.leaves().size();
  return tree_.fill(*cover_, run) && add_leaves(first_new, run);
}

// What was nothing had no edges, so that all edges are new that any of the leaves from `first_new` on touches.
bool ContourRefiner::add_leaves(std::size_t first_new, const RunOptions& run) {
  auto found = crossed_minimal_edges(tree_, run);
  if (!found) return false;
  if (first_new > 0) {
    std::erase_if(found->edges, [&](const MinimalEdge& edge) {
      return std::all_of(edge.leaves.begin(), edge.leaves.end(), [&](std::uint32_t leaf) { return leaf < first_new; });
    });
  }
  resize_by_leaf();
  const std::size_t first_added = contour_.edges.size();
  add_edges(std::move(found->edges));
  std::vector<std::uint32_t> to_split = trace(first_added);
  to_split.insert(to_split.end(), found->to_split.begin(), found->to_split.end());
  return !run.cancelled() && split(std::move(to_split), run);
}

// What is kept by leaf is let go of by compact(). Patches of one leaf follow each other.
void ContourRefiner::resize_by_leaf() {
  if (patches_of_leaf_.empty()) {
    patches_of_leaf_.resize(tree_.leaves().size(), {0, 0});
    for (std::uint32_t p = 0; p < contour_.patches.size(); ++p) {
      auto& [first, count] = patches_of_leaf_[contour_.patches[p].leaf];
      if (count++ == 0) first = p;
    }
  }
  patches_of_leaf_.resize(tree_.leaves().size(), {0, 0});
  touched_.resize(tree_.leaves().size());
}

bool ContourRefiner::split(std::vector<std::uint32_t> leaves, const RunOptions& run) {
  while (!leaves.empty()) {
    const std::size_t first_new = tree_.leaves().size();
    const std::vector<std::uint32_t> cut = tree_.split(*cover_, std::move(leaves), run);
    if (run.cancelled()) return false;
    leaves = update(cut, first_new);
  }
  return !run.cancelled();
}

void ContourRefiner::retire(std::uint32_t leaf) {
  auto& [first, count] = patches_of_leaf_[leaf];
  for (std::uint32_t p = first; p < first + count; ++p) contour_.patches[p].leaf = Patch::kDead;
  count = 0;
}

// The edges around leaves that were cut are gone; what comes in their place are edges of the new leaves, and edges of old ones
// that now lie beside new leaves. Leaves that any of these touch are traced again.
std::vector<std::uint32_t> ContourRefiner::update(const std::vector<std::uint32_t>& cut, std::size_t first_new) {
  resize_by_leaf();
  const std::size_t first_added = contour_.edges.size();
  std::vector<MinimalEdge> added = take_away(cut);
  const std::vector<MinimalEdge> of_new = edges_of_new(first_new);
  added.insert(added.end(), of_new.begin(), of_new.end());
  std::vector<std::uint32_t> to_split = add_edges(std::move(added));
  const std::vector<std::uint32_t> more = trace(first_added);
  to_split.insert(to_split.end(), more.begin(), more.end());
  return to_split;
}

// The edges around leaves that were cut go. Those of other leaves among them are returned as they are now.
std::vector<MinimalEdge> ContourRefiner::take_away(const std::vector<std::uint32_t>& cut) {
  Marks is_cut(tree_.leaves().size());
  for (const std::uint32_t leaf : cut) is_cut.add(leaf);
  const auto is_first_cut = [&](const MinimalEdge& edge, std::uint32_t leaf) {   // each edge is seen to once
    return std::none_of(edge.leaves.begin(), edge.leaves.end(), [&](std::uint32_t other) { return other < leaf && is_cut.has(other); });
  };
  auto parts = in_chunks<std::vector<MinimalEdge>>(cut.size(), kGrain, [&](auto& part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto [first, count] = patches_of_leaf_[cut[i]];
      for (std::uint32_t p = first; p < first + count; ++p) {
        for (const std::uint32_t e : contour_.ring(p)) {
          const MinimalEdge& was = contour_.edges[e];
          if (!is_first_cut(was, cut[i])) continue;
          contour_.edge_alive[e] = 0;
          for (const std::uint32_t leaf : was.leaves)
            if (!is_cut.has(leaf)) touched_.add(leaf);
          if (is_cut.has(was.owner())) continue;
          const auto now = minimal_edge_of(tree_, was.owner(), was.edge_of_owner());
          if (now && now->owner() == was.owner()) part.push_back(*now);   // else it is a new leaf's
        }
      }
    }
  });
  for_each_below(cut.size(), [&](std::size_t i) { retire(cut[i]); });
  std::vector<MinimalEdge> moved;
  append_parts(parts, moved);
  return moved;
}

std::vector<MinimalEdge> ContourRefiner::edges_of_new(std::size_t first_new) const {
  const std::vector<OctreeLeaf>& leaves = tree_.leaves();
  auto parts = in_chunks<std::vector<MinimalEdge>>(leaves.size() - first_new, kGrain, [&](auto& part, std::size_t begin, std::size_t end) {
    for (std::size_t i = first_new + begin; i < first_new + end; ++i) {
      if (leaves[i].uniform()) continue;
      const auto leaf = static_cast<std::uint32_t>(i);
      if (tree_.find(leaves[i].place) != leaf) continue;   // cut again while it was made
      for (int e = 0; e < 12; ++e) {
        const auto now = minimal_edge_of(tree_, leaf, e);
        if (now && now->owner() == leaf) part.push_back(*now);
      }
    }
  });
  std::vector<MinimalEdge> all;
  append_parts(parts, all);
  return all;
}

// Returns leaves that cannot stay as they are beside them.
std::vector<std::uint32_t> ContourRefiner::add_edges(std::vector<MinimalEdge> added) {
  const std::size_t first = contour_.edges.size();
  if (first == 0) {
    contour_.edges = std::move(added);
  } else {
    contour_.edges.insert(contour_.edges.end(), added.begin(), added.end());
  }
  const std::size_t count = contour_.edges.size() - first;
  contour_.edge_alive.resize(contour_.edges.size(), 1);
  contour_.patch_of_quadrant.resize(contour_.edges.size(), {kNoPatch, kNoPatch, kNoPatch, kNoPatch});
  append_numbers(unplaced_edges_, first, contour_.edges.size());
  auto parts = in_chunks<std::vector<std::uint32_t>>(count, kGrain, [&](auto& part, std::size_t begin, std::size_t end) {
    for (std::size_t e = first + begin; e < first + end; ++e) {
      append_unsettled(tree_, contour_.edges[e], part);
      for (const std::uint32_t leaf : contour_.edges[e].leaves) touched_.add(leaf);
    }
  });
  std::vector<std::uint32_t> to_split;
  append_parts(parts, to_split);
  return to_split;
}

/// The living edges around leaves: those of their patches, and those added since. The leaves around the latter are all listed.
LeafEdges ContourRefiner::around_of(std::vector<std::uint32_t> leaves, std::size_t first_added) {
  LeafEdges around;
  around.leaves = std::move(leaves);
  const std::size_t count = around.leaves.size();
  place_in_list_.resize(tree_.leaves().size());
  std::vector<std::uint32_t> at(count + 1, 0);
  const auto for_old_edges = [&](std::size_t i, auto&& visit) {
    const auto [first, patches] = patches_of_leaf_[around.leaves[i]];
    for (std::uint32_t p = first; p < first + patches; ++p)
      for (const std::uint32_t e : contour_.ring(p))
        if (contour_.edge_alive[e]) visit(e);
  };
  const auto for_added_edges = [&](auto&& visit) {   // (its leaf's place, the edge)
    for_each_below(contour_.edges.size() - first_added, [&](std::size_t i) {
      for_each_leaf(contour_.edges[first_added + i],
                    [&](std::uint32_t leaf) { visit(place_in_list_[leaf], static_cast<std::uint32_t>(first_added + i)); });
    });
  };
  for_each_below(count, [&](std::size_t i) {
    place_in_list_[around.leaves[i]] = static_cast<std::uint32_t>(i);
    for_old_edges(i, [&](std::uint32_t) { ++at[i + 1]; });
  });
  for_added_edges([&](std::uint32_t i, std::uint32_t) { std::atomic_ref(at[i + 1]).fetch_add(1, std::memory_order_relaxed); });
  for (std::size_t i = 0; i < count; ++i) at[i + 1] += at[i];
  around.first = at;
  around.edges.resize(at.back());
  for_each_below(count, [&](std::size_t i) {
    for_old_edges(i, [&](std::uint32_t e) { around.edges[at[i]++] = e; });
  });
  for_added_edges([&](std::uint32_t i, std::uint32_t e) {
    around.edges[std::atomic_ref(at[i]).fetch_add(1, std::memory_order_relaxed)] = e;
  });
  for_each_below(count, [&](std::size_t i) {   // in whichever order they came
    std::sort(around.edges.begin() + around.first[i], around.edges.begin() + around.first[i + 1]);
  });
  return around;
}

// Puts new cycles in place of the old patches of what was touched. Returns leaves that must be cut.
std::vector<std::uint32_t> ContourRefiner::trace(std::size_t first_added) {
  LeafEdges around = around_of(touched_.ascending(), first_added);
  std::vector<std::uint32_t> across;
  if (first_added > 0) across = leaves_across_many_lines(tree_, contour_.edges, around);   // else all are listed
  if (!across.empty()) {
    while (!across.empty()) {
      for (const std::uint32_t leaf : across) touched_.add(leaf);
      across = leaves_across_many_lines(tree_, contour_.edges, around_of(std::move(across), contour_.edges.size()));
      std::erase_if(across, [&](std::uint32_t leaf) { return touched_.has(leaf); });
    }
    around = around_of(touched_.ascending(), first_added);
  }
  touched_.remove(around.leaves);
  LeafCycles cycles = trace_cycles(tree_, contour_.edges, around, relinked_);
  replace_patches(around, cycles);
  return std::move(cycles.to_split);
}

void ContourRefiner::replace_patches(const LeafEdges& around, const LeafCycles& cycles) {
  const std::size_t count = around.leaves.size(), patches_before = contour_.patches.size(), rings_before = contour_.rings.size();
  std::vector<std::uint32_t> first_patch(count + 1, static_cast<std::uint32_t>(patches_before));
  for (std::size_t i = 0; i < count; ++i) first_patch[i + 1] = first_patch[i] + cycles.counts[i];
  contour_.patches.resize(first_patch.back());
  contour_.rings.insert(contour_.rings.end(), cycles.edges.begin(), cycles.edges.end());
  append_numbers(unplaced_patches_, patches_before, first_patch.back());
  auto at = static_cast<std::uint32_t>(rings_before);
  for (std::size_t k = 0; k < cycles.lengths.size(); ++k) {
    contour_.patches[patches_before + k] = {Patch::kDead, at, cycles.lengths[k], cycles.open[k] != 0};
    at += cycles.lengths[k];
  }
  for_each_below(count, [&](std::size_t i) {
    const std::uint32_t leaf = around.leaves[i];
    retire(leaf);
    patches_of_leaf_[leaf] = {first_patch[i], cycles.counts[i]};
    for (std::uint32_t p = first_patch[i]; p < first_patch[i + 1]; ++p) {
      contour_.patches[p].leaf = leaf;
      for (const std::uint32_t e : contour_.ring(p)) {
        for (int q = 0; q < 4; ++q) {
          if (contour_.edges[e].leaves[q] == leaf) contour_.patch_of_quadrant[e][q] = p;
        }
      }
    }
  });
}

std::size_t ContourRefiner::relinked_faces() const {
  return static_cast<std::size_t>(std::count_if(relinked_.begin(), relinked_.end(), [&](const auto& face) { return is_alive(face.second); }));
}

bool ContourRefiner::is_alive(const std::vector<std::array<std::uint32_t, 2>>& lines) const {
  return std::all_of(lines.begin(), lines.end(),
                     [&](const auto& line) { return contour_.edge_alive[line[0]] && contour_.edge_alive[line[1]]; });
}

void ContourRefiner::compact(const Living& living) {
  patches_of_leaf_ = {};
  touched_ = Marks();
  place_in_list_ = new_patches_ = {};
  const std::vector<std::uint32_t> edge_now = numbers_among(living.edges, contour_.edges.size());
  std::erase_if(relinked_, [&](const auto& face) { return !is_alive(face.second); });
  for (auto& [leaves, lines] : relinked_)
    for (auto& line : lines) line = {edge_now[line[0]], edge_now[line[1]]};
  cambium::compact(contour_, living);
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
