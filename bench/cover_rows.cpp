#include "bench/cover_rows.h"

namespace cambium::bench {
namespace {

constexpr double kSpeedUp = 1.8;

void add_thread_rows(Report& report, const CoverTimings& cover, bool judged) {
  report.add({.what = "cover, 1 thread", .figure = cover.seconds(1), .unit = "s"});
  Row both{.what = "cover, 2 threads", .figure = cover.seconds(2), .unit = "s"};
  both.ratio = cover.seconds(1) / cover.seconds(2);
  both.ratio_to = "1 thread's speed";
  const bool has_processor_time = cover.busier_thread_seconds() > 0;
  if (judged && !(cover.disturbed() && has_processor_time)) both.target = at_least(kSpeedUp);
  report.add(both);
  if (!cover.disturbed() || !has_processor_time) return;
  Row busier{.what = "cover, 2 threads, processor time of the busier", .figure = cover.busier_thread_seconds(), .unit = "s"};
  busier.ratio = cover.processor_seconds() / cover.busier_thread_seconds();
  busier.ratio_to = "1 thread's time";
  if (judged) busier.target = at_least(kSpeedUp);
  report.add(busier);
  report.note("threads had to wait for other programs, so seconds by the wall clock say little");
}

}  // namespace

void add_cover_rows(Report& report, const CoverTimings& cover, const CellComparison& comparison, bool judge_threads) {
  const double cells = static_cast<double>(cover.cells());
  report.add({.what = "surface cells", .figure = cells / 1e3, .unit = "thousand"});
  report.add({.what = "edge of a cell", .figure = cover.mean_edge(), .unit = "branch diameters"});
  report.add({.what = "primitives active in a cell", .figure = cover.mean_active(), .unit = "on average"});
  report.add(
      {.what = "cells that share one tape", .figure = cells / static_cast<double>(cover.tapes()), .unit = "on average"});
  Row cell{.what = "time per surface cell, 1 thread", .figure = cover.ns_per_cell(), .unit = "ns/cell"};
  if (comparison.cover) {
    cell.ratio = cover.ns_per_cell() / comparison.cover->ns_per_cell();
    cell.ratio_to = comparison.whose;
    cell.target = comparison.target;
  }
  report.add(cell);
  report.add({.what = "memory of the cover", .figure = static_cast<double>(cover.memory_bytes()) / cells, .unit = "B/cell"});
  add_thread_rows(report, cover, judge_threads);
  const double one = cover.batch_ns_per_point(1), two = cover.batch_ns_per_point(2);
  report.add({.what = "batches over its cells, 1 thread", .figure = one, .unit = "ns/point"});
  report.add({.what = "batches over its cells, 2 threads",
              .figure = two,
              .unit = "ns/point",
              .ratio = one / two,
              .ratio_to = "1 thread's speed"});
}

}  // namespace cambium::bench
