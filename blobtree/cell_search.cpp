#include "blobtree/cell_search.h"

#include "blobtree/active_atoms.h"
#include "blobtree/progress_meter.h"
#include "blobtree/tape_interval.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
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

}  // namespace

class CellSearch {
 public:
  CellSearch(const Field& field, const CellGrid& grid, Wanted wanted, const CellRule& rule, const CellRunFactory& make_run,
             const RunOptions& run, ProgressMeter* progress, const std::atomic<bool>* stop)
      : tree_(*field.tree_), grid_(grid), wanted_(wanted), rule_(rule), make_run_(make_run), run_(run), progress_(progress),
        stop_(stop), scratches_([this] { return Scratch(tree_); }) {}

  bool stopped() const { return run_.cancelled() || (stop_ && stop_->load(std::memory_order_relaxed)); }

  void search() {
    std::vector<std::uint32_t> all(tree_.atom_count());
    std::iota(all.begin(), all.end(), 0u);
    ActiveAtoms active;
    if (all.size() > kAtomsWorthSharing) {
      active.atoms = std::move(all);   // the first cut finds those that matter, on all threads
    } else {
      find_active(tree_, all, grid_.box({0, 0, 0}, grid_.levels), active);
    }
    shared_region({0, 0, 0}, grid_.levels, std::move(active), 1.0);
  }

 private:
  using Children = std::array<ActiveAtoms, kChildren>;

  struct Scratch {
    explicit Scratch(const CompiledTree& tree)
        : builders(kMostLevels + 1, TapeBuilder(tree)), built(kMostLevels + 1), tapes(kMostLevels + 1),
          children(kMostLevels + 1) {}
    std::vector<TapeBuilder> builders;              // the tape of the region that is being looked at on each level,
    std::vector<std::vector<std::uint32_t>> built;  // and the atoms that it was made of
    std::vector<const Tape*> tapes;
    std::array<std::uint64_t, kMostLevels + 1> serials{};
    std::uint64_t last_serial = 0;
    std::vector<Children> children;                 // of the region that is being looked at on each level
    ChildSplitter splitter;
    TapeScratch<Interval> intervals;
    Evaluator evaluator;
  };

  double smallest_radius(std::span<const std::uint32_t> atoms) const {
    double radius = kInfinity;
    for (const std::uint32_t atom : atoms) radius = std::min(radius, tree_.radius_of(atom));
    return radius;
  }

  /// Whether in the region of a tape a chain is active, and something else.
  static bool shares_chain(const Tape& tape) {
    const auto instructions = tape.instructions();
    return instructions.size() > 1 &&
           std::any_of(instructions.begin(), instructions.end(), [](const Instruction& in) { return in.op == Op::kChain && in.frame == 0; });
  }

  /// How many more levels a region of these atoms is expected to be cut by. shared: as shares_chain().
  int height(int level, std::size_t count, double smallest, bool shared = false) const {
    if (!(rule_.radii > 0) || level == 0) return level;
    const double most = count <= rule_.sparse_atoms ? rule_.sparse_radii : rule_.radii;
    const double radii = shared ? std::min(most, rule_.shared_radii) : most;
    const double limit = smallest < kInfinity ? std::min(smallest * radii, std::sqrt(rule_.sagitta * smallest))
                                              : std::ldexp(grid_.cell, grid_.levels - 6);
    const double edge = std::ldexp(grid_.cell, level);
    return edge <= limit ? 0 : std::min(level, 1 + std::ilogb(edge / limit));
  }

  bool holds_wanted(const Interval& f) const { return wanted_ == Wanted::kSurface ? f.contains(kIso) : f.hi > 0; }

  /// Makes the tape of a region, unless tape_level tells whose it shares, and asks what it can hold.
  bool can_hold(Scratch& s, const ActiveAtoms& active, const Box& box, int level, int& tape_level) const {
    if (tape_level < 0) {
      if (s.built[level] != active.atoms) {   // else the last region on this level, most often a neighbour, had the same
        s.built[level] = active.atoms;
        s.tapes[level] = &s.builders[level].build(active.atoms);
        s.serials[level] = ++s.last_serial;
      }
      tape_level = level;
    }
    const Tape& tape = *s.tapes[tape_level];
    if (tape.empty()) return false;
    const Ball ball = circumscribed_ball(box);
    const Interval f = tape.frames().empty() ? tape_interval(tree_, tape, active, ball, s.intervals)
                                           : s.evaluator.interval(PrunedField(tree_, tape, nullptr, box), ball);
    return holds_wanted(f);
  }

