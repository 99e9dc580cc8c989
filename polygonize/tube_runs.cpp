#include "polygonize/tube_runs.h"

#include "blobtree/box_tree.h"
#include "polygonize/ordered_chunks.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kCellsPerTask = 4096, kChainsPerTask = 16;
constexpr double kStraight = 0.5;      // cosine: a chain that turns more in a cell, or as a whole, may come to lie beside itself
// In edges of the leaves there: what stays of a chain around its ends, what at least between two runs (of less there may be islands
// instead of a whole ring of leaves), from the ends of a run to its rings, and how long a run must be to save more than its ends cost.
constexpr double kTips = 1.3, kBetween = 3, kJoin = 1.2, kShortest = 3;
constexpr double kApart = 1.5;         // in sums of radii: of the axes of parts of one chain that are no neighbours

/// Part of a chain, in segments and parts of segments from its root.
struct TakenPart {
  std::uint32_t primitive = 0;
  Stretch nodes;
};

/// Chains with lone cells, and the parts of chains that share cells with other things.
struct Found {
  std::vector<ActiveChain> lone;
  std::vector<TakenPart> taken;
};

bool turns_little(const ActiveChain& chain) {
  const auto nodes = chain.nodes();
  Vec3 first(0.0);
  for (std::size_t k = 0; k < chain.segment_count(); ++k) {
    const std::uint32_t number = chain.segment_number(k);
    if (number != chain.segment_number(0) + k) return false;
    const Vec3 along = nodes[number + 1].position - nodes[number].position;
    const double length = glm::length(along);
    if (!(length > 0)) continue;
    if (first == Vec3(0.0)) first = along / length;
    if (glm::dot(first, along) < kStraight * length) return false;
  }
  return true;
}

bool may_meet_itself(const ChainPath& path) {
  const Vec3 whole = path.nodes().back().position - path.nodes().front().position;
  for (std::size_t k = 0; k < path.segment_count(); ++k) {
    if (glm::dot(whole, path.direction(k)) < kStraight * glm::length(whole)) return true;
  }
  return false;
}

/// The least distance between two segments a + s u and b + t v, s and t in [0, 1] (Ericson 2005, section 5.1.9).
double distance_between(const Vec3& a, const Vec3& u, const Vec3& b, const Vec3& v) {
  const Vec3 w = a - b;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v), uw = glm::dot(u, w), vw = glm::dot(v, w);
  const double parallel = uu * vv - uv * uv;
  double s = parallel > 0 ? std::clamp((uv * vw - uw * vv) / parallel, 0.0, 1.0) : 0.0;
  double t = vv > 0 ? std::clamp((uv * s + vw) / vv, 0.0, 1.0) : 0.0;
  s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  return glm::distance(a + s * u, b + t * v);
}

}  // namespace

/// Finds the runs of one chain.
class TubeSearch {
 public:
  TubeSearch(const SurfaceCover& cover, const LeafRule& leaves, const TubeRule& rule, const RunOptions& run)
      : cover_(cover), leaves_(leaves), rule_(rule), run_(run) {}

  /// taken: of that chain.
  std::vector<TubeRun> runs_of(std::uint32_t primitive, const ChainPath& path, std::span<const TakenPart> taken) const {
    std::vector<Stretch> away = ends_of(path);
    for (const TakenPart& part : taken) away.push_back({metres(path, part.nodes.begin), metres(path, part.nodes.end)});
    if (may_meet_itself(path)) add_parts_beside_itself(path, away);
    away = joined(std::move(away));
    for (Stretch& part : away) part = widened(part, kBetween * leaf_at(path, (part.begin + part.end) / 2));
    std::vector<TubeRun> runs;
    double from = 0;
    for (const Stretch& part : away) {
      if (part.begin > from) add_runs(primitive, path, {from, part.begin}, runs);
      from = std::max(from, part.end);
    }
    return runs;
  }

