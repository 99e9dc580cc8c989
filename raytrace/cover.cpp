#include "raytrace/cover.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

// Bounds on an interval are only worth their cost where few primitives are active; above, cells are merely halved.
constexpr std::size_t kBoundedAtoms = 96;

struct Cell {
  Box box;
  ActiveSet active;
};

struct Outcome {
  std::vector<Cell> halves;            // empty, or two
  std::optional<PrunedField> leaf;
};

double longest_edge(const Box& box) {
  const Vec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

std::pair<Box, Box> halve(const Box& box) {
  const Vec3 size = box.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
  Box low = box, high = box;
  low.hi[axis] = middle;
  high.lo[axis] = middle;
  return {low, high};
}

/// The part of the box where an active primitive can be non-zero.
Box occupied(const Field& field, const Cell& cell) {
  Box support;
  for (std::uint32_t atom : cell.active.atoms) support.extend(field.atom_bounds(atom));
  return Box::intersection(cell.box, support);
}

double smallest_radius(const Field& field, const ActiveSet& active) {
  double radius = kInfinity;
  for (std::uint32_t atom : active.atoms) radius = std::min(radius, field.atom_radius(atom));
  return radius;
}

class Subdivision {
 public:
  Subdivision(const Field& field, const TraceCoverOptions& options) : field_(field), options_(options) {
    // A cell below this is never halved: 2^-20 of the whole is below a pixel of any picture of it.
    floor_ = longest_edge(field.bounds()) * 0x1p-20;
  }

  Outcome examine(const Cell& cell, Evaluator& evaluator, bool may_halve) const {
    Outcome outcome;
    if (cell.active.atoms.empty()) return outcome;
    Cell tight{occupied(field_, cell), {}};
    if (tight.box.empty()) return outcome;
    const std::size_t atoms = cell.active.atoms.size();
    const double edge = longest_edge(tight.box);
    const double radius = smallest_radius(field_, cell.active);
    const double limit = radius < kInfinity
                             ? radius * (atoms <= options_.sparse_atoms ? options_.sparse_radii : options_.cell_radii)
                             : longest_edge(field_.bounds()) / 64;
    const bool done = edge <= std::max(limit, floor_) || !may_halve;
    if (done || atoms <= kBoundedAtoms) {
      PrunedField pruned = field_.prune(cell.active, tight.box);
      if (pruned.empty()) return outcome;
      const Interval range = evaluator.interval(pruned, tight.box);
      if (range.hi < kIso || range.lo > kIso) return outcome;
      if (done) {
        outcome.leaf = std::move(pruned);
        return outcome;
      }
    }
    const auto [low, high] = halve(tight.box);
    outcome.halves.push_back({low, field_.narrow(cell.active, low)});
    outcome.halves.push_back({high, field_.narrow(cell.active, high)});
    return outcome;
  }

 private:
  const Field& field_;
  const TraceCoverOptions& options_;
  double floor_ = 0;
};

}  // namespace

std::optional<std::vector<PrunedField>> cover_for_tracing(const Field& field, const TraceCoverOptions& options, const RunOptions& run) {
  std::vector<PrunedField> leaves;
  if (field.bounds().empty()) return leaves;
  const Subdivision subdivision(field, options);
  tbb::enumerable_thread_specific<Evaluator> evaluators;

  // Level by level, so that neither the order nor the point where max_cells stops depends on the threads.
  std::vector<Cell> level{{field.bounds(), field.active(field.bounds())}};
  std::vector<Outcome> outcomes;
  while (!level.empty()) {
    const bool may_halve = leaves.size() + 2 * level.size() <= options.max_cells;
    outcomes.assign(level.size(), {});
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, level.size(), 8), [&](const tbb::blocked_range<std::size_t>& range) {
      Evaluator& evaluator = evaluators.local();
      for (std::size_t i = range.begin(); i != range.end() && !run.cancelled(); ++i) {
        outcomes[i] = subdivision.examine(level[i], evaluator, may_halve);
        level[i].active = {};
      }
    });
    if (run.cancelled()) return std::nullopt;
    std::vector<Cell> next;
    for (Outcome& outcome : outcomes) {
      if (outcome.leaf) leaves.push_back(std::move(*outcome.leaf));
      for (Cell& half : outcome.halves) {
        if (!half.active.atoms.empty()) next.push_back(std::move(half));
      }
    }
    level = std::move(next);
  }
  return leaves;
}

std::vector<Box> surface_boxes(const std::vector<PrunedField>& cells) {
  const int parts = std::clamp(static_cast<int>(std::cbrt(200000.0 / std::max<std::size_t>(cells.size(), 1))), 1, 24);
  std::vector<std::vector<Box>> found(cells.size());
  tbb::enumerable_thread_specific<Evaluator> evaluators;
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) {
    const Box& cell = cells[i].box();
    if (parts == 1) {
      found[i] = {cell};
      return;
    }
    Box tight;
    const Vec3 size = cell.size() / double(parts);
    for (int k = 0; k < parts * parts * parts; ++k) {
      const Vec3 lo = cell.lo + size * Vec3(k % parts, k / parts % parts, k / (parts * parts));
      const Box part{lo, lo + size};
      const Interval range = evaluators.local().interval(cells[i], part);
      if (range.hi >= kIso && range.lo <= kIso) tight.extend(part);
    }
    if (!tight.empty()) found[i] = {tight};
  });
  std::vector<Box> boxes;
  for (const auto& of_cell : found) boxes.insert(boxes.end(), of_cell.begin(), of_cell.end());
  return boxes;
}

}  // namespace cambium
