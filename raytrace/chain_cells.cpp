#include "raytrace/chain_cells.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cambium {
namespace {

constexpr double kSupport = kSupportPerRadius * (1 + 1e-9);

/// How many radii from an axis the sum of so many chains can reach kIso: one of them is at least kIso over their number there.
double surface_reach(std::uint32_t chains) {
  const auto reach = [](double count) { return kSupportPerRadius * std::sqrt(1 - std::cbrt(kIso / count)) * (1 + 1e-9); };
  static const std::array<double, 8> few = {0, 1, reach(2), reach(3), reach(4), reach(5), reach(6), reach(7)};
  return chains < few.size() ? few[chains] : reach(chains);
}

void extend(RaySegment& hull, const RaySegment& part) { hull = {std::min(hull.begin, part.begin), std::max(hull.end, part.end)}; }
constexpr RaySegment kNowhere{kInfinity, -kInfinity};

/// Of a part of a ray, where at least two chains are active: from the second entry into a support to the last exit but one.
class Overlap {
 public:
  void add(const RaySegment& active) {
    ++chains_;
    begin_ = std::max(first_, std::min(begin_, active.begin));
    first_ = std::min(first_, active.begin);
    end_ = std::min(last_, std::max(end_, active.end));
    last_ = std::max(last_, active.end);
  }
  bool any() const { return chains_ > 1 && begin_ <= end_; }
  RaySegment part() const { return {begin_, end_}; }

 private:
  int chains_ = 0;
  double first_ = kInfinity, begin_ = kInfinity, end_ = -kInfinity, last_ = -kInfinity;
};

/// The most that a cell's chains can be together along a ray. The distance to a segment is at least that to its axis's line, whose
/// square is a parabola.
class MostOfChains {
 public:
  /// Of a segment, `within` its support; opens_chain: of another chain than the one before.
  void add(const AxisView& view, double support, const RaySegment& within, bool opens_chain) {
    if (count_ == kMost) {
      complete_ = false;
      return;
    }
    const double per = 1 / (support * support);
    parabolas_[count_++] = {within.begin, within.end, view.square * per, view.mixed * per, view.d_square * per, opens_chain};
  }
  /// Holds all of the part where they may reach kIso. Parabolas are seen from the ray's place `middle`.
  RaySegment where_surface_may_be(const RaySegment& part, double middle) const {
    if (!complete_) return part;
    RaySegment found = kNowhere;
    const double step = (part.end - part.begin) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const RaySegment stretch{part.begin + i * step, i + 1 == kSteps ? part.end : part.begin + (i + 1) * step};
      if (highest(stretch, middle) >= kIso * (1 - 1e-9)) extend(found, stretch);
    }
    return found;
  }

 private:
  struct Parabola {   // nothing set before it is added: most rays need few
    double begin, end;
    double constant, half_slope, square;
    bool opens_chain;
    double least(const RaySegment& stretch, double middle) const {
      double at = stretch.begin - middle;
      if (const double last = stretch.end - middle; half_slope + square * at < 0) at = half_slope + square * last < 0 ? last : -half_slope / square;
      return constant + (2 * half_slope + square * at) * at;
    }
  };
  double highest(const RaySegment& stretch, double middle) const {
    double sum = 0, least = 1;
    const auto value = [](double y) { return (1 - y) * (1 - y) * (1 - y); };
    for (std::size_t i = 0; i < count_; ++i) {
      const Parabola& it = parabolas_[i];
      if (it.opens_chain) sum += value(least), least = 1;
      if (it.begin <= stretch.end && it.end >= stretch.begin) least = std::min(least, std::max(0.0, it.least(stretch, middle)));
    }
    return sum + value(least);
  }

  static constexpr int kSteps = 4;
  static constexpr std::size_t kMost = 16;
  std::array<Parabola, kMost> parabolas_;   // the first count_
  std::size_t count_ = 0;
  bool complete_ = true;
};


}  // namespace

ChainCells::ChainCells(const SurfaceCover& cover) {
  add_cells(cover);
  segments_.find_wood(cover);
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) { narrow(cells_[i]); });
  std::erase_if(cells_, [](const Cell& cell) { return cell.box.empty(); });
}

void ChainCells::add_cells(const SurfaceCover& cover) {
  for (std::uint32_t i = 0; i < cover.size(); ++i) {
    const PrunedField field = cover.field(i);
    const std::vector<ActiveChain> chains = ActiveChain::blended(field);
    if (chains.empty()) {
      others_.push_back(i);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(entries_.size());
    for (const ActiveChain& chain : chains) {
      const std::uint32_t first_of_chain = segments_.add(chain);
      for (std::size_t k = 0; k < chain.segment_count(); ++k) {
        entries_.push_back({first_of_chain + chain.segment_number(k), k == 0, true});
        segments_.note_cell(entries_.back().segment, i);
      }
    }
    cells_.push_back({field.box(), i, static_cast<std::uint32_t>(chains.size()), first, static_cast<std::uint32_t>(entries_.size()) - first});
  }
}

// Support is more than twice as wide as the solid, and chains blend where one that can be half of the sum meets another's support.
void ChainCells::narrow(Cell& cell) {
  const double reach = surface_reach(cell.chains);
  const std::span<Entry> entries = std::span(entries_).subspan(cell.first, cell.count);
  Box narrowed;
  std::size_t chain = 0, after = 0;   // the entries of the chain at hand
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].starts_chain) {
      chain = i;
      for (after = i + 1; after < entries.size() && !entries[after].starts_chain;) ++after;
    }
    const ChainSegment& segment = segments_[entries[i].segment];
    const Box near = solid_bounds(widened(segment.swept, reach), cell.box);
    entries[i].reaches = !near.empty();
    if (near.empty()) continue;
    if (!segment.is_wood) narrowed.extend(near);
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (k < chain || k >= after) narrowed.extend(solid_bounds(widened(segments_[entries[k].segment].swept, kSupport), near));
  }
  cell.box = narrowed;
  if (!narrowed.empty()) keep_active(cell);
}

