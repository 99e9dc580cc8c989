#include "blobtree/cell_search.h"

#include "blobtree/active_atoms.h"
#include "blobtree/progress_meter.h"
#include "blobtree/tape.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace cambium {
namespace {

// Bounds over many primitives are too wide to reject anything and cost their number: look only at fields this small.
constexpr std::size_t kAtomsWorthBounding = 96;
// Lists up to this long are handed down within one thread's scratch; longer ones are shared out.
constexpr std::size_t kAtomsWorthSharing = 4096;

CellPlace child_of(const CellPlace& place, int level, int child) {
  CellPlace c = place;
  for (int a = 0; a < 3; ++a) c[a] |= static_cast<std::uint32_t>((child >> a) & 1) << (level - 1);
  return c;
}

std::size_t grown_to(std::size_t size) { return size <= 4096 ? 4096 : std::bit_ceil(size); }

}  // namespace

class CellSearch {
 public:
  CellSearch(const Field& field, const CellGrid& grid, Wanted wanted, const CellRule& rule, const CellRunFactory& make_run,
             const RunOptions& run, ProgressMeter* progress, const std::atomic<bool>* stop)
      : tree_(*field.tree_), grid_(grid), wanted_(wanted), rule_(rule), make_run_(make_run), run_(run), progress_(progress),
        stop_(stop), scratches_([this] { return Scratch(tree_); }) {}

  bool stopped() const { return run_.cancelled() || (stop_ && stop_->load(std::memory_order_relaxed)); }

  void search() {
    std::vector<std::uint32_t> all(tree_.atoms.size());
    std::iota(all.begin(), all.end(), 0u);
    const Box root = grid_.box({0, 0, 0}, grid_.levels);
    std::vector<std::uint32_t> active;
    append_active(tree_, all, root, active);
    all = {};
    shared_region({0, 0, 0}, grid_.levels, std::move(active), 1.0);
  }

 private:
  struct Scratch {
    explicit Scratch(const CompiledTree& tree) : builders(kMostLevels + 1, TapeBuilder(tree)), tapes(kMostLevels + 1) {}
    std::vector<TapeBuilder> builders;              // the tape of the region that is being looked at on each level
    std::vector<const Tape*> tapes;
    std::array<std::uint64_t, kMostLevels + 1> serials{};
    std::uint64_t last_serial = 0;
    std::vector<std::uint32_t> atoms;               // lists of the regions being looked at, one after another
    Evaluator evaluator;
  };

  double smallest_radius(std::span<const std::uint32_t> atoms) const {
    double radius = kInfinity;
    for (const std::uint32_t atom : atoms) radius = std::min(radius, tree_.radius_of(atom));
    return radius;
  }

  /// How many more levels a region of these atoms is expected to be cut by.
  int height(int level, std::size_t count, double smallest) const {
    if (!(rule_.radii > 0) || level == 0) return level;
    const double limit = smallest < kInfinity ? smallest * (count <= rule_.sparse_atoms ? rule_.sparse_radii : rule_.radii)
                                              : std::ldexp(grid_.cell, grid_.levels - 6);
    const double edge = std::ldexp(grid_.cell, level);
    return edge <= limit ? 0 : std::min(level, 1 + std::ilogb(edge / limit));
  }

  bool holds_wanted(const Interval& f) const { return wanted_ == Wanted::kSurface ? f.contains(kIso) : f.hi > 0; }

  /// Makes the tape of a region and asks what it can hold.
  bool can_hold(Scratch& s, std::span<const std::uint32_t> atoms, const Box& box, int level, int& tape_level) const {
    if (tape_level < 0) {
      s.tapes[level] = &s.builders[level].build(atoms);
      s.serials[level] = ++s.last_serial;
      tape_level = level;
    }
    const PrunedField field(tree_, *s.tapes[tape_level], nullptr, box);
    return !field.empty() && holds_wanted(s.evaluator.interval(field, box));
  }

