#include "polygonize/block_search.h"

#include "blobtree/progress_meter.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace cambium {
namespace {

// Bounds over many primitives are too wide to reject anything and cost their number: look only at fields this small.
constexpr std::size_t kAtomsWorthBounding = 96;
// Subtrees at least this high are shared out to other threads.
constexpr int kParallelLevel = 2;

class Search {
 public:
  Search(const Field& field, const Lattice& lattice, IntervalTest wanted, const BlockVisitor& visit, const RunOptions& run,
         ProgressMeter& progress, const std::atomic<bool>* stop)
      : field_(field), lattice_(lattice), wanted_(wanted), visit_(visit), run_(run), progress_(progress), stop_(stop) {}

  bool stopped() const { return run_.cancelled() || (stop_ && stop_->load(std::memory_order_relaxed)); }

  // share: this region's part of the whole work, for progress. Depth is at most kCoordinateBits - kBlockBits.
  void region(const CellPlace& place, int level, const ActiveSet& active, double share) {
    if (stopped()) return;
    const Box box = lattice_.box(place, level);
    if (active.atoms.empty() || !box.intersects(field_.bounds())) return progress_.add(share);
    if (level == 0 || active.atoms.size() <= kAtomsWorthBounding) {
      const PrunedField pruned = field_.prune(active, box);
      Evaluator& evaluator = evaluators_.local();
      if (pruned.empty() || !wanted_(evaluator.interval(pruned, box))) return progress_.add(share);
      if (level == 0) {
        visit_(evaluator, pruned, place);
        return progress_.add(share);
      }
    }
    std::array<CellPlace, 8> places;
    std::array<ActiveSet, 8> sets;
    std::size_t total = 0;
    for (int child = 0; child < 8; ++child) {
      places[child] = place;
      for (int a = 0; a < 3; ++a) places[child][a] |= static_cast<std::uint32_t>((child >> a) & 1) << (level - 1);
      sets[child] = field_.narrow(active, lattice_.box(places[child], level - 1));
      total += sets[child].atoms.size();
    }
    if (total == 0) return progress_.add(share);
    const auto descend = [&](int child) {
      const double part = share * static_cast<double>(sets[child].atoms.size()) / static_cast<double>(total);
      region(places[child], level - 1, sets[child], part);
    };
    if (level >= kParallelLevel) {
      tbb::parallel_for(0, 8, descend);
    } else {
      for (int child = 0; child < 8; ++child) descend(child);
    }
  }

 private:
  const Field& field_;
  const Lattice& lattice_;
  IntervalTest wanted_;
  const BlockVisitor& visit_;
  const RunOptions& run_;
  ProgressMeter& progress_;
  const std::atomic<bool>* stop_;
  tbb::enumerable_thread_specific<Evaluator> evaluators_;
};

}  // namespace

bool search_blocks(const Field& field, const Lattice& lattice, IntervalTest wanted, const BlockVisitor& visit,
                   const RunOptions& run, ProgressMeter& progress, const std::atomic<bool>* stop) {
  Search search(field, lattice, wanted, visit, run, progress, stop);
  search.region({0, 0, 0}, lattice.levels, field.active(lattice.box({0, 0, 0}, lattice.levels)), 1.0);
  if (search.stopped()) return false;
  progress.finish();
  return true;
}

}  // namespace cambium
