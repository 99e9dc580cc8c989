// Loops over many nodes, on as many threads as wanted; over few, without any of the cost of threads.
#pragma once

#include "blobtree/run_options.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace cambium {

/// Runs work with as many threads as wanted; in the arena that it is called in where that has as many.
template <class Work>
void with_threads(const RunOptions& run, const Work& work) {
  if (run.threads <= 0 || run.threads == tbb::this_task_arena::max_concurrency()) return work();
  tbb::task_arena arena(run.threads);
  arena.execute(work);
}

/// Calls body(begin, end) for chunks of `grain` of the numbers below n, in any order; chunks must not depend on each other. What is
/// one chunk runs on the calling thread. False if cancelled: then some were left out.
template <class Body>
bool in_node_chunks(std::size_t n, std::size_t grain, const RunOptions& run, const Body& body) {
  const auto chunk = [&](std::size_t begin) {
    if (!run.cancelled()) body(begin, std::min(n, begin + grain));
  };
  if (n <= grain || run.threads == 1) {
    for (std::size_t begin = 0; begin < n; begin += grain) chunk(begin);
  } else {
    with_threads(run, [&] { tbb::parallel_for(std::size_t{0}, (n + grain - 1) / grain, [&](std::size_t i) { chunk(i * grain); }); });
  }
  return !run.cancelled();
}

}  // namespace cambium
