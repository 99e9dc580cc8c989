// A generated tree taken from its skeleton to a field, with what each step cost.
#pragma once

#include "bench/surface_places.h"
#include "blobtree/blobtree.h"
#include "blobtree/field.h"
#include "skeletons/skeleton.h"

#include <string>
#include <vector>

namespace cambium::bench {

struct TreeCase {
  std::string name;
  Skeleton skeleton;
  BlobTree tree;
  Field field;
  std::vector<SurfacePlace> places;    ///< where its cells are pruned
  double surface_seconds = 0, compile_seconds = 0;
  double mean_active = 0;              ///< primitives in a cell

  double internodes() const { return static_cast<double>(skeleton.nodes.size() - 1); }
};

TreeCase make_tree_case(std::string name, Skeleton skeleton, std::size_t places);

}  // namespace cambium::bench
