// Rows of a node table (ids in any order) linked into a skeleton whose parents stand first.
#pragma once

#include "skeletons/skeleton.h"

#include <cstdint>
#include <string>
#include <vector>

namespace cambium {

struct SkeletonRow {
  std::int64_t id = 0;
  std::int64_t parent = -1;                ///< an id; negative at a root
  SkeletonNode node;                       ///< its parent member is not used
  int line = 0, id_column = 0, parent_column = 0;
};

/// For each row the index of its parent's row, -1 at a root.
/// Errors: InputError for a duplicate id, a row that is its own parent, a missing parent, a cycle, or no rows.
std::vector<std::int32_t> link_parents(const std::vector<SkeletonRow>& rows, const std::string& file);

/// Row indices in an order in which parents stand before children: the order given if it already is one, else depth first.
/// Cost: linear; no recursion. `parents` must be free of cycles.
std::vector<std::uint32_t> parents_first(const std::vector<std::int32_t>& parents);

/// Both, and the nodes in that order; *places: which node each row became. Errors: as link_parents.
Skeleton skeleton_from_rows(const std::vector<SkeletonRow>& rows, const std::string& file,
                            std::vector<std::int32_t>* places = nullptr);

}  // namespace cambium
