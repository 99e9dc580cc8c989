// The BlobTrees that the conformance suite runs over: every node by itself, and random nests of all of them.
#pragma once

#include "blobtree/blobtree.h"
#include "random_blobtrees.h"

#include <string>
#include <vector>

namespace cambium {

struct ConformanceCase {
  std::string name;
  BlobTree tree;
};

/// Every alternative of Node at least once, then random nests.
const std::vector<ConformanceCase>& conformance_cases();

}  // namespace cambium
