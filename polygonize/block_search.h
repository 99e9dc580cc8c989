// Finds the blocks of a lattice that a field can matter in, by pruning and bounds: cost follows the surface, not the box.
#pragma once

#include "blobtree/field.h"
#include "blobtree/run_options.h"
#include "polygonize/lattice.h"

#include <functional>

namespace cambium {

class ProgressMeter;

/// May a region be of interest whose values lie in this interval?
using IntervalTest = bool (*)(const Interval&);

inline bool holds_surface(const Interval& values) { return values.contains(kIso); }
inline bool holds_matter(const Interval& values) { return values.hi > 0; }

using BlockVisitor = std::function<void(Evaluator&, const PrunedField&, const CellPlace&)>;

/// Halves the root cube down to blocks and calls visit, from many threads and in no particular order, for every block that
/// passes the test, with a field pruned to the block's box. Runs in the current arena; a call may not wait for other tasks.
/// False if cancelled, or if stop becomes true.
bool search_blocks(const Field& field, const Lattice& lattice, IntervalTest wanted, const BlockVisitor& visit,
                   const RunOptions& run, ProgressMeter& progress, const std::atomic<bool>* stop = nullptr);

}  // namespace cambium
