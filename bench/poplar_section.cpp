// The poplar of examples/: what its steps cost, and points, intervals, pruning and batches in cells on its surface.
#include <benchmark/benchmark.h>

#include <deque>
#include <filesystem>
#include <glm/gtc/constants.hpp>
#include <optional>
#include <stdexcept>

#include "bench/batch_points.h"
#include "bench/clock.h"
#include "bench/cover_rows.h"
#include "bench/sections.h"
#include "bench/surface_places.h"
#include "lsystem/lsystem.h"
#include "skeletons/surface.h"

namespace cambium::bench {
namespace {

constexpr std::size_t kCells = 512;  // their pruned fields stay in the second cache
constexpr std::size_t kBatchCells = 64;
constexpr int kEdge = 9;

/// As in examples/poplar.tree.toml.
SurfaceOptions poplar_options() {
  SurfaceOptions options;
  options.lip = 1.5;
  options.bend = {0, 12 * glm::pi<double>() / 180, 8 * glm::pi<double>() / 180};
  Prune prune;
  prune.where.branch = 4;
  prune.distance = 0.12;
  options.prunes = {prune};
  options.random_scars = {14, 0.05};
  return options;
}

/// Pruned fields of cells on the surface, with what their timing needs.
struct Cells {
  std::vector<SurfacePlace> places;
  std::vector<PrunedField> fields;
  std::vector<ActiveSet> around;   ///< of boxes twice as wide
  std::deque<BatchPoints> points;  ///< of the first kBatchCells
  double mean_active = 0;
};

Cells cells_of(const Skeleton& skeleton, const Field& field) {
  Cells cells;
  cells.places = surface_places(skeleton, field, kCells, RandomNumbers(3));
  for (const SurfacePlace& place : cells.places) {
    const Box cell = place.cell();
    cells.fields.push_back(field.prune(cell));
    cells.around.push_back(field.active(cell.padded(0.5 * cell.size().x)));
    cells.mean_active += static_cast<double>(cells.fields.back().atom_count()) / kCells;
    if (cells.points.size() < kBatchCells) cells.points.emplace_back(cell, kEdge);
  }
  return cells;
}

}  // namespace

void poplar_section(Report& report, const Pace& pace) {
  double derive_s = 0, turtle_s = 0, surface_s = 0, compile_s = 0;
  const LSystem system = LSystem::load(std::filesystem::path(CAMBIUM_EXAMPLES) / "poplar.l");
  const auto string = timed(derive_s, [&] { return derive(system, {}, {}); });
  if (!string) throw std::logic_error("a derivation that nothing cancels was cancelled");
  const Skeleton skeleton = timed(turtle_s, [&] { return interpret(*string, system, {}, {})->skeleton; });
  const Surfaced surfaced = timed(surface_s, [&] { return surface(skeleton, poplar_options()); });
  const Field field = timed(compile_s, [&] { return Field(surfaced.tree); });
  Cells cells = cells_of(skeleton, field);

  Evaluator evaluator;
  Measurements measurements(pace);
  const auto each_cell = [&](const char* name, auto work) {
    measurements.add(name, [&cells, work] {
      for (std::size_t i = 0; i < kCells; ++i) benchmark::DoNotOptimize(work(i));
    });
  };
  each_cell("value", [&](std::size_t i) { return evaluator.value(cells.fields[i], cells.places[i].point); });
  each_cell("sample", [&](std::size_t i) { return evaluator.sample(cells.fields[i], cells.places[i].point); });
  each_cell("interval", [&](std::size_t i) { return evaluator.interval(cells.fields[i], cells.places[i].cell()); });
  each_cell("field value", [&](std::size_t i) { return field.value(cells.places[i].point); });
  each_cell("field sample", [&](std::size_t i) { return field.sample(cells.places[i].point); });
  each_cell("field interval", [&](std::size_t i) { return field.interval(cells.places[i].cell()); });
  each_cell("active", [&](std::size_t i) { return field.active(cells.places[i].cell()); });
  each_cell("narrow", [&](std::size_t i) { return field.narrow(cells.around[i], cells.places[i].cell()); });
  each_cell("prune", [&](std::size_t i) { return field.prune(cells.places[i].cell()); });
  each_cell("prune narrowed", [&](std::size_t i) {
    return field.prune(field.narrow(cells.around[i], cells.places[i].cell()), cells.places[i].cell());
  });
  measurements.add("values", [&] {
    for (std::size_t i = 0; i < kBatchCells; ++i) cells.points[i].values(evaluator, cells.fields[i]);
  });
  measurements.add("samples", [&] {
    for (std::size_t i = 0; i < kBatchCells; ++i) cells.points[i].samples(evaluator, cells.fields[i]);
  });
  measurements.run();

  const auto per_cell = [&](const char* name) { return measurements.ns(name) / kCells; };
  report.heading("The poplar of examples/: " + std::to_string(surfaced.report.internodes_in) + " internodes, " +
                 std::to_string(field.atom_count()) + " primitives");
  report.add({.what = "derive poplar.l", .figure = derive_s, .unit = "s"});
  report.add({.what = "turtle", .figure = turtle_s, .unit = "s"});
  report.add({.what = "skeleton to BlobTree", .figure = surface_s, .unit = "s"});
  report.add({.what = "compile to a Field", .figure = compile_s, .unit = "s"});

  report.heading("Poplar, cells one branch diameter across on its surface");
  report.add({.what = "primitives active in a cell", .figure = cells.mean_active, .unit = "on average"});
  report.add({.what = "Evaluator::value, another cell every time", .figure = per_cell("value"), .unit = "ns/point"});
  report.add({.what = "Evaluator::sample",
              .figure = per_cell("sample"),
              .unit = "ns/point",
              .ratio = per_cell("sample") / per_cell("value"),
              .ratio_to = "value's time"});
  report.add({.what = "Evaluator::interval of the cell", .figure = per_cell("interval"), .unit = "ns/cell"});
  report.add({.what = "Field::value", .figure = per_cell("field value"), .unit = "ns/point"});
  report.add({.what = "Field::sample", .figure = per_cell("field sample"), .unit = "ns/point"});
  report.add({.what = "Field::interval of the cell", .figure = per_cell("field interval"), .unit = "ns/cell"});
  report.add({.what = "Field::active", .figure = per_cell("active"), .unit = "ns/cell"});
  report.add({.what = "Field::narrow from a box twice as wide", .figure = per_cell("narrow"), .unit = "ns/cell"});
  report.add({.what = "Field::prune", .figure = per_cell("prune"), .unit = "ns/cell"});
  report.add({.what = "narrow and prune", .figure = per_cell("prune narrowed"), .unit = "ns/cell"});
  const double batched = kBatchCells * static_cast<double>(kEdge * kEdge * kEdge);
  const double value = measurements.ns("values") / batched, sample = measurements.ns("samples") / batched;
  report.add({.what = "batches of 729 points", .figure = value, .unit = "ns/point"});
  report.add({.what = "batches of 729 points, gradients",
              .figure = sample,
              .unit = "ns/point",
              .ratio = sample / value,
              .ratio_to = "values' time"});

  CoverTimings cover(field);
  for (int round = 0; round < 8 * pace.cover_rounds; ++round) {   // a cover takes a twentieth of a second: one hiccup is 10 %
    cover.measure_cover(2);
    cover.measure_cover(1);
    cover.measure_batches();
  }
  report.heading("Cover of the poplar, cells about a branch diameter across");
  add_cover_rows(report, cover, {}, true);
}

}  // namespace cambium::bench
