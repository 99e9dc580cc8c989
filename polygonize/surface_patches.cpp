#include "polygonize/surface_patches.h"

#include "polygonize/cube_edges.h"
#include "polygonize/ordered_chunks.h"

#include <algorithm>

namespace cambium {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// A crossed edge on a leaf's boundary, and the leaves across the two faces that the surface leaves it through.
struct Incident {
  std::uint32_t edge = 0;
  std::array<std::uint32_t, 2> across{};
  std::array<std::uint32_t, 2> next{kNone, kNone};   // incidents of the same leaf
  bool visited = false;
};

// Where a leaf sits around an edge: its first quadrant in ring order, and the leaves before and after it.
Incident incident_of(const MinimalEdge& edge, std::uint32_t id, std::uint32_t leaf) {
  int begin = 0;
  while (!(edge.leaves[kRing[begin]] == leaf && edge.leaves[kRing[(begin + 3) % 4]] != leaf)) ++begin;
  int end = begin;
  while (edge.leaves[kRing[(end + 1) % 4]] == leaf) end = (end + 1) % 4;
  Incident incident;
  incident.edge = id;
  incident.across = {edge.leaves[kRing[(begin + 3) % 4]], edge.leaves[kRing[(end + 1) % 4]]};
  return incident;
}

/// A face that the surface crosses in several lines: the edges that each line runs between.
struct ManyLines {
  std::uint32_t leaf = 0, other = 0;                         // on its two sides, the one that told of it first
  std::vector<std::array<std::uint32_t, 2>> lines;
};

std::uint64_t key_of(std::uint32_t leaf, std::uint32_t other) {
  return std::uint64_t{std::min(leaf, other)} << 32 | std::max(leaf, other);
}

struct Cycles {
  std::vector<std::uint32_t> order, lengths;
  std::vector<std::uint8_t> open;
  std::size_t cycle_of(std::uint32_t edge) const {
    std::size_t at = static_cast<std::size_t>(std::find(order.begin(), order.end(), edge) - order.begin()), cycle = 0;
    while (at >= lengths[cycle]) at -= lengths[cycle++];
    return cycle;
  }
};

class LeafTracer {
 public:
  LeafTracer(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges) : tree_(tree), edges_(edges) {}

  std::vector<ManyLines> faces;   ///< met on the way
  const RelinkedFaces* relinked = nullptr;

  /// Appends the leaf's cycles. What is open is followed from an end, the rest is closed then.
  void trace(std::uint32_t leaf, std::span<const std::uint32_t> edges, Cycles& out) {
    link(leaf, edges);
    for (const bool open : {true, false})
      for (std::uint32_t i = 0; i < incidents_.size(); ++i) {
        if (!incidents_[i].visited && (!open || incidents_[i].next[1] == kNone)) follow(i, open, out);
      }
  }

  /// Two crossings of one face are joined by the surface's line across it.
  void link(std::uint32_t leaf, std::span<const std::uint32_t> edges) {
    incidents_.clear();
    for (const std::uint32_t id : edges) incidents_.push_back(incident_of(edges_[id], id, leaf));
    sides_.clear();
    for (std::uint32_t i = 0; i < incidents_.size(); ++i)
      for (int s = 0; s < 2; ++s) sides_.push_back({incidents_[i].across[s], i});
    std::sort(sides_.begin(), sides_.end());
    for (std::size_t begin = 0; begin < sides_.size();) {
      std::size_t end = begin;
      while (end < sides_.size() && sides_[end].first == sides_[begin].first) ++end;
      if (end - begin == 2) {
        join(sides_[begin].second, sides_[begin + 1].second);
      } else if (end - begin > 2) {   // else the line's other end is beside nothing
        link_many(leaf, sides_[begin].first, begin, end);
      }
      begin = end;
    }
  }

 private:
  void follow(std::uint32_t first, bool open, Cycles& out) {
    std::uint32_t length = 0, at = first, from = kNone;
    do {
      incidents_[at].visited = true;
      out.order.push_back(incidents_[at].edge);
      ++length;
      const auto& next = incidents_[at].next;
      const std::uint32_t to = next[0] != from ? next[0] : next[1];
      from = at, at = to;
    } while (at != kNone && !incidents_[at].visited);
    out.lengths.push_back(length);
    out.open.push_back(open);
  }

  void join(std::uint32_t i, std::uint32_t j) {
    auto& a = incidents_[i].next;
    auto& b = incidents_[j].next;
    a[a[0] != kNone] = j;
    b[b[0] != kNone] = i;
  }

