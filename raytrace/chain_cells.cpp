#include "raytrace/chain_cells.h"

#include "blobtree/lone_chain.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cambium {
namespace {

constexpr std::uint32_t kUnseen = 0xffffffffu;
constexpr double kSupport = kSupportPerRadius * (1 + 1e-9);

/// How many radii from an axis the sum of so many chains can reach kIso: one of them is at least kIso over their number there.
double surface_reach(std::uint32_t chains) {
  const auto reach = [](double count) { return kSupportPerRadius * std::sqrt(1 - std::cbrt(kIso / count)) * (1 + 1e-9); };
  static const std::array<double, 8> few = {0, 1, reach(2), reach(3), reach(4), reach(5), reach(6), reach(7)};
  return chains < few.size() ? few[chains] : reach(chains);
}

/// Segments of all chains that are anywhere in the cells, each made once.
class SegmentTable {
 public:
  /// Where a chain's segments begin.
  std::uint32_t add(const ActiveChain& chain) {
    if (chain.primitive() >= first_.size()) first_.resize(chain.primitive() + 1, kUnseen);
    std::uint32_t& first = first_[chain.primitive()];
    if (first == kUnseen) {
      first = static_cast<std::uint32_t>(segments_.size());
      const auto nodes = chain.nodes();
      for (std::size_t i = 1; i < nodes.size(); ++i)
        segments_.push_back(swept_segment(nodes[i - 1].position, nodes[i - 1].radius, nodes[i].position, nodes[i].radius));
    }
    return first;
  }
  std::vector<SweptSegment<double>> take() { return std::move(segments_); }

 private:
  std::vector<std::uint32_t> first_;   ///< by primitive
  std::vector<SweptSegment<double>> segments_;
};

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

void extend(RaySegment& hull, const RaySegment& part) { hull = {std::min(hull.begin, part.begin), std::max(hull.end, part.end)}; }
constexpr RaySegment kNowhere{kInfinity, -kInfinity};

}  // namespace

ChainCells::ChainCells(const SurfaceCover& cover) {
  SegmentTable table;
  for (std::uint32_t i = 0; i < cover.size(); ++i) {
    const PrunedField field = cover.field(i);
    const std::vector<ActiveChain> chains = ActiveChain::blended(field);
    if (chains.empty()) {
      others_.push_back(i);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(entries_.size());
    for (const ActiveChain& chain : chains) {
      const std::uint32_t first_of_chain = table.add(chain);
      for (std::size_t k = 0; k < chain.segment_count(); ++k)
        entries_.push_back({first_of_chain + chain.segment_number(k), k == 0, true});
    }
    cells_.push_back({field.box(), i, static_cast<std::uint32_t>(chains.size()), first, static_cast<std::uint32_t>(entries_.size()) - first});
  }
  for (const SweptSegment<double>& k : table.take()) pieces_.push_back({k.a + 0.5 * k.end * k.axis, 0.5 * k.end, thickest(k), k});
  // Support is more than twice as wide as the solid: cells that no surface reaches go.
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
    Cell& cell = cells_[i];
    const double reach = surface_reach(cell.chains);
    bool any = false;
    for (std::uint32_t k = cell.first; k < cell.first + cell.count; ++k)
      any |= entries_[k].reaches = !solid_bounds(widened(pieces_[entries_[k].segment].segment, reach), cell.box).empty();
    if (!any) cell.count = 0;
  });
  std::erase_if(cells_, [](const Cell& cell) { return cell.count == 0; });
}

Box ChainCells::surface_bounds(std::size_t k) const {
  const Cell& cell = cells_[k];
  Box box;
  for (const Entry& entry : entries_of(cell))
    if (entry.reaches) box.extend(solid_bounds(widened(pieces_[entry.segment].segment, surface_reach(cell.chains)), cell.box));
  return box;
}

bool ChainCells::Look::passes(const Piece& piece, double reach) const {
  const Vec3 v = middle - piece.middle;
  const double along = glm::dot(v, direction), ball = piece.half_length + reach, to_part = std::max(0.0, std::abs(along) - half);
  return glm::dot(v, v) - along * along + to_part * to_part > ball * ball * (1 + 1e-9);
}

