// Generated trees of a thousand to a million internodes: what grows with the tree, and what must not.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <vector>

#include "bench/cover_rows.h"
#include "bench/generated_trees.h"
#include "bench/sections.h"
#include "bench/tree_case.h"

namespace cambium::bench {
namespace {

constexpr std::size_t kPlaces = 2000;
constexpr std::size_t kReference = 10'000;  // internodes; the ratios are to a tree of this size
constexpr double kSameMemory = 1.05;        // vectors round their capacity up
constexpr double kShared = 1e5;             // internodes; below, a cover takes too few milliseconds to be worth sharing out
constexpr double kSameTime = 1.1;           // what two runs of the same work differ by on a shared machine

struct Cases {
  std::deque<TreeCase> random;  // ascending sizes
  std::deque<TreeCase> shapes;  // single axis, balanced tree
  const TreeCase* reference = nullptr;
};

Cases make_cases(const Pace& pace) {
  Cases cases;
  for (std::size_t size = 1000; size <= pace.largest_tree; size *= 10) {
    const int power = static_cast<int>(std::lround(std::log10(static_cast<double>(size))));
    cases.random.push_back(make_tree_case(
        fmt::format("random tree of 10^{}", power), [&] { return random_tree(size, 5); }, kPlaces));
    if (size == kReference) cases.reference = &cases.random.back();
  }
  cases.shapes.push_back(make_tree_case(
      "balanced tree of 10^5", [] { return balanced_tree(100'000); }, kPlaces));
  cases.shapes.push_back(make_tree_case(
      "single axis of 10^5", [] { return single_axis(100'000); }, kPlaces));
  return cases;
}

double memory_per_internode(const TreeCase& tree, std::size_t bytes) {
  return static_cast<double>(bytes) / tree.internodes();
}

/// Figures of one tree that need no repetition. `reference`: the tree that memory is compared with; none for that tree
/// itself.
void add_building_rows(Report& report, const TreeCase& tree, const TreeCase* reference) {
  const bool is_million = tree.internodes() == 1e6;
  report.heading(fmt::format("Generated: {} internodes, {} primitives", tree.name, tree.field.atom_count()));
  Row surface{.what = "skeleton to BlobTree", .figure = tree.surface_seconds, .unit = "s"};
  if (is_million) surface.target = at_most(5);
  report.add(surface);
  report.add({.what = "compile to a Field", .figure = tree.compile_seconds, .unit = "s"});
  const auto memory_row = [&](const char* what, const auto& part) {
    const double bytes = memory_per_internode(tree, part(tree).memory_bytes());
    Row row{.what = what, .figure = bytes, .unit = "B/internode"};
    if (reference) {
      row.ratio = bytes / memory_per_internode(*reference, part(*reference).memory_bytes());
      row.ratio_to = reference->name + "'s";
      row.target = at_most(kSameMemory);
    }
    report.add(row);
  };
  memory_row("memory of the BlobTree", [](const TreeCase& of) -> const BlobTree& { return of.tree; });
  if (is_million)
    report.add({.what = "memory of the BlobTree against its limit",
                .figure = memory_per_internode(tree, tree.tree.memory_bytes()),
                .unit = "B/internode",
                .target = at_most(200)});
  memory_row("memory of the Field", [](const TreeCase& of) -> const Field& { return of.field; });
  report.add({.what = "primitives active in a cell at an internode", .figure = tree.mean_active, .unit = "on average"});
}

/// Covers of all trees in turns: one round of all, then the next. What takes long is measured once.
void time_covers(Cases& cases, const Pace& pace) {
  std::vector<CoverTimings*> covers;
  for (TreeCase& tree : cases.random) covers.push_back(&tree.cover);
  for (TreeCase& tree : cases.shapes) covers.push_back(&tree.cover);
  for (int round = 0; round < pace.cover_rounds; ++round)
    for (CoverTimings* cover : covers) {
      if (round > 0 && cover->spent() > pace.cover_seconds) continue;
      cover->measure_cover(1);
      cover->measure_batches();
      if (cover->spent() < pace.cover_seconds) cover->measure_cover(2);
      cover->release();
    }
}

/// What the issue asks of a whole run at a million internodes. Where other programs disturb the wall clock, processor time
/// is judged in its place.
void add_whole_rows(Report& report, const TreeCase& tree) {
  const bool is_million = tree.internodes() == 1e6;
  Row whole{.what = "skeleton to cover, 2 threads", .unit = "s"};
  whole.figure = tree.surface_seconds + tree.compile_seconds + tree.cover.seconds(2);
  const bool by_processor = tree.cover.disturbed() && tree.processor_seconds > 0;
  if (is_million && !by_processor) whole.target = at_most(60);
  report.add(whole);
  if (by_processor) {
    Row busier{.what = "the same, processor time of the busier", .unit = "s"};
    busier.figure = tree.processor_seconds + tree.cover.busier_thread_seconds();
    if (is_million) busier.target = at_most(60);
    report.add(busier);
  }
  Row peak{.what = "peak memory, skeleton to cover", .figure = static_cast<double>(tree.peak_bytes) / 1e9, .unit = "GB"};
  if (is_million) peak.target = at_most(8);
  report.add(peak);
}

}  // namespace

void trees_section(Report& report, const Pace& pace) {
  Cases cases = make_cases(pace);
  time_covers(cases, pace);
  Measurements measurements(pace);
  const auto measure = [&](const TreeCase& tree) {
    measurements.add(tree.name, [&tree] {
      for (const SurfacePlace& place : tree.places) benchmark::DoNotOptimize(tree.field.prune(place.cell()));
    });
  };
  for (const TreeCase& tree : cases.random) measure(tree);
  for (const TreeCase& tree : cases.shapes) measure(tree);
  measurements.run();

  const auto prune_ns = [&](const TreeCase& tree) { return measurements.ns(tree.name) / kPlaces; };
  const auto add_tree = [&](const TreeCase& tree, const TreeCase* memory_to, const TreeCase* time_to, Target cell_target) {
    add_building_rows(report, tree, memory_to);
    Row prune{.what = "prune to such cells, far from each other", .figure = prune_ns(tree), .unit = "ns/cell"};
    if (time_to) prune.ratio = prune_ns(tree) / prune_ns(*time_to), prune.ratio_to = time_to->name + "'s";
    report.add(prune);
    CellComparison comparison;
    if (time_to) comparison = {&time_to->cover, time_to->name + "'s", cell_target};
    add_cover_rows(report, tree.cover, comparison, tree.internodes() >= kShared);
    add_whole_rows(report, tree);
  };
  for (const TreeCase& tree : cases.random) {
    const TreeCase* to = tree.internodes() > kReference ? cases.reference : nullptr;
    add_tree(tree, to, to, at_most(1.3));
  }
  const TreeCase &balanced = cases.shapes.front(), &axis = cases.shapes.back();
  add_tree(balanced, nullptr, nullptr, {});
  add_tree(axis, nullptr, &balanced, at_most(kSameTime));
}

}  // namespace cambium::bench