  // share: this region's part of the whole work, for progress.
  void shared_region(const CellPlace& place, int level, ActiveAtoms active, double share) {
    if (stopped()) return;
    if (active.empty()) return tell(share);
    const int levels_below = height(level, active.size(), smallest_radius(active.atoms));
    if (levels_below == 0 || (active.size() <= kAtomsWorthSharing && levels_below <= rule_.task_height)) {
      const std::unique_ptr<CellRun> run = make_run_();
      region(scratches_.local(), *run, place, level, active, -1);
      run->finish();
      return tell(share);
    }
    const Box cube = grid_.box(place, level);
    Children lists;
    {
      Scratch& s = scratches_.local();   // not in use by this thread: nothing below waits for other tasks
      int tape_level = -1;
      if (active.size() <= kAtomsWorthBounding && !can_hold(s, active, cube, level, tape_level)) return tell(share);
      if (active.size() <= kAtomsWorthSharing) s.splitter.split(tree_, active.atoms, cube, lists);
    }
    if (active.size() > kAtomsWorthSharing) split_in_parallel(active.atoms, cube, lists);
    active = {};
    std::size_t total = 0;
    for (const ActiveAtoms& list : lists) total += list.size();
    if (total == 0) return tell(share);
    tbb::parallel_for(0, 8, [&](int child) {
      const double part = share * static_cast<double>(lists[child].size()) / static_cast<double>(total);
      shared_region(child_of(place, level, child), level - 1, std::move(lists[child]), part);
    });
  }

  void split_in_parallel(std::span<const std::uint32_t> atoms, const Box& cube, Children& lists) const {
    const std::size_t parts = (atoms.size() + kAtomsWorthSharing - 1) / kAtomsWorthSharing;
    std::vector<Children> found(parts);
    tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t i) {
      ChildSplitter splitter;
      const std::size_t begin = i * kAtomsWorthSharing;
      splitter.split(tree_, atoms.subspan(begin, std::min(kAtomsWorthSharing, atoms.size() - begin)), cube, found[i]);
    });
    tbb::parallel_for(std::size_t{0}, kChildren, [&](std::size_t k) {
      std::size_t total = 0;
      for (const Children& part : found) total += part[k].size();
      lists[k].atoms.reserve(total);
      lists[k].bounds.reserve(total);
      for (const Children& part : found) {
        lists[k].atoms.insert(lists[k].atoms.end(), part[k].atoms.begin(), part[k].atoms.end());
        lists[k].bounds.insert(lists[k].bounds.end(), part[k].bounds.begin(), part[k].bounds.end());
      }
    });
  }

  /// Depth is at most kMostLevels. tape_level: whose tape is also that of these atoms; -1 if there is none yet.
  void region(Scratch& s, CellRun& run, const CellPlace& place, int level, const ActiveAtoms& active, int tape_level) {
    if (stopped()) return;
    const Box box = grid_.box(place, level);
    const bool few = active.size() <= kAtomsWorthBounding;
    bool leaf = level == 0 || (!few && height(level, active.size(), smallest_radius(active.atoms)) == 0);
    if (few || leaf) {
      if (!can_hold(s, active, box, level, tape_level)) return;
      const Tape& tape = *s.tapes[tape_level];
      leaf = leaf || height(level, active.size(), tape.smallest_radius(), shares_chain(tape)) == 0;
      if (leaf) {
        run.found(s.evaluator, {place, level, box, PrunedField(tree_, tape, nullptr, box), tape_level, s.serials[tape_level]});
        return;
      }
    }
    Children& children = s.children[level];
    s.splitter.split(tree_, active.atoms, box, children);
    for (int child = 0; child < 8; ++child) {
      const ActiveAtoms& list = children[child];
      const bool same = list.size() == active.size();
      if (!list.empty()) region(s, run, child_of(place, level, child), level - 1, list, same ? tape_level : -1);
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
  const auto make_run = [&] { return std::make_unique<VisitingRun>(visit); };
  return search_cells(field, grid, wanted, every_cell, make_run, run, &progress, stop);
}

}  // namespace cambium