  // share: this region's part of the whole work, for progress.
  void shared_region(const CellPlace& place, int level, std::vector<std::uint32_t> atoms, double share) {
    if (stopped()) return;
    if (atoms.empty()) return tell(share);
    const int levels_below = height(level, atoms.size(), smallest_radius(atoms));
    if (levels_below == 0 || (atoms.size() <= kAtomsWorthSharing && levels_below <= rule_.task_height)) {
      const std::unique_ptr<CellRun> run = make_run_();
      Scratch& s = scratches_.local();
      s.atoms = std::move(atoms);
      region(s, *run, place, level, 0, s.atoms.size(), -1);
      return tell(share);
    }
    if (atoms.size() <= kAtomsWorthBounding) {
      int tape_level = -1;
      if (!can_hold(scratches_.local(), atoms, grid_.box(place, level), level, tape_level)) return tell(share);
    }
    std::array<std::vector<std::uint32_t>, 8> lists;
    const auto narrow = [&](int child) {
      append_active(tree_, atoms, grid_.box(child_of(place, level, child), level - 1), lists[child]);
    };
    if (atoms.size() > kAtomsWorthSharing) {
      tbb::parallel_for(0, 8, narrow);
    } else {
      for (int child = 0; child < 8; ++child) narrow(child);
    }
    atoms = {};
    std::size_t total = 0;
    for (const auto& list : lists) total += list.size();
    if (total == 0) return tell(share);
    tbb::parallel_for(0, 8, [&](int child) {
      const double part = share * static_cast<double>(lists[child].size()) / static_cast<double>(total);
      shared_region(child_of(place, level, child), level - 1, std::move(lists[child]), part);
    });
  }

  /// Depth is at most kMostLevels. tape_level: whose tape is also that of these atoms; -1 if there is none yet.
  void region(Scratch& s, CellRun& run, const CellPlace& place, int level, std::size_t first, std::size_t end, int tape_level) {
    if (first == end || stopped()) return;
    const Box box = grid_.box(place, level);
    const std::size_t count = end - first;
    s.atoms.reserve(grown_to(end + count));   // so that children can be appended while this list is read
    const std::span<const std::uint32_t> atoms = std::span<const std::uint32_t>(s.atoms).subspan(first, count);
    const bool few = count <= kAtomsWorthBounding;
    bool leaf = !few && height(level, count, smallest_radius(atoms)) == 0;
    if (few || leaf) {
      if (!can_hold(s, atoms, box, level, tape_level)) return;
      const Tape& tape = *s.tapes[tape_level];
      leaf = leaf || height(level, count, tape.smallest_radius) == 0;
      if (leaf) {
        run.found(s.evaluator, {place, level, box, PrunedField(tree_, tape, nullptr, box), tape_level, s.serials[tape_level]});
        return;
      }
    }
    for (int child = 0; child < 8; ++child) {
      const CellPlace at = child_of(place, level, child);
      append_active(tree_, std::span<const std::uint32_t>(s.atoms).subspan(first, count), grid_.box(at, level - 1), s.atoms);
      const bool same = s.atoms.size() - end == count;
      region(s, run, at, level - 1, end, s.atoms.size(), same ? tape_level : -1);
      s.atoms.resize(end);
    }
  }

  void tell(double share) const {
    if (progress_) progress_->add(share);
  }

  const CompiledTree& tree_;
  const CellGrid& grid_;
  Wanted wanted_;
  const CellRule& rule_;
  const CellRunFactory& make_run_;
  const RunOptions& run_;
  ProgressMeter* progress_;
  const std::atomic<bool>* stop_;
  tbb::enumerable_thread_specific<Scratch> scratches_;
};

bool search_cells(const Field& field, const CellGrid& grid, Wanted wanted, const CellRule& rule, const CellRunFactory& make_run,
                  const RunOptions& run, ProgressMeter* progress, const std::atomic<bool>* stop) {
  CellSearch search(field, grid, wanted, rule, make_run, run, progress, stop);
  search.search();
  if (search.stopped()) return false;
  if (progress) progress->finish();
  return true;
}

namespace {

class VisitingRun : public CellRun {
 public:
  explicit VisitingRun(const CellVisitor& visit) : visit_(visit) {}
  void found(Evaluator& evaluator, const FoundCell& cell) override { visit_(evaluator, cell.field, cell.place); }

 private:
  const CellVisitor& visit_;
};

}  // namespace

bool visit_cells(const Field& field, const CellGrid& grid, Wanted wanted, const CellVisitor& visit, const RunOptions& run,
                 ProgressMeter& progress, const std::atomic<bool>* stop) {
  const CellRule every_cell;
  return search_cells(field, grid, wanted, every_cell, [&] { return std::make_unique<VisitingRun>(visit); }, run, &progress, stop);
}

}  // namespace cambium