  // Around the face's boundary, every stretch that is inside is cut off by a line of its own.
  void link_many(std::uint32_t leaf, std::uint32_t other, std::size_t begin, std::size_t end) {
    if (relinked) {
      if (const auto known = relinked->find(key_of(leaf, other)); known != relinked->end()) {
        for (const auto& line : known->second) join(incident(line[0]), incident(line[1]));
        return;
      }
    }
    const FaceBoundary boundary(tree_, leaf, other);
    around_.clear();
    for (std::size_t i = begin; i < end; ++i) {
      around_.push_back(boundary.at(tree_, edges_[incidents_[sides_[i].second].edge], sides_[i].second));
    }
    std::sort(around_.begin(), around_.end());
    ManyLines face;
    for (std::size_t i = 0; i < around_.size(); ++i) {
      const Around& next = around_[(i + 1) % around_.size()];
      if (!around_[i].enters || next.enters) continue;   // as above
      const std::uint32_t from = around_[i].incident, to = next.incident;
      join(from, to);
      face.lines.push_back({incidents_[from].edge, incidents_[to].edge});
    }
    face.leaf = leaf, face.other = other;
    faces.push_back(std::move(face));
  }

  std::uint32_t incident(std::uint32_t edge) const {
    std::uint32_t i = 0;
    while (incidents_[i].edge != edge) ++i;
    return i;
  }

  struct Around {
    std::uint64_t way = 0;       // along the boundary
    std::uint32_t incident = 0;
    bool enters = false;         // goes inside there
    bool operator<(const Around& o) const { return way < o.way; }
  };

  /// The boundary of the face between two leaves, walked once around.
  struct FaceBoundary {
    int u = 0, v = 0;
    std::array<std::uint32_t, 2> low{};
    std::uint64_t side = 0;      // in half units

    FaceBoundary(const SurfaceOctree& tree, std::uint32_t leaf, std::uint32_t other) {
      const OctreeLeaf *small = &tree.leaves()[leaf], *large = &tree.leaves()[other];
      if (small->level > large->level) std::swap(small, large);
      int across = 0;
      for (int a = 0; a < 3; ++a) {
        const std::uint32_t begin = small->place[a], from = large->place[a];
        if (begin + (1u << small->level) == from || from + (1u << large->level) == begin) across = a;
      }
      u = (across + 1) % 3, v = (across + 2) % 3;
      low = {small->place[u], small->place[v]};
      side = std::uint64_t{2} << small->level;
    }

    Around at(const SurfaceOctree& tree, const MinimalEdge& edge, std::uint32_t incident) const {
      const OctreeLeaf& owner = tree.leaves()[edge.owner()];
      const int corner = edge_low_corner(edge.edge_of_owner());
      std::array<std::uint64_t, 2> from_low;   // of the edge's middle, half units
      for (int k = 0; k < 2; ++k) {
        const int a = k == 0 ? u : v;
        const std::uint32_t begin = owner.place[a] + (static_cast<std::uint32_t>(corner >> a & 1) << owner.level);
        from_low[k] = 2 * std::uint64_t{begin - low[k]} + (edge.axis == a ? std::uint64_t{1} << owner.level : 0);
      }
      Around result{0, incident, false};
      bool forwards = true;
      if (edge.axis == u) {
        forwards = from_low[1] == 0;
        result.way = forwards ? from_low[0] : 3 * side - from_low[0];
      } else {
        forwards = from_low[0] != 0;
        result.way = forwards ? side + from_low[1] : 4 * side - from_low[1];
      }
      result.enters = forwards != edge.low_inside;
      return result;
    }
  };

  const SurfaceOctree& tree_;
  const std::vector<MinimalEdge>& edges_;
  std::vector<Incident> incidents_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sides_;   // leaf across, incident
  std::vector<Around> around_;
};

constexpr std::size_t kLeavesPerTask = 2048;

std::size_t place_of(const LeafEdges& around, std::uint32_t leaf) {
  return static_cast<std::size_t>(std::lower_bound(around.leaves.begin(), around.leaves.end(), leaf) - around.leaves.begin());
}

bool lists(const LeafEdges& around, std::uint32_t leaf) {
  const std::size_t place = place_of(around, leaf);
  return place < around.leaves.size() && around.leaves[place] == leaf;
}

/// Links the lines of a face so that no two of them join the same cycles on both sides. True if any had to change.
bool settle(ManyLines& face, const LeafEdges& around, LeafTracer& tracer, RelinkedFaces& relinked) {
  bool changed = false, again = true;
  for (std::size_t cuts = 0; again && cuts < face.lines.size(); ++cuts) {   // each makes a cycle more, and there are no more than lines
    again = false;
    Cycles here, there;
    tracer.trace(face.leaf, around.of(place_of(around, face.leaf)), here);
    tracer.trace(face.other, around.of(place_of(around, face.other)), there);
    tracer.faces.clear();
    for (std::size_t i = 0; i < face.lines.size() && !again; ++i) {
      for (std::size_t j = i + 1; j < face.lines.size() && !again; ++j) {
        auto &a = face.lines[i], &b = face.lines[j];
        if (here.cycle_of(a[0]) != here.cycle_of(b[0]) || there.cycle_of(a[0]) != there.cycle_of(b[0])) continue;
        std::swap(a[1], b[1]);   // lines run with the inside on one hand: changing their ends cuts a cycle in two
        relinked[key_of(face.leaf, face.other)] = face.lines;
        again = changed = true;
      }
    }
  }
  return changed;
}

struct Traced {
  std::vector<std::uint32_t> counts;   // of cycles of each leaf
  Cycles cycles;
  std::vector<ManyLines> faces;
  std::vector<std::uint32_t> to_split;
};

}  // namespace

