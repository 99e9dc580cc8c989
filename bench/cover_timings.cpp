#include "bench/cover_timings.h"

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "bench/batch_points.h"
#include "bench/clock.h"
#include "bench/process_figures.h"

namespace cambium::bench {
namespace {

constexpr std::size_t kBatchCells = 2048;
constexpr int kEdge = 9;

double cpu_seconds_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

SurfaceCover covered(const Field& field, int threads) {
  RunOptions run;
  run.threads = threads;
  auto cover = cover_surface(field, diameter_cells(), run);
  if (!cover) throw std::logic_error("a cover that nothing cancels was cancelled");
  return std::move(*cover);
}

double thread_seconds_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Cells first, first + step, ... of the list. Processor seconds of this thread.
double evaluate_cells(const SurfaceCover& cover, const std::vector<std::size_t>& cells, std::size_t first,
                      std::size_t step) {
  // One lattice that lies inside every one of them, so that making points is not timed.
  Vec3 size(kInfinity);
  for (const std::size_t cell : cells) size = glm::min(size, cover.box(cell).size());
  BatchPoints points({Vec3(0.0), size}, kEdge);
  Evaluator evaluator;
  const double begin = thread_seconds_now();
  for (std::size_t i = first; i < cells.size(); i += step) points.values(evaluator, cover.field(cells[i]));
  return thread_seconds_now() - begin;
}

}  // namespace

CoverOptions diameter_cells() {
  CoverOptions options;
  options.cell_radii = options.sparse_radii = 2.8;
  return options;
}

void CoverTimings::measure_cover(int threads) {
  cover_ = {};  // so that there is never more than one in memory
  double seconds = 0;
  const double cpu_begin = cpu_seconds_now();
  const auto threads_begin = thread_times();
  cover_ = timed(seconds, [&] { return covered(field_, threads); });
  const double cpu = cpu_seconds_now() - cpu_begin;
  const ThreadsSince since = threads_since(threads_begin);

  if (spent_ > 0 && cover_.size() != cells_) throw std::logic_error("covers of one field differ");
  spent_ += seconds;
  cells_ = cover_.size();
  memory_bytes_ = cover_.memory_bytes();
  tapes_ = cover_.tape_count();
  if (threads == 1)
    cpu_seconds_ = std::min(cpu_seconds_, cpu);
  else
    busier_seconds_ = std::min(busier_seconds_, since.busiest_ran);
  if (seconds < cover_seconds_[threads - 1]) {
    cover_seconds_[threads - 1] = seconds;
    disturbed_[threads - 1] = since.waited > 0.05 * seconds;
  }
}

void CoverTimings::measure_batches() {
  std::vector<std::size_t> cells;
  const std::size_t stride = std::max<std::size_t>(1, cover_.size() / kBatchCells);
  for (std::size_t cell = 0; cell < cover_.size() && cells.size() < kBatchCells; cell += stride) cells.push_back(cell);
  double active = 0, edge = 0;
  for (const std::size_t cell : cells) {
    const PrunedField field = cover_.field(cell);
    const Vec3 size = field.box().size();
    active += static_cast<double>(field.atom_count());
    edge += std::max({size.x, size.y, size.z}) / (2 * field.smallest_radius());
  }
  mean_active_ = active / static_cast<double>(cells.size());
  mean_edge_ = edge / static_cast<double>(cells.size());
  const double points = static_cast<double>(cells.size()) * kEdge * kEdge * kEdge;
  for (const int threads : {1, 2, 1, 2, 1, 2}) {  // the first finds nothing in the caches
    double seconds[2] = {0, 0};
    const auto work = [&](int thread) {
      seconds[thread] = evaluate_cells(cover_, cells, static_cast<std::size_t>(thread), static_cast<std::size_t>(threads));
    };
    std::vector<std::thread> others;
    for (int thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
    work(0);
    for (std::thread& other : others) other.join();
    batch_ns_[threads - 1] = std::min(batch_ns_[threads - 1], std::max(seconds[0], seconds[1]) / points * 1e9);
  }
}

}  // namespace cambium::bench
