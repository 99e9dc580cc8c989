#include "blobtree/surface_cover.h"

#include "blobtree/compiled_tree.h"
#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "blobtree/tape.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>
#include <utility>

namespace cambium {

/// Tapes one after another in a few large blocks; they never move. A tape that was added lately is not kept twice.
class SurfaceCover::TapeStore {
 public:
  const Tape* add(const Tape& tape) {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : tape.slots()) hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    for (const Instruction& in : tape.instructions()) {
      hash = (hash ^ in.first ^ std::uint64_t{in.node} << 32) * 0x9e3779b97f4a7c15u;
    }
    const Tape*& lately = lately_[hash >> (64 - kLatelyBits)];
    if (!lately || !lately->same_arrays(tape)) lately = keep(tape);
    return lately;
  }
  void finish() { lately_ = {}; }
  std::size_t count() const { return count_; }
  std::size_t memory_bytes() const { return sizeof(*this) + blocks_.capacity() * sizeof(blocks_[0]) + held_; }

 private:
  const Tape* keep(const Tape& tape) {
    const std::size_t bytes = (sizeof(Tape) + tape.array_bytes() + alignof(Tape) - 1) / alignof(Tape) * alignof(Tape);
    if (blocks_.empty() || used_ + bytes > size_) {
      size_ = std::max(std::min(2 * size_, kLargestBlock), bytes);
      blocks_.push_back(std::make_unique_for_overwrite<std::byte[]>(size_));
      used_ = 0;
      held_ += size_;
    }
    std::byte* const at = blocks_.back().get() + used_;
    used_ += bytes;
    ++count_;
    return new (at) Tape(tape.copied_to(at + sizeof(Tape)));
  }

  static constexpr std::size_t kLargestBlock = std::size_t{1} << 15;
  static constexpr int kLatelyBits = 8;
  std::vector<std::unique_ptr<std::byte[]>> blocks_;
  std::size_t size_ = 256, used_ = 0, held_ = 0, count_ = 0;
  std::vector<const Tape*> lately_ = std::vector<const Tape*>(std::size_t{1} << kLatelyBits);
};

namespace {

constexpr double kMostRadii = 1e9;   // cells of so many are as large as they get
// Where there are too many cells they grow by this much from one attempt to the next. After the second that grows as well: where bounds
// cannot tell that a volume is empty there may be thousands of times too many.
constexpr double kGrowth = 1.5;

double longest_edge(const Box& box) {
  const Vec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

/// As their Morton keys compare, without making these: by the axis in which they differ in the highest bit (Chan 2002).
bool before_in_morton_order(const CellPlace& a, const CellPlace& b) {
  int axis = 2;
  for (const int other : {1, 0}) {
    const std::uint32_t most = a[axis] ^ b[axis], differs = a[other] ^ b[other];
    if (most < differs && most < (most ^ differs)) axis = other;
  }
  return a[axis] < b[axis];
}

/// Where in a cube a box is, outwards to the next 255th.
std::array<std::uint8_t, 6> part_of(const Box& cube, const Box& box) {
  std::array<std::uint8_t, 6> part{};
  for (int a = 0; a < 3; ++a) {
    const double unit = 255 / (cube.hi[a] - cube.lo[a]);
    part[a] = static_cast<std::uint8_t>(std::clamp(std::floor((box.lo[a] - cube.lo[a]) * unit - 1e-6), 0.0, 255.0));
    part[a + 3] = static_cast<std::uint8_t>(std::clamp(std::ceil((box.hi[a] - cube.lo[a]) * unit + 1e-6), 0.0, 255.0));
  }
  return part;
}

}  // namespace

class CoverRun : public CellRun {
 public:
  struct Result {
    std::uint64_t key = 0;
    std::vector<SurfaceCover::Cell> cells;
    std::shared_ptr<SurfaceCover::TapeStore> tapes;
  };
  struct Shared {
    const CompiledTree& tree;
    std::size_t max_cells;
    std::mutex mutex;
    std::vector<Result> results;
    std::atomic<std::size_t> cells{0};
    std::atomic<bool> too_many{false};
  };
  explicit CoverRun(Shared& shared) : shared_(shared) {}
  void found(Evaluator&, const FoundCell& cell) override {
    Known& known = known_[static_cast<std::size_t>(cell.tape_level)];
    if (known.serial != cell.tape_serial) {
      if (!result_.tapes) result_.tapes = std::make_shared<SurfaceCover::TapeStore>();
      known = {cell.tape_serial, result_.tapes->add(*cell.field.tape_), occupied(*cell.field.tape_)};
    }
    if (result_.cells.empty()) result_.key = morton_key(cell.place);
    result_.cells.push_back({known.tape, cell.place, static_cast<std::uint8_t>(cell.level), part_of(cell.box, known.support)});
  }

  void finish() override {
    if (result_.cells.empty()) return;
    result_.tapes->finish();
    if ((shared_.cells += result_.cells.size()) > shared_.max_cells) shared_.too_many = true;
    const std::lock_guard lock(shared_.mutex);
    shared_.results.push_back(std::move(result_));
  }

 private:
  struct Known {
    std::uint64_t serial = 0;
    const Tape* tape = nullptr;
    Box support;
  };

  /// Where the primitives of a tape can be non-zero.
  Box occupied(const Tape& tape) const {
    Box support;
    for (const Instruction& in : tape.instructions()) {
      if (is_swept(in.op)) {
        for (std::uint32_t i = in.first; i < in.first + in.count; ++i) support.extend(shared_.tree.bounds_of(tape.slots()[i]));
      } else if (in.op == Op::kPrimitive || in.op == Op::kHalfSpace) {
        support.extend(shared_.tree.bounds_of(in.first));
      }
    }
    return support;
  }