std::vector<std::uint32_t> leaves_across_many_lines(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges,
                                                    const LeafEdges& around) {
  auto parts = in_chunks<std::vector<std::uint32_t>>(around.leaves.size(), kLeavesPerTask, [&](auto& part, std::size_t begin, std::size_t end) {
    LeafTracer tracer(tree, edges);
    for (std::size_t i = begin; i < end; ++i) {
      if (around.of(i).size() >= 4) tracer.link(around.leaves[i], around.of(i));   // two lines across one face have four ends
    }
    for (const ManyLines& face : tracer.faces)
      if (!lists(around, face.other)) part.push_back(face.other);
  });
  std::vector<std::uint32_t> found;
  append_parts(parts, found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

LeafCycles trace_cycles(const SurfaceOctree& tree, const std::vector<MinimalEdge>& edges, const LeafEdges& around,
                        RelinkedFaces& relinked) {
  const auto trace = [&](LeafTracer& tracer, std::size_t begin, std::size_t end, Traced& out) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t before = out.cycles.lengths.size();
      tracer.trace(around.leaves[i], around.of(i), out.cycles);
      out.counts.push_back(static_cast<std::uint32_t>(out.cycles.lengths.size() - before));
      bool too_short = false;
      for (std::size_t k = before; k < out.cycles.lengths.size(); ++k) too_short |= !out.cycles.open[k] && out.cycles.lengths[k] < 3;
      if (too_short) out.to_split.push_back(around.leaves[i]);
    }
  };
  auto traced = in_chunks<Traced>(around.leaves.size(), kLeavesPerTask, [&](Traced& out, std::size_t begin, std::size_t end) {
    LeafTracer tracer(tree, edges);
    trace(tracer, begin, end, out);
    out.faces = std::move(tracer.faces);
  });

  LeafTracer tracer(tree, edges);
  tracer.relinked = &relinked;
  std::vector<std::size_t> again;   // tasks with leaves whose faces were linked the other way
  for (const Traced& part : traced)
    for (const ManyLines& face : part.faces) relinked.erase(key_of(face.leaf, face.other));
  for (Traced& part : traced) {
    for (ManyLines& face : part.faces) {
      if (face.leaf > face.other || !settle(face, around, tracer, relinked)) continue;
      for (const std::uint32_t leaf : {face.leaf, face.other}) again.push_back(place_of(around, leaf) / kLeavesPerTask);
    }
  }
  std::sort(again.begin(), again.end());
  again.erase(std::unique(again.begin(), again.end()), again.end());
  tbb::parallel_for(std::size_t{0}, again.size(), [&](std::size_t k) {
    LeafTracer settled(tree, edges);
    settled.relinked = &relinked;
    traced[again[k]] = {};
    trace(settled, again[k] * kLeavesPerTask, std::min(around.leaves.size(), (again[k] + 1) * kLeavesPerTask), traced[again[k]]);
  });

  LeafCycles result;
  const auto gather = [&](auto&& list_of, std::vector<std::uint32_t>& all) {
    std::vector<std::vector<std::uint32_t>> lists(traced.size());
    for (std::size_t i = 0; i < traced.size(); ++i) lists[i] = std::move(list_of(traced[i]));
    append_parts(lists, all);
  };
  gather([](Traced& part) -> auto& { return part.counts; }, result.counts);
  gather([](Traced& part) -> auto& { return part.cycles.order; }, result.edges);
  gather([](Traced& part) -> auto& { return part.cycles.lengths; }, result.lengths);
  for (Traced& part : traced) result.open.insert(result.open.end(), part.cycles.open.begin(), part.cycles.open.end());
  gather([](Traced& part) -> auto& { return part.to_split; }, result.to_split);
  return result;
}

}  // namespace cambium
