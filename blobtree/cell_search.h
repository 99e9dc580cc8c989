// Finds the cells of a subdivision of space that a field can matter in, each with the field pruned to it. One mechanism for
// meshes, volumes and rays: its cost follows the surface, not the box, nor the depth of the tree.
//
// An octree is halved from its root. Every region hands its children the atoms active in them, so a child looks only at
// what its parent kept; where few are left a tape is made, its interval over the region tells whether anything wanted can
// be there, and children with the same atoms go on using it.
#pragma once

#include "blobtree/cell_grid.h"
#include "blobtree/field.h"
#include "blobtree/run_options.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

namespace cambium {

class ProgressMeter;

enum class Wanted {
  kSurface,   ///< cells in which the field may take the value kIso
  kMatter     ///< cells in which it may be above 0
};

/// How large a cell may be, in its own smallest active surface radii; the default is a level-0 cell everywhere.
struct CellRule {
  double radii = 0;                ///< longest edge where many primitives meet; 0: level 0
  double sparse_radii = 0;         ///< the same where at most sparse_atoms are active
  std::size_t sparse_atoms = 0;
  double shared_radii = kInfinity; ///< and no longer than this where a chain is active, not warped, beside something else
  double sagitta = kInfinity;      ///< and no longer than sqrt(sagitta * radius), metres
  int task_height = 2;             ///< higher subtrees are shared out to threads; larger, the cheaper a visit is
};

struct FoundCell {
  CellPlace place{};
  int level = 0;
  Box box;                         ///< the cell's cube
  PrunedField field;               ///< valid until the visit returns
  int tape_level = 0;              ///< cells of one run with the same tape_level and tape_serial have the same tape
  std::uint64_t tape_serial = 0;
};

/// Takes the cells of one subtree, in Morton order, by one thread.
class CellRun {
 public:
  virtual ~CellRun() = default;
  virtual void found(Evaluator& evaluator, const FoundCell& cell) = 0;
  virtual void finish() {}         ///< after the last, unless one of them threw
};

/// Makes the runs; called from many threads. Where subtrees are cut does not depend on the threads.
using CellRunFactory = std::function<std::unique_ptr<CellRun>()>;

/// Runs in the current arena; a run may not wait for other tasks. False if cancelled, or if stop becomes true.
bool search_cells(const Field& field, const CellGrid& grid, Wanted wanted, const CellRule& rule, const CellRunFactory& make_run,
                  const RunOptions& run, ProgressMeter* progress = nullptr, const std::atomic<bool>* stop = nullptr);

/// The field is valid until the visit returns.
using CellVisitor = std::function<void(Evaluator&, const PrunedField&, const CellPlace&)>;

/// Visits every level-0 cell that passes the test, from many threads and in no particular order.
bool visit_cells(const Field& field, const CellGrid& grid, Wanted wanted, const CellVisitor& visit, const RunOptions& run,
                 ProgressMeter& progress, const std::atomic<bool>* stop = nullptr);

}  // namespace cambium