  Shared& shared_;
  Result result_;
  std::array<Known, kMostLevels + 1> known_{};
};

Box SurfaceCover::cube(std::size_t cell) const { return grid_.box(cells_[cell].place, cells_[cell].level); }

std::optional<std::size_t> SurfaceCover::find(const Vec3& p) const {
  const std::optional<CellPlace> place = grid_.place_of(p);
  return place ? find_place(*place) : std::nullopt;
}

std::optional<std::size_t> SurfaceCover::find_place(const CellPlace& place) const {
  const auto after = std::upper_bound(cells_.begin(), cells_.end(), place,
                                      [](const CellPlace& at, const Cell& cell) { return before_in_morton_order(at, cell.place); });
  if (after == cells_.begin()) return std::nullopt;
  const Cell& last = after[-1];   // cubes of an octree: either it holds the place or none does
  for (int a = 0; a < 3; ++a)
    if (place[a] >> last.level != last.place[a] >> last.level) return std::nullopt;
  return static_cast<std::size_t>(after - 1 - cells_.begin());
}

Box SurfaceCover::box(std::size_t cell) const {
  const Cell& c = cells_[cell];
  const Box cube = this->cube(cell);
  const Vec3 unit = cube.size() / 255.0;
  Box part = cube;
  for (int a = 0; a < 3; ++a) {
    if (c.occupied[a] > 0) part.lo[a] = cube.lo[a] + unit[a] * c.occupied[a];
    if (c.occupied[a + 3] < 255) part.hi[a] = cube.lo[a] + unit[a] * c.occupied[a + 3];
  }
  return part;
}

PrunedField SurfaceCover::field(std::size_t cell) const { return PrunedField(*tree_, *cells_[cell].tape, nullptr, box(cell)); }

PrunedField SurfaceCover::cube_field(std::size_t cell) const {
  return PrunedField(*tree_, *cells_[cell].tape, nullptr, grid_.box(cells_[cell].place, cells_[cell].level));
}

std::size_t SurfaceCover::memory_bytes() const {
  std::size_t bytes = sizeof(*this) + cells_.capacity() * sizeof(Cell) + stores_.capacity() * sizeof(stores_[0]);
  for (const auto& store : stores_) bytes += store->memory_bytes();
  return bytes;
}

std::optional<SurfaceCover> cover_surface(const Field& field, const CoverOptions& options, const RunOptions& run) {
  for (const double radii : {options.cell_radii, options.sparse_radii}) {
    if (!(radii > 0) || !std::isfinite(radii)) throw InputError({}, fmt::format("cells of {:g} radii", radii), "a finite number above 0");
  }
  if (!(options.shared_radii > 0)) throw InputError({}, fmt::format("shared cells of {:g} radii", options.shared_radii), "a number above 0");
  if (!(options.sagitta > 0)) throw InputError({}, fmt::format("a sagitta of {:g} m", options.sagitta), "a length above 0");
  SurfaceCover cover;
  cover.tree_ = field.tree_;
  if (field.bounds().empty()) return cover;
  // Cells that follow branches are never cut below this: 2^-20 of the whole is below a pixel of any picture of it.
  cover.grid_ = cell_grid(field.bounds(), options.cell.value_or(options.unit.value_or(longest_edge(field.bounds()) * 0x1p-19)));
  CellRule rule;
  rule.task_height = 4;
  if (!options.cell) {
    rule.radii = options.cell_radii;
    rule.sparse_radii = options.sparse_radii;
    rule.sparse_atoms = options.sparse_atoms;
    rule.shared_radii = options.shared_radii;
    rule.sagitta = options.sagitta;
  }
  ProgressMeter progress(run, "covering the surface");
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  double coarser = kGrowth;
  for (int attempt = 1;; ++attempt) {
    CoverRun::Shared shared{*field.tree_, options.max_cells, {}, {}, {}, {}};
    bool complete = false;
    arena.execute([&] {
      const auto make_run = [&] { return std::make_unique<CoverRun>(shared); };
      complete = search_cells(field, cover.grid_, Wanted::kSurface, rule, make_run, run, &progress, &shared.too_many);
    });
    if (run.cancelled()) return std::nullopt;
    if (!complete) {
      if (options.cell) {
        throw InputError({}, fmt::format("cells of {:g} m", *options.cell),
                         fmt::format("a size that gives at most {} cells", options.max_cells));
      }
      rule.radii *= coarser;
      rule.sparse_radii *= coarser;
      rule.shared_radii *= coarser;
      rule.sagitta *= coarser * coarser;
      if (attempt > 1) coarser *= kGrowth;
      if (!(rule.radii < kMostRadii)) {
        throw InputError({}, fmt::format("at most {} cells", options.max_cells), "as many as the coarsest cover takes");
      }
      continue;
    }
    arena.execute([&] {
      auto& results = shared.results;
      tbb::parallel_sort(results.begin(), results.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
      std::vector<std::size_t> first(results.size() + 1, 0);
      for (std::size_t i = 0; i < results.size(); ++i) first[i + 1] = first[i] + results[i].cells.size();
      cover.cells_.resize(first.back());
      cover.stores_.resize(results.size());
      tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
        std::copy(results[i].cells.begin(), results[i].cells.end(), cover.cells_.begin() + static_cast<std::ptrdiff_t>(first[i]));
        results[i].cells = {};
        cover.stores_[i] = std::move(results[i].tapes);
      });
    });
    for (const auto& store : cover.stores_) cover.tape_count_ += store->count();
    return cover;
  }
}

}  // namespace cambium
