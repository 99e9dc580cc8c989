// A generated tree taken from its skeleton to a field, with what each step cost.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bench/cover_timings.h"
#include "bench/surface_places.h"
#include "blobtree/blobtree.h"
#include "blobtree/field.h"
#include "skeletons/skeleton.h"

namespace cambium::bench {

struct TreeCase {
  std::string name;
  Skeleton skeleton;
  BlobTree tree;
  Field field;
  CoverTimings cover;                ///< one with two threads is already timed
  std::vector<SurfacePlace> places;  ///< where its cells are pruned
  double surface_seconds = 0, compile_seconds = 0;
  double processor_seconds = 0;  ///< of both, by the thread that was busiest; 0 where that is not known
  std::size_t peak_bytes = 0;  ///< resident at most from the skeleton to a cover with two threads, skeleton and all counted
  double mean_active = 0;      ///< primitives in a cell

  double internodes() const { return static_cast<double>(skeleton.nodes.size() - 1); }
};

/// The skeleton is made here, so that its memory counts too.
TreeCase make_tree_case(std::string name, const std::function<Skeleton()>& make_skeleton, std::size_t places);

}  // namespace cambium::bench