// Of the narrowed cell, in place: no more than there were. Chains of few segments come first: where a ray passes them, and so cannot be
// where two chains are, the others need not be looked at.
void ChainCells::keep_active(Cell& cell) {
  const std::span<Entry> entries = std::span(entries_).subspan(cell.first, cell.count);
  std::vector<std::vector<Entry>> chains;
  bool starts_chain = false;
  cell.all_wood = true;
  for (const Entry& entry : entries) {
    starts_chain = starts_chain || entry.starts_chain;
    const ChainSegment& segment = segments_[entry.segment];
    if (solid_bounds(widened(segment.swept, kSupport), cell.box).empty()) continue;
    if (starts_chain) chains.emplace_back();
    chains.back().push_back({entry.segment, starts_chain, entry.reaches});
    starts_chain = false;
    cell.all_wood = cell.all_wood && segment.is_wood;
  }
  std::stable_sort(chains.begin(), chains.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  auto to = entries.begin();
  for (const std::vector<Entry>& chain : chains) to = std::copy(chain.begin(), chain.end(), to);
  cell.count = static_cast<std::uint32_t>(to - entries.begin());
  cell.chains = static_cast<std::uint32_t>(chains.size());
}

ChainVerdict ChainCells::meet_lone(std::span<const Entry> entries, const Ray& ray, const RaySegment& part) const {
  ChainVerdict best;
  for (const Entry& entry : entries) {
    if (!entry.reaches || segments_[entry.segment].is_wood) continue;
    const auto t = segments_.meet(entry.segment, ray, part);
    if (t && *t < best.t) best = {ChainVerdict::How::kHit, *t, entry.segment, {}};
  }
  return best;
}

ChainVerdict ChainCells::judge(std::size_t k, const Ray& ray, const RaySegment& part, PlaceWanted wanted) const {
  const Cell& cell = cells_[k];
  const auto entries = entries_of(cell);
  if (cell.chains == 1) return meet_lone(entries, ray, part);

  const double middle = 0.5 * (part.begin + part.end);
  const RayLook look{ray.at(middle), ray.direction, part.end - middle};
  ChainVerdict solid;
  double wood_or_solid = kInfinity;   // wood in the cell, and not what the ray met elsewhere: that would depend on the order of cells
  Overlap overlap;
  MostOfChains most;
  RaySegment active = kNowhere;   // of the chain at hand
  std::uint32_t passed = 0;       // chains that are nowhere active on the part
  const auto finish_chain = [&] {
    if (active.begin <= active.end) overlap.add(active);
    else ++passed;
    active = kNowhere;
  };
  for (const Entry& entry : entries) {
    if (entry.starts_chain && &entry != &entries.front()) {
      finish_chain();
      if (passed + 1 >= cell.chains && cell.all_wood) return {};
    }
    const ChainSegment& segment = segments_[entry.segment];
    const double support = kSupport * segment.thickest;
    if (look.passes(segment, support)) continue;
    const AxisView view(segment.swept, ray, middle);
    if (!view.comes_within(support)) continue;
    const auto within = part_within(segment.swept, support, part, view);
    if (!within) continue;
    const bool is_next = !(active.begin <= active.end);
    extend(active, *within);
    most.add(view, support, *within, is_next);
    if (!entry.reaches || !view.comes_within(segment.thickest)) continue;
    const auto t = first_inside(segment.swept, ray, part, view);
    if (!t) continue;
    wood_or_solid = std::min(wood_or_solid, *t);
    if (segment.is_wood) continue;
    if (wanted == PlaceWanted::kAny) return {ChainVerdict::How::kHit, *t, entry.segment, {}};
    if (*t < solid.t) solid = {ChainVerdict::How::kHit, *t, entry.segment, {}};
  }
  finish_chain();
  // The first solid is a hit, and where there is none a miss, if before it no two chains are active at once: each is as if alone.
  if (!overlap.any()) return solid;
  const RaySegment both{overlap.part().begin, std::min(overlap.part().end, wood_or_solid)};
  if (!(both.begin <= both.end)) return solid;
  const RaySegment search = most.where_surface_may_be(both, middle);
  if (!(search.begin <= search.end)) return solid;
  return {ChainVerdict::How::kSearch, solid.t, solid.segment, search};
}

std::size_t ChainCells::memory_bytes() const {
  return cells_.capacity() * sizeof(Cell) + entries_.capacity() * sizeof(Entry) + others_.capacity() * sizeof(std::uint32_t) +
         segments_.memory_bytes();
}

}  // namespace cambium
