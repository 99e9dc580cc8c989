#include "skeletons/skeleton_rows.h"

#include "blobtree/input_error.h"

#include <limits>
#include <numeric>
#include <unordered_map>

namespace cambium {
namespace {

/// A row on a cycle, or -1. Every walk towards the root stops at rows already known, so the cost is linear.
std::int64_t find_cycle(const std::vector<std::int32_t>& parents) {
  enum : std::uint8_t { kNew, kOnWalk, kDone };
  std::vector<std::uint8_t> state(parents.size(), kNew);
  for (std::size_t start = 0; start < parents.size(); ++start) {
    std::int64_t i = static_cast<std::int64_t>(start);
    while (i >= 0 && state[i] == kNew) {
      state[i] = kOnWalk;
      i = parents[i];
    }
    if (i >= 0 && state[i] == kOnWalk) return i;
    for (i = static_cast<std::int64_t>(start); i >= 0 && state[i] == kOnWalk; i = parents[i]) state[i] = kDone;
  }
  return -1;
}

}  // namespace

std::vector<std::int32_t> link_parents(const std::vector<SkeletonRow>& rows, const std::string& file) {
  if (rows.empty()) throw InputError({file, 0, 0}, "no nodes", "at least one");
  if (rows.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError({file, 0, 0}, std::to_string(rows.size()) + " nodes", "at most 2147483647");
  std::unordered_map<std::int64_t, std::int32_t> index;
  index.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto [known, added] = index.emplace(rows[i].id, static_cast<std::int32_t>(i));
    if (!added)
      throw InputError({file, rows[i].line, rows[i].id_column}, "id " + std::to_string(rows[i].id) + " a second time",
                       "ids that differ (first used in line " + std::to_string(rows[known->second].line) + ")");
  }
  std::vector<std::int32_t> parents(rows.size(), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SkeletonRow& row = rows[i];
    if (row.parent < 0) continue;
    const auto parent = index.find(row.parent);
    if (parent == index.end())
      throw InputError({file, row.line, row.parent_column}, "parent " + std::to_string(row.parent) + ", which is not there",
                       "the id of a node, or -1 at a root");
    if (parent->second == static_cast<std::int32_t>(i))
      throw InputError({file, row.line, row.parent_column}, "node " + std::to_string(row.id) + " as its own parent",
                       "the id of another node, or -1 at a root");
    parents[i] = parent->second;
  }
  if (const std::int64_t i = find_cycle(parents); i >= 0)
    throw InputError({file, rows[i].line, rows[i].parent_column},
                     "a cycle through node " + std::to_string(rows[i].id), "parents that lead to a root");
  return parents;
}

std::vector<std::uint32_t> parents_first(const std::vector<std::int32_t>& parents) {
  const std::size_t count = parents.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  bool ordered = true;
  for (std::size_t i = 0; i < count && ordered; ++i) ordered = parents[i] < static_cast<std::int32_t>(i);
  if (ordered) return order;

  // Children of each row as a linked list; filled from the back so that it runs in file order.
  std::vector<std::int32_t> first_child(count, -1), next_sibling(count, -1), stack;
  for (std::size_t i = count; i-- > 0;) {
    if (parents[i] < 0) continue;
    next_sibling[i] = first_child[parents[i]];
    first_child[parents[i]] = static_cast<std::int32_t>(i);
  }
  order.clear();
  for (std::size_t root = 0; root < count; ++root) {
    if (parents[root] >= 0) continue;
    stack.push_back(static_cast<std::int32_t>(root));
    while (!stack.empty()) {
      const std::int32_t i = stack.back();
      stack.pop_back();
      order.push_back(static_cast<std::uint32_t>(i));
      if (next_sibling[i] >= 0) stack.push_back(next_sibling[i]);
      if (first_child[i] >= 0) stack.push_back(first_child[i]);
    }
  }
  return order;
}

Skeleton skeleton_from_rows(const std::vector<SkeletonRow>& rows, const std::string& file, std::vector<std::int32_t>* places) {
  const std::vector<std::int32_t> parents = link_parents(rows, file);
  const std::vector<std::uint32_t> order = parents_first(parents);
  std::vector<std::int32_t> place(rows.size(), -1);
  Skeleton skeleton;
  skeleton.nodes.reserve(rows.size());
  for (const std::uint32_t i : order) {
    place[i] = static_cast<std::int32_t>(skeleton.nodes.size());
    SkeletonNode node = rows[i].node;
    node.parent = parents[i] < 0 ? -1 : place[parents[i]];
    skeleton.nodes.push_back(std::move(node));
  }
  if (places) *places = std::move(place);
  return skeleton;
}

}  // namespace cambium