ChainVerdict ChainCells::meet_lone(std::span<const Entry> entries, const Ray& ray, const RaySegment& part) const {
  ChainVerdict best;
  const double middle = 0.5 * (part.begin + part.end);
  const Look look{ray.at(middle), ray.direction, part.end - middle};
  for (const Entry& entry : entries) {
    if (!entry.reaches) continue;
    const Piece& piece = pieces_[entry.segment];
    if (look.passes(piece, piece.thickest)) continue;
    const SweptSegment<double>& segment = piece.segment;
    const AxisView view(segment, ray, middle);
    if (!view.comes_within(piece.thickest)) continue;
    const auto t = first_inside(segment, ray, part, view);
    if (t && *t < best.t) best = {ChainVerdict::How::kHit, *t, entry.segment, {}};
  }
  return best;
}

ChainVerdict ChainCells::judge(std::size_t k, const Ray& ray, const RaySegment& part, PlaceWanted wanted) const {
  const Cell& cell = cells_[k];
  const auto entries = entries_of(cell);
  if (cell.chains == 1) return meet_lone(entries, ray, part);

  const double middle = 0.5 * (part.begin + part.end);
  const Look look{ray.at(middle), ray.direction, part.end - middle};
  ChainVerdict solid;
  Overlap overlap;
  RaySegment active = kNowhere;   // of the chain at hand
  double least_square = 1, most_in_all = 0;   // its (distance over support)^2, and the chains' largest values together
  const auto finish_chain = [&] {
    if (active.begin <= active.end) overlap.add(active);
    most_in_all += (1 - least_square) * (1 - least_square) * (1 - least_square);
    active = kNowhere;
    least_square = 1;
  };
  for (const Entry& entry : entries) {
    if (entry.starts_chain) finish_chain();
    const Piece& piece = pieces_[entry.segment];
    const double support = kSupport * piece.thickest;
    if (look.passes(piece, support)) continue;
    const SweptSegment<double>& segment = piece.segment;
    const AxisView view(segment, ray, middle);
    if (!view.comes_within(support)) continue;
    const auto within = part_within(segment, support, part, view);
    if (!within) continue;
    extend(active, *within);
    least_square = std::min(least_square, view.nearest_square() / (support * support));
    if (!entry.reaches || !view.comes_within(piece.thickest)) continue;
    const auto t = first_inside(segment, ray, part, view);
    if (t && wanted == PlaceWanted::kAny) return {ChainVerdict::How::kHit, *t, entry.segment, {}};
    if (t && *t < solid.t) solid = {ChainVerdict::How::kHit, *t, entry.segment, {}};
  }
  finish_chain();
  // The first solid is a hit, and where there is none a miss, if before it no two chains are active at once: each is as if alone.
  if (most_in_all < kIso * (1 - 1e-9) || !overlap.any()) return solid;
  RaySegment search = overlap.part();
  search.end = std::min(search.end, solid.t);
  if (search.begin <= search.end) search = near_surface(cell, ray, search);
  if (!(search.begin <= search.end)) return solid;
  return {ChainVerdict::How::kSearch, solid.t, solid.segment, search};
}

RaySegment ChainCells::near_surface(const Cell& cell, const Ray& ray, const RaySegment& part) const {
  const double middle = 0.5 * (part.begin + part.end), reach = surface_reach(cell.chains);
  const Look look{ray.at(middle), ray.direction, part.end - middle};
  RaySegment near = kNowhere;
  for (const Entry& entry : entries_of(cell)) {
    if (!entry.reaches) continue;
    const Piece& piece = pieces_[entry.segment];
    const SweptSegment<double>& segment = piece.segment;
    const double distance = reach * piece.thickest;
    if (look.passes(piece, distance)) continue;
    const AxisView view(segment, ray, middle);
    if (!view.comes_within(distance)) continue;
    if (const auto within = part_within(segment, distance, part, view)) extend(near, *within);
  }
  return near;
}

double ChainCells::radius(std::uint32_t segment, const Vec3& p) const {
  const SweptSegment<double>& k = pieces_[segment].segment;
  return k.radius_at(closest_parameter(k, p - k.a));
}

std::size_t ChainCells::memory_bytes() const {
  return cells_.capacity() * sizeof(Cell) + entries_.capacity() * sizeof(Entry) + others_.capacity() * sizeof(std::uint32_t) +
         pieces_.capacity() * sizeof(pieces_[0]);
}

}  // namespace cambium
