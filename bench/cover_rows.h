// The rows of a table that say what a surface cover costs.
#pragma once

#include <string>

#include "bench/cover_timings.h"
#include "bench/report.h"

namespace cambium::bench {

/// The cover that a cell's time is compared with; none if null.
struct CellComparison {
  const CoverTimings* cover = nullptr;
  std::string whose;  ///< "random tree of 10^4's"
  Target target;
};

/// judge_threads: whether two threads are held to 1.8 times the speed of one. Where other programs disturb the wall clock,
/// the processor time of the busier thread is judged in its place.
void add_cover_rows(Report& report, const CoverTimings& cover, const CellComparison& comparison, bool judge_threads);

}  // namespace cambium::bench