 private:
  static double metres(const ChainPath& path, double node) {
    const auto whole = std::min(static_cast<std::size_t>(node), path.segment_count());
    const double before = path.node_at(whole), part = node - static_cast<double>(whole);
    return part > 0 && whole < path.segment_count() ? before + part * (path.node_at(whole + 1) - before) : before;
  }
  /// The edge of the leaves that hold nothing but the chain there, before any is cut.
  double leaf_at(const ChainPath& path, double s) const {
    const double most = leaves_.edge(path.radius(s)), unit = cover_.grid().cell;
    return most > unit ? std::ldexp(unit, std::ilogb(most / unit)) : most;
  }
  /// To a length, in the middle of what it was, unless it is as long already.
  static Stretch widened(const Stretch& part, double length) {
    const double more = std::max(0.0, length - (part.end - part.begin)) / 2;
    return {part.begin - more, part.end + more};
  }
  std::vector<Stretch> ends_of(const ChainPath& path) const {
    std::vector<Stretch> ends;
    for (const double s : {0.0, path.length()}) ends.push_back(widened({s, s}, 2 * kTips * leaf_at(path, s)));
    return ends;
  }
  /// In order, none touching the next.
  static std::vector<Stretch> joined(std::vector<Stretch> parts) {
    std::sort(parts.begin(), parts.end(), [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
    std::vector<Stretch> whole;
    for (const Stretch& part : parts) {
      if (whole.empty() || part.begin > whole.back().end) whole.push_back(part);
      whole.back().end = std::max(whole.back().end, part.end);
    }
    return whole;
  }

  void add_parts_beside_itself(const ChainPath& path, std::vector<Stretch>& away) const {
    const auto nodes = path.nodes();
    const auto radius = [&](std::size_t k) { return std::max(nodes[k].radius, nodes[k + 1].radius); };
    const BoxTree boxes(path.segment_count(), [&](std::uint32_t k) {
      Box box;
      box.extend(nodes[k].position);
      box.extend(nodes[k + 1].position);
      return box.padded(kApart * radius(k));
    });
    for (std::size_t leaf = 0; leaf < boxes.leaf_count(); ++leaf) {
      boxes.overlaps(leaf, [&](std::uint32_t i, std::uint32_t j) {
        const std::size_t k = std::min(i, j), m = std::max(i, j);
        const double reach = kApart * (radius(k) + radius(m));
        if (path.node_at(m) - path.node_at(k + 1) < 2 * reach) return;   // neighbours: bends are looked at where rings are planned
        const Vec3 u = nodes[k + 1].position - nodes[k].position, v = nodes[m + 1].position - nodes[m].position;
        if (distance_between(nodes[k].position, u, nodes[m].position, v) > reach) return;
        for (const std::size_t own : {k, m}) away.push_back({path.node_at(own), path.node_at(own + 1)});
      });
    }
  }

  // Where a bend is too sharp for rings the run is parted.
  void add_runs(std::uint32_t primitive, const ChainPath& path, const Stretch& free, std::vector<TubeRun>& runs) const {
    std::vector<Stretch> todo{free};
    while (!todo.empty() && !run_.cancelled()) {
      const Stretch stretch = todo.back();
      todo.pop_back();
      const double leaf_begin = leaf_at(path, stretch.begin), leaf_end = leaf_at(path, stretch.end);
      if (stretch.end - stretch.begin < kShortest * std::max(leaf_begin, leaf_end)) continue;
      const Stretch inner{stretch.begin + kJoin * leaf_begin, stretch.end - kJoin * leaf_end};
      auto parts = plan_rings(path, inner, rule_, run_);
      const double near_begin = inner.begin + std::max(leaf_begin, 0.5 * path.radius(inner.begin));
      const double near_end = inner.end - std::max(leaf_end, 0.5 * path.radius(inner.end));
      const bool whole = parts.size() == 1 && parts[0].front().at < near_begin && parts[0].back().at > near_end;
      if (whole) {
        if (is_alone(primitive, path, parts[0])) runs.push_back({0, stretch, std::move(parts[0])});
        continue;
      }
      for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
        Stretch less{part->front().at, part->back().at};
        if (less.begin > near_begin) less.begin += leaf_at(path, less.begin); else less.begin = stretch.begin;
        if (less.end < near_end) less.end -= leaf_at(path, less.end); else less.end = stretch.end;
        if (!less.empty()) todo.push_back(less);
      }
    }
  }

  // The cells around a stretch are all of the chain or all of none: inside of something thicker it has no surface.
  bool is_alone(std::uint32_t primitive, const ChainPath& path, const std::vector<TubeRing>& rings) const {
    for (const TubeRing* ring : {&rings.front(), &rings[rings.size() / 2], &rings.back()}) {
      const auto cell = cover_.find(path.surface(ring->at, ring->side).position);
      if (!cell) return false;
      const auto lone = LoneChain::of(cover_.cube_field(*cell));
      if (!lone || lone->primitive() != primitive) return false;
    }
    return true;
  }

  const SurfaceCover& cover_;
  const LeafRule& leaves_;
  const TubeRule& rule_;
  const RunOptions& run_;
};

namespace {

// Of a cell: the parts of chains whose surface may be in it.
void append_parts_of(const std::vector<ActiveChain>& chains, const Box& cube, std::vector<TakenPart>& taken) {
  for (const ActiveChain& chain : chains) {
    const auto nodes = chain.nodes();
    for (std::size_t k = 0; k < chain.segment_count(); ++k) {
      const std::uint32_t number = chain.segment_number(k);
      const auto part = reaching(nodes[number], nodes[number + 1], cube);
      if (!part) continue;
      const double length = std::max(glm::distance(nodes[number].position, nodes[number + 1].position), 1e-300);
      const Stretch found{number + part->begin / length, number + part->end / length};
      if (!taken.empty() && taken.back().primitive == chain.primitive() && taken.back().nodes.end >= found.begin &&
          taken.back().nodes.begin <= found.begin) {
        taken.back().nodes.end = std::max(taken.back().nodes.end, found.end);
      } else {
        taken.push_back({chain.primitive(), found});
      }
    }
  }
}

}  // namespace

std::optional<TubeRuns> TubeRuns::find(const SurfaceCover& cover, const LeafRule& leaves, const TubeRule& rule, const RunOptions& run) {
  auto found = in_chunks<Found>(cover.size(), kCellsPerTask, [&](Found& part, std::size_t begin, std::size_t end) {
    std::vector<ActiveChain> chains;
    for (std::size_t i = begin; i < end && !run.cancelled(); ++i) {
      const PrunedField field = cover.cube_field(i);
      if (const auto lone = LoneChain::of(field); lone && turns_little(*lone)) {
        if (part.lone.empty() || part.lone.back().primitive() != lone->primitive()) part.lone.push_back(*lone);
        continue;
      }
      chains.clear();
      ActiveChain::append(field, chains);
      append_parts_of(chains, field.box(), part.taken);
    }
  });
  if (run.cancelled()) return std::nullopt;
  Found all;
  for (Found& part : found) {
    all.lone.insert(all.lone.end(), part.lone.begin(), part.lone.end());
    all.taken.insert(all.taken.end(), part.taken.begin(), part.taken.end());
    part = {};
  }
  const auto by_primitive = [](const auto& a, const auto& b) { return a.primitive() < b.primitive(); };
  std::stable_sort(all.lone.begin(), all.lone.end(), by_primitive);
  all.lone.erase(std::unique(all.lone.begin(), all.lone.end(), [](const auto& a, const auto& b) { return a.primitive() == b.primitive(); }),
                 all.lone.end());
  std::stable_sort(all.taken.begin(), all.taken.end(), [](const TakenPart& a, const TakenPart& b) { return a.primitive < b.primitive; });

  TubeRuns result;
  for (const ActiveChain& chain : all.lone) {
    result.primitives_.push_back(chain.primitive());
    result.paths_.emplace_back(chain.nodes());
  }
  const TubeSearch search(cover, leaves, rule, run);
  std::vector<std::vector<TubeRun>> of_path(all.lone.size());
  tbb::parallel_for(std::size_t{0}, of_path.size(), [&](std::size_t i) {
    if (run.cancelled()) return;
    const std::uint32_t primitive = result.primitives_[i];
    const auto first = std::lower_bound(all.taken.begin(), all.taken.end(), primitive, [](const TakenPart& p, std::uint32_t id) { return p.primitive < id; });
    const auto last = std::upper_bound(first, all.taken.end(), primitive, [](std::uint32_t id, const TakenPart& p) { return id < p.primitive; });
    of_path[i] = search.runs_of(primitive, result.paths_[i], {first, last});
  });
  if (run.cancelled()) return std::nullopt;
  for (std::uint32_t i = 0; i < of_path.size(); ++i) {
    result.first_run_.push_back(static_cast<std::uint32_t>(result.runs_.size()));
    for (TubeRun& made : of_path[i]) {
      made.path = i;
      result.runs_.push_back(std::move(made));
    }
  }
  result.first_run_.push_back(static_cast<std::uint32_t>(result.runs_.size()));
  return result;
}

void TubeRuns::remove(const std::vector<std::uint32_t>& listed) {
  std::vector<TubeRun> kept;
  std::vector<std::uint32_t> first(paths_.size() + 1, 0);
  for (std::uint32_t i = 0; i < runs_.size(); ++i) {
    if (std::binary_search(listed.begin(), listed.end(), i)) continue;
    ++first[runs_[i].path + 1];
    kept.push_back(std::move(runs_[i]));
  }
  for (std::size_t i = 0; i < paths_.size(); ++i) first[i + 1] += first[i];
  runs_ = std::move(kept);
  first_run_ = std::move(first);
}

std::optional<std::uint32_t> TubeRuns::path_of(const ActiveChain& chain) const {
  const auto known = std::lower_bound(primitives_.begin(), primitives_.end(), chain.primitive());
  if (known == primitives_.end() || *known != chain.primitive()) return std::nullopt;
  return static_cast<std::uint32_t>(known - primitives_.begin());
}

std::span<const TubeRun> TubeRuns::of_path(std::uint32_t path) const {
  return std::span(runs_).subspan(first_run_[path], first_run_[path + 1] - first_run_[path]);
}

TubeRuns::InCell TubeRuns::in(const PrunedField& cell) const {
  InCell view;
  if (runs_.empty()) return view;
  const auto lone = LoneChain::of(cell);
  if (!lone || !turns_little(*lone)) return view;
  const auto path = path_of(*lone);
  if (!path) return view;
  view.path_ = &paths_[*path];
  view.first_ = lone->segment_number(0);
  view.last_ = lone->segment_number(lone->segment_count() - 1);
  const double begin = view.path_->node_at(view.first_), end = view.path_->node_at(view.last_ + 1);
  const auto runs = of_path(*path);
  const auto first = std::lower_bound(runs.begin(), runs.end(), begin, [](const TubeRun& run, double s) { return run.stretch.end < s; });
  auto last = first;
  while (last != runs.end() && last->stretch.begin < end) ++last;
  view.runs_ = runs.subspan(static_cast<std::size_t>(first - runs.begin()), static_cast<std::size_t>(last - first));
  return view;
}

std::optional<TubeRuns::End> TubeRuns::nearest_end(const PrunedField& cell, const Vec3& p) const {
  std::vector<ActiveChain> chains;
  ActiveChain::append(cell, chains);
  std::optional<End> found;
  double least = kInfinity;
  for (const ActiveChain& chain : chains) {
    const auto number = path_of(chain);
    if (!number) continue;
    const ChainPath& path = paths_[*number];
    const double s = path.nearest(p, chain.segment_number(0), chain.segment_number(chain.segment_count() - 1));
    const double off = std::abs(path.distance(s, p));
    for (std::uint32_t i = first_run_[*number]; i < first_run_[*number + 1]; ++i) {
      const Stretch& stretch = runs_[i].stretch;
      for (const int end : {0, 1}) {
        const double away = off + std::abs(s - (end ? stretch.end : stretch.begin));
        if (away < least) least = away, found = End{i, end};
      }
    }
  }
  return found;
}

bool TubeRuns::InCell::holds(const Vec3& p) const {
  const double s = place(p);
  return std::any_of(runs_.begin(), runs_.end(), [&](const TubeRun& run) { return run.stretch.begin < s && s < run.stretch.end; });
}

TubeRuns::Share TubeRuns::InCell::share(const Box& box) const {
  const auto reach = path_->reaching(box, first_, last_);
  if (!reach) return Share::kAll;
  Share share = Share::kNone;
  for (const TubeRun& run : runs_) {
    if (run.stretch.begin < reach->begin && reach->end < run.stretch.end) return Share::kAll;
    if (run.stretch.begin <= reach->end && reach->begin <= run.stretch.end) share = Share::kPart;
  }
  return share;
}

}  // namespace cambium
