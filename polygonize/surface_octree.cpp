#include "polygonize/surface_octree.h"

#include "blobtree/choices.h"
#include "blobtree/input_error.h"
#include "polygonize/field_batch.h"
#include "polygonize/marks.h"
#include "polygonize/tube_runs.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

// Float batches agree with the double field to 1e-4 where values are about 1; nearer to the surface than ten times that a
// corner's sign is decided in double.
constexpr float kDoubtfulValue = 1e-3f;
constexpr std::size_t kLeavesPerTask = 128;
constexpr int kMostCuts = 3;   // at once: 9^3 corners

CellPlace offset(const CellPlace& place, int x, int y, int z, int level) {
  return {place[0] + (static_cast<std::uint32_t>(x) << level), place[1] + (static_cast<std::uint32_t>(y) << level),
          place[2] + (static_cast<std::uint32_t>(z) << level)};
}

}  // namespace

namespace {

constexpr std::size_t kMostLeaves = 120'000'000;   // of 20 bytes, and some 250 more where they hold the surface
constexpr std::size_t kForetelling = 64;           // one cell of so many foretells their leaves,
constexpr double kDoubt = 0.75;                    // with this to be taken off

void require_room(std::size_t leaves) {
  if (leaves > kMostLeaves) {
    throw InputError({}, fmt::format("more than {} cells for so fine a mesh", kMostLeaves),
                     "a larger tolerance or voxel, or thicker primitives");
  }
}

}  // namespace

double LeafRule::edge(double radius) const {
  if (!std::isfinite(radius)) return longest;
  return std::min({longest, radii * radius, std::sqrt(sagitta * radius)});
}

double SurfaceOctree::narrow() const {
  if (!(rule_.shortest_gap > 0)) return 0;
  double width = grid_.cell;
  while (2 * width < 2 * rule_.shortest_gap) width *= 2;
  return width;
}

/// Samples the corners of a cube cut into equal parts: which are inside, and which parts have an edge between two corners of the
/// same kind on which the field nevertheless seems to cross the surface twice. Scratch of one thread.
class SurfaceOctree::Sampler {
 public:
  /// What becomes of the cube is written to subtree; its root is the result. merge: eight leaves without a crossing are one.
  /// It is cut `cuts` times (at most kMostCuts), and parts with a crossing further, until they are on level `wanted`.
  Node cut(const SurfaceOctree& tree, const PrunedField& field, std::uint32_t cell, const CellPlace& place, int level, int cuts,
           int wanted, bool merge, Subtree& subtree) {
    merge_ = merge, wanted_ = wanted, grid_ = &tree.grid_;
    tubes_ = tubes_in(tree, field);
    sample(tree, field, cell, place, level - cuts, cuts);
    // Parts in the order of the octree: the children of each node together.
    std::vector<Unfinished> unfinished;
    Node root = descend(cell, place, level, {0, 0, 0}, cuts, kRoot, subtree, unfinished);
    // The sampler's arrays were in use until here.
    for (const Unfinished& part : unfinished) {
      const OctreeLeaf old = subtree.leaves[part.leaf];
      const int too_high = old.uniform() ? 0 : old.level - wanted;
      if (too_high <= 0 && (old.level == 0 || std::ldexp(tree.grid_.cell, old.level) <= tree.narrow())) continue;
      const Node made = cut(tree, field, cell, old.place, old.level, std::clamp(too_high, 1, kMostCuts), wanted, merge, subtree);
      (part.slot == kRoot ? root : subtree.nodes[part.slot]) = made;
    }
    return root;
  }

  /// The same for a cell of the cover that is to be cut down to level `wanted`: what belongs to tubes is not sampled.
  Node cut_beside_tubes(const SurfaceOctree& tree, const PrunedField& field, std::uint32_t cell, const CellPlace& place, int level,
                        int wanted, Subtree& subtree) {
    const auto tubes = tubes_in(tree, field);
    const auto share = tubes.none() ? TubeRuns::Share::kNone : tubes.share(tree.grid_.box(place, level));
    if (share == TubeRuns::Share::kAll) return {};
    if (share == TubeRuns::Share::kPart && level <= wanted && tubes.holds(tree.grid_.box(place, level).center())) return {};
    if (share == TubeRuns::Share::kNone || level <= wanted) {
      return cut(tree, field, cell, place, level, std::min(level - wanted, kMostCuts), wanted, true, subtree);
    }
    const auto first = static_cast<std::uint32_t>(subtree.nodes.size());
    subtree.nodes.resize(first + 8);
    for (int c = 0; c < 8; ++c) {
      const CellPlace child = offset(place, c & 1, c >> 1 & 1, c >> 2, level - 1);
      const Node made = cut_beside_tubes(tree, field, cell, child, level - 1, wanted, subtree);
      subtree.nodes[first + static_cast<std::uint32_t>(c)] = made;
    }
    return {first};
  }

 private:
  static TubeRuns::InCell tubes_in(const SurfaceOctree& tree, const PrunedField& field) {
    return tree.tubes_ ? tree.tubes_->in(field) : TubeRuns::InCell{};
  }

  /// A leaf that is to be cut further, and the node that holds it.
  struct Unfinished {
    std::uint32_t leaf = 0, slot = 0;
  };
  static constexpr std::uint32_t kRoot = 0xffffffffu;
  static constexpr std::uint32_t kNoCell = 0xffffffffu;

  /// A cell of the cover beside the one that is being sampled.
  struct Home {
    std::array<std::array<std::uint32_t, 2>, 3> places;   // its cube, in units: low, high
    PrunedField field;
    bool may_be_cracked = false;
  };

  int at(int x, int y, int z) const { return x + side_ * (y + side_ * z); }

  void sample(const SurfaceOctree& tree, const PrunedField& field, std::uint32_t cell, const CellPlace& place, int level, int cuts) {
    parts_ = 1 << cuts;
    side_ = parts_ + 1;
    const std::size_t n = static_cast<std::size_t>(side_ * side_ * side_);
    for (auto* v : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) v->resize(n);
    inside_.resize(n);
    const Vec3 base = tree.point(place) - field.origin();
    const double step = std::ldexp(tree.grid_.cell, level);
    for (int z = 0, i = 0; z < side_; ++z)
      for (int y = 0; y < side_; ++y)
        for (int x = 0; x < side_; ++x, ++i) {
          x_[i] = static_cast<float>(base.x + step * x);
          y_[i] = static_cast<float>(base.y + step * y);
          z_[i] = static_cast<float>(base.z + step * z);
        }
    evaluator_.samples(field, x_, y_, z_, f_, gx_, gy_, gz_);
    float largest = 1;
    for (const float f : f_) largest = std::max(largest, std::abs(f));
    const float doubtful = kDoubtfulValue * largest;
    for (int z = 0, i = 0; z < side_; ++z)
      for (int y = 0; y < side_; ++y)
        for (int x = 0; x < side_; ++x, ++i) {
          f_[i] -= static_cast<float>(kIso);
          if (!(std::abs(f_[i]) > doubtful)) {
            f_[i] = static_cast<float>(evaluator_.value(field, tree.point(offset(place, x, y, z, level))) - kIso);
          }
          inside_[i] = f_[i] >= 0;
        }
    fill_cracks(tree, field, cell, place, level);
    find_suspects(field, static_cast<float>(step));
  }

  // An outside corner between sheets that are closer than narrow() along some way becomes an inside one. Every cell that has the
  // corner asks the same field, that of the cover's cell it is in (low faces included), also a little beyond it.
  void fill_cracks(const SurfaceOctree& tree, const PrunedField& field, std::uint32_t cell, const CellPlace& place, int level) {
    const double width = tree.narrow();
    if (!(width > 0)) return;
    const std::array<std::array<std::uint32_t, 2>, 3> reach_of_cell = tree.places_of(cell);
    const bool smooth = !may_be_cracked(field, width);
    for (int z = 0, i = 0; z < side_; ++z)
      for (int y = 0; y < side_; ++y)
        for (int x = 0; x < side_; ++x, ++i) {
          if (inside_[i] || f_[i] < -kFarthest - kDoubtfulValue) continue;
          const CellPlace corner = offset(place, x, y, z, level);
          bool is_own = true, on_face = false;
          for (int a = 0; a < 3; ++a) {
            is_own = is_own && corner[a] != reach_of_cell[a][1];
            on_face = on_face || corner[a] == reach_of_cell[a][0] || corner[a] == reach_of_cell[a][1];
          }
          if (is_own && smooth) continue;
          PrunedField home = field;
          if (!is_own) {   // here nothing may choose and there something may
            const Home* found = home_of(tree, cell, corner, width);
            if (!found || !found->may_be_cracked) continue;
            home = found->field;
          }
          // One of the sheets is within half the width, and no field of these radii falls by more over that way, but for scars.
          const double reach = std::min(static_cast<double>(kFarthest), width / home.smallest_radius());
          if (static_cast<double>(f_[i]) < -reach - static_cast<double>(kDoubtfulValue)) continue;
          const Vec3 p = tree.point(corner);
          if (evaluator_.value(home, p) - kIso < -reach || !in_crack(home, p, width)) continue;
          if (on_face && beside_nothing(tree, corner)) continue;
          inside_[i] = 1;
          f_[i] = 0;
        }
  }

  // Where nothing chooses there are no cracks. Sheets thicker than `width` reach over it with their support: both are active
  // wherever a crack of theirs touches.
  static bool may_be_cracked(const PrunedField& field, double width) {
    return !ChoiceEvaluator::smooth(field) && width <= field.smallest_radius();
  }

  /// The cell of the cover that a corner on the boundary of another is in; null if there is none.
  const Home* home_of(const SurfaceOctree& tree, std::uint32_t cell, const CellPlace& corner, double width) {
    if (cell != homes_around_) homes_.clear();
    homes_around_ = cell;
    const auto holds = [&](const Home& home) {
      bool inside = true;
      for (int a = 0; a < 3; ++a) inside = inside && home.places[a][0] <= corner[a] && corner[a] < home.places[a][1];
      return inside;
    };
    const auto known = std::find_if(homes_.begin(), homes_.end(), holds);
    if (known != homes_.end()) return &*known;
    const auto found = tree.cell_at(corner);
    if (!found) return nullptr;
    const PrunedField field = tree.cover_->cube_field(*found);
    return &homes_.emplace_back(Home{tree.places_of(*found), field, may_be_cracked(field, width)});
  }

  // No surface may come to lie against a place that the cover has no cell for.
  static bool beside_nothing(const SurfaceOctree& tree, const CellPlace& corner) {
    for (std::uint32_t c = 0; c < 8; ++c) {
      if (!tree.cell_at({corner[0] - (c & 1), corner[1] - (c >> 1 & 1), corner[2] - (c >> 2)})) return true;   // wraps: nothing there
    }
    return false;
  }

  bool in_crack(const PrunedField& field, const Vec3& p, double width) {
    crack_.clear();
    for (const Vec3& way : kCrackWays)
      for (int k = 1; k <= kCrackSteps / 2; ++k)
        for (const int side : {-1, 1}) crack_.add(field, p + (side * width * k / kCrackSteps) * way);
    crack_.evaluate_values(evaluator_, field);
    far_.clear();
    std::size_t i = 0;
    for (const Vec3& way : kCrackWays) {
      std::array<int, 2> nearest{kCrackSteps, kCrackSteps};   // steps to the wood on either side
      for (int k = 1; k <= kCrackSteps / 2; ++k)
        for (int& steps : nearest)
          if (crack_.value(i++) >= 0) steps = std::min(steps, k);
      const int near = std::min(nearest[0], nearest[1]);
      if (near == kCrackSteps) continue;
      if (nearest[0] + nearest[1] <= kCrackSteps) return true;
      const int side = nearest[0] == near ? 1 : -1;
      for (int k = kCrackSteps / 2 + 1; k <= kCrackSteps - near; ++k) far_.push_back(p + (side * width * k / kCrackSteps) * way);
    }
    if (far_.empty()) return false;
    crack_.clear();
    for (const Vec3& q : far_) crack_.add(field, q);
    crack_.evaluate_values(evaluator_, field);
    for (std::size_t q = 0; q < far_.size(); ++q)
      if (crack_.value(q) >= 0) return true;
    return false;
  }

  // Where the tangents at both ends of an edge cross on the far side of the surface, the field is asked there.
  void find_suspects(const PrunedField& field, float step) {
    suspect_.assign(static_cast<std::size_t>(parts_ * parts_ * parts_), 0);
    probes_.clear();
    const std::array<int, 3> stride{1, side_, side_ * side_};
    for (int z = 0, i = 0; z < side_; ++z)
      for (int y = 0; y < side_; ++y)
        for (int x = 0; x < side_; ++x, ++i) {
          const std::array<int, 3> c{x, y, z};
          for (int a = 0; a < 3; ++a) {
            if (c[a] == parts_) continue;
            const int j = i + stride[a];
            if (inside_[i] != inside_[j]) continue;
            const std::vector<float>& g = a == 0 ? gx_ : a == 1 ? gy_ : gz_;
            const float side = inside_[i] ? 1.0f : -1.0f;
            const float slope_i = side * g[i] * step, slope_j = side * g[j] * step;
            if (!(slope_i < 0 && slope_j > 0)) continue;
            const float vi = side * f_[i], vj = side * f_[j];
            const float t = (vj - vi - slope_j) / (slope_i - slope_j);
            if (!(t > 0 && t < 1 && vi + slope_i * t < 0)) continue;
            probes_.push_back({i, a, t, inside_[i] != 0});
          }
        }
    if (probes_.empty()) return;
    const std::size_t n = probes_.size();
    for (auto* v : {&px_, &py_, &pz_, &pf_}) v->resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Probe& probe = probes_[k];
      px_[k] = x_[probe.corner] + (probe.axis == 0 ? probe.t * step : 0.0f);
      py_[k] = y_[probe.corner] + (probe.axis == 1 ? probe.t * step : 0.0f);
      pz_[k] = z_[probe.corner] + (probe.axis == 2 ? probe.t * step : 0.0f);
    }
    evaluator_.values(field, px_, py_, pz_, pf_);
    for (std::size_t k = 0; k < n; ++k) {
      if ((pf_[k] >= static_cast<float>(kIso)) == probes_[k].inside) continue;
      const int i = probes_[k].corner, a = probes_[k].axis;
      const std::array<int, 3> c{i % side_, i / side_ % side_, i / (side_ * side_)};
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      for (int s = 0; s < 4; ++s) {   // the parts around the edge
        std::array<int, 3> part = c;
        part[b] -= s & 1;
        part[d] -= s >> 1;
        if (part[b] < 0 || part[d] < 0 || part[b] == parts_ || part[d] == parts_) continue;
        suspect_[static_cast<std::size_t>(part[0] + parts_ * (part[1] + parts_ * part[2]))] = 1;
      }
    }
  }

  Node descend(std::uint32_t cell, const CellPlace& place, int level, const std::array<int, 3>& part, int cuts, std::uint32_t slot,
               Subtree& subtree, std::vector<Unfinished>& unfinished) {
    if (cuts == 0) {
      if (level <= wanted_ && !tubes_.none() && tubes_.holds(grid_->box(place, level).center())) return {};
      OctreeLeaf leaf{cell, place, static_cast<std::uint8_t>(level), 0};
      for (int c = 0; c < 8; ++c) {
        leaf.mask |= static_cast<std::uint8_t>(inside_[at(part[0] + (c & 1), part[1] + (c >> 1 & 1), part[2] + (c >> 2))] << c);
      }
      const auto id = static_cast<std::uint32_t>(subtree.leaves.size());
      subtree.leaves.push_back(leaf);
      const bool suspect = suspect_[static_cast<std::size_t>(part[0] + parts_ * (part[1] + parts_ * part[2]))];
      if (suspect || (level > wanted_ && !leaf.uniform())) unfinished.push_back({id, slot});
      return {id | Node::kLeafBit};
    }
    const std::size_t leaves_before = subtree.leaves.size(), unfinished_before = unfinished.size();
    const std::size_t nodes_before = subtree.nodes.size();
    const auto first = static_cast<std::uint32_t>(nodes_before);
    subtree.nodes.resize(first + 8);
    const int half = 1 << (cuts - 1);
    for (int c = 0; c < 8; ++c) {
      const std::array<int, 3> child_part{part[0] + (c & 1) * half, part[1] + (c >> 1 & 1) * half, part[2] + (c >> 2) * half};
      const Node made = descend(cell, offset(place, c & 1, c >> 1 & 1, c >> 2, level - 1), level - 1, child_part, cuts - 1,
                                first + static_cast<std::uint32_t>(c), subtree, unfinished);
      subtree.nodes[first + static_cast<std::uint32_t>(c)] = made;
    }
    if (merge_ && subtree.leaves.size() == leaves_before + 8 && unfinished.size() == unfinished_before) {
      const std::uint8_t mask = subtree.leaves[leaves_before].mask;
      const bool same = (mask == 0 || mask == 255) && std::all_of(subtree.leaves.begin() + static_cast<std::ptrdiff_t>(leaves_before),
                                                                  subtree.leaves.end(), [&](const auto& l) { return l.mask == mask; });
      if (same) {
        subtree.leaves.resize(leaves_before);
        subtree.nodes.resize(nodes_before);
        subtree.leaves.push_back({cell, place, static_cast<std::uint8_t>(level), mask});
        return {static_cast<std::uint32_t>(leaves_before) | Node::kLeafBit};
      }
    }
    return {first};
  }

  struct Probe {
    int corner, axis;
    float t;
    bool inside;
  };
  static constexpr int kCrackSteps = 8;
  // No way through a crack is farther than 28 degrees from one of these: the axes and all diagonals of a cube.
  static constexpr double kFaceWay = 0.70710678118654752, kSpaceWay = 0.57735026918962576;
  static inline const std::array<Vec3, 13> kCrackWays{
      Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1),
      Vec3(0, kFaceWay, kFaceWay), Vec3(0, kFaceWay, -kFaceWay), Vec3(kFaceWay, 0, kFaceWay),
      Vec3(kFaceWay, 0, -kFaceWay), Vec3(kFaceWay, kFaceWay, 0), Vec3(kFaceWay, -kFaceWay, 0),
      Vec3(kSpaceWay, kSpaceWay, kSpaceWay), Vec3(kSpaceWay, kSpaceWay, -kSpaceWay), Vec3(kSpaceWay, -kSpaceWay, kSpaceWay),
      Vec3(kSpaceWay, -kSpaceWay, -kSpaceWay)};
  static constexpr float kFarthest = 0.5f;   // below kIso: where nothing is
  Evaluator evaluator_;
  FieldBatch crack_;
  std::vector<Vec3> far_;
  const CellGrid* grid_ = nullptr;
  TubeRuns::InCell tubes_;
  bool merge_ = true;
  int wanted_ = 0;
  int parts_ = 0, side_ = 0;
  std::vector<float> x_, y_, z_, f_, gx_, gy_, gz_, px_, py_, pz_, pf_;
  std::vector<std::uint8_t> inside_, suspect_;
  std::vector<Probe> probes_;
  std::vector<Home> homes_;               // that were asked for around one cell
  std::uint32_t homes_around_ = kNoCell;
};

// place(part, i, node): puts a subtree's root where it belongs; each is another's place.
template <class Place>
void SurfaceOctree::adopt(std::vector<Subtree>& subtrees, Place&& place) {
  std::vector<std::size_t> nodes_at(subtrees.size() + 1, nodes_.size()), leaves_at(subtrees.size() + 1, leaves_.size());
  for (std::size_t i = 0; i < subtrees.size(); ++i) {
    nodes_at[i + 1] = nodes_at[i] + subtrees[i].nodes.size();
    leaves_at[i + 1] = leaves_at[i] + subtrees[i].leaves.size();
  }
  require_room(leaves_at.back());
  nodes_.resize(nodes_at.back());
  leaves_.resize(leaves_at.back());
  tbb::parallel_for(std::size_t{0}, subtrees.size(), [&](std::size_t part) {
    Subtree& subtree = subtrees[part];
    const auto moved = [&](Node node) -> Node {
      if (node.is_void()) return node;
      if (node.is_leaf()) return {static_cast<std::uint32_t>(node.leaf() + leaves_at[part]) | Node::kLeafBit};
      return {static_cast<std::uint32_t>(node.word + nodes_at[part])};
    };
    std::transform(subtree.nodes.begin(), subtree.nodes.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(nodes_at[part]), moved);
    std::copy(subtree.leaves.begin(), subtree.leaves.end(), leaves_.begin() + static_cast<std::ptrdiff_t>(leaves_at[part]));
    for (std::size_t i = 0; i < subtree.roots.size(); ++i) place(part, i, moved(subtree.roots[i]));
    subtree = {};
  });
}

// The cells [begin, end) of the cover are those inside one cube.
SurfaceOctree::Node SurfaceOctree::join(const SurfaceCover& cover, const std::vector<Node>& roots, std::size_t begin,
                                        std::size_t end, int level) {
  if (begin == end) return {};
  if (cover.level(begin) + finer_ == level) return roots[begin];
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(first + 8);
  for (std::uint32_t c = 0; c < 8; ++c) {
    std::size_t after = begin;
    const auto child_of = [&](std::size_t i) {
      std::uint32_t child = 0;
      for (int a = 0; a < 3; ++a) child |= (cover.place(i)[a] >> (level - 1 - finer_) & 1u) << a;
      return child;
    };
    while (after < end && child_of(after) == c) ++after;
    const Node made = join(cover, roots, begin, after, level - 1);
    nodes_[first + c] = made;
    begin = after;
  }
  return {first};
}

std::optional<SurfaceOctree> SurfaceOctree::build(const SurfaceCover& cover, int finer, const LeafRule& rule, const RunOptions& run,
                                                  const TubeRuns* tubes) {
  SurfaceOctree tree;
  tree.grid_ = cover.grid();
  tree.grid_.cell = std::ldexp(tree.grid_.cell, -finer);
  for (std::int64_t& first : tree.grid_.first) first <<= finer;
  tree.grid_.levels += finer;
  tree.finer_ = finer;
  tree.rule_ = rule;
  tree.cover_ = &cover;
  tree.tubes_ = tubes;
  std::vector<Subtree> subtrees(cover.size());
  std::atomic<std::size_t> so_far{0};
  tbb::enumerable_thread_specific<Sampler> samplers;
  const auto cut = [&](std::size_t i) {
    if (run.cancelled() || so_far > kMostLeaves) return;
    const PrunedField field = cover.cube_field(i);
    const Cube cube = tree.cube_of(i);
    subtrees[i].roots.push_back(samplers.local().cut_beside_tubes(tree, field, static_cast<std::uint32_t>(i), cube.place, cube.level,
                                                                  tree.wanted_level(field, cube.level), subtrees[i]));
    so_far += subtrees[i].leaves.size();
  };
  // A few first: where there would be far too many leaves that is known at once.
  const std::size_t foretold = (cover.size() + kForetelling - 1) / kForetelling;
  tbb::parallel_for(std::size_t{0}, foretold, [&](std::size_t i) { cut(i * kForetelling); });
  if (run.cancelled()) return std::nullopt;
  require_room(static_cast<std::size_t>(kDoubt * static_cast<double>(so_far * kForetelling)));
  tbb::parallel_for(std::size_t{0}, cover.size(), [&](std::size_t i) {
    if (i % kForetelling != 0) cut(i);
  });
  if (run.cancelled()) return std::nullopt;
  require_room(so_far);
  std::vector<Node> roots(cover.size());
  tree.adopt(subtrees, [&](std::size_t cell, std::size_t, Node root) { roots[cell] = root; });
  tree.root_ = tree.join(cover, roots, 0, cover.size(), tree.grid_.levels);
  tree.cover_ = nullptr;
  return tree;
}

SurfaceOctree::Cube SurfaceOctree::cube_of(std::size_t cell) const {
  Cube cube{cover_->place(cell), cover_->level(cell) + finer_};
  for (std::uint32_t& along : cube.place) along <<= finer_;
  return cube;
}

int SurfaceOctree::wanted_level(const PrunedField& field, int level) const {
  const double wanted = rule_.edge(field.smallest_radius());
  while (level > 0 && std::ldexp(grid_.cell, level) > wanted) --level;
  return level;
}

std::array<std::array<std::uint32_t, 2>, 3> SurfaceOctree::places_of(std::size_t cell) const {
  const Cube cube = cube_of(cell);
  std::array<std::array<std::uint32_t, 2>, 3> places;
  for (int a = 0; a < 3; ++a) places[a] = {cube.place[a], cube.place[a] + (1u << cube.level)};
  return places;
}

std::optional<std::size_t> SurfaceOctree::cell_at(const CellPlace& place) const {
  return cover_->find_place({place[0] >> finer_, place[1] >> finer_, place[2] >> finer_});
}

// The lowest node about a place, or that on level `lowest`.
SurfaceOctree::Node* SurfaceOctree::slot_of(const CellPlace& place, int lowest) {
  Node* slot = &root_;
  for (int level = grid_.levels; level > lowest && slot->has_children(); --level) {
    std::uint32_t child = 0;
    for (int a = 0; a < 3; ++a) child |= (place[a] >> (level - 1) & 1u) << a;
    slot = &nodes_[slot->word + child];
  }
  return slot;
}

std::optional<std::uint32_t> SurfaceOctree::find(const CellPlace& place) const {
  for (int a = 0; a < 3; ++a) {
    if (place[a] >> grid_.levels) return std::nullopt;
  }
  const Node* slot = const_cast<SurfaceOctree*>(this)->slot_of(place);
  if (slot->is_void()) return std::nullopt;
  return slot->leaf();
}

// Cutting a leaf makes eight of the next level below, which may have no neighbour more than one level above them.
std::vector<std::uint32_t> SurfaceOctree::with_larger_neighbours(std::vector<std::uint32_t> leaves) const {
  Marks listed(leaves_.size());
  for (const std::uint32_t leaf : leaves) listed.add(leaf);
  for (std::size_t known = 0; known < leaves.size();) {
    const std::size_t first = std::exchange(known, leaves.size());
    auto found = in_chunks<std::vector<std::uint32_t>>(known - first, kLeavesPerTask, [&](auto& part, std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        const OctreeLeaf& leaf = leaves_[leaves[i]];
        for (int direction = 0; direction < 27; ++direction) {
          const std::array<int, 3> step{direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
          const int axes = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
          if (axes == 0 || axes == 3) continue;
          CellPlace place = leaf.place;
          for (int a = 0; a < 3; ++a) place[a] += static_cast<std::uint32_t>(step[a]) << leaf.level;   // wraps below zero: not found
          const auto neighbour = find(place);
          if (neighbour && leaves_[*neighbour].level > leaf.level && listed.add_new(*neighbour)) part.push_back(*neighbour);
        }
      }
    });
    append_parts(found, leaves);
  }
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

std::optional<std::uint32_t> SurfaceOctree::find_beside(const OctreeLeaf& leaf, int axis, int from, int to) const {
  CellPlace place = leaf.place;
  for (int k = 0; k < 2; ++k) {
    const int away = (to >> k & 1) - (from >> k & 1), a = (axis + 1 + k) % 3;
    if (away > 0) place[a] += 1u << leaf.level;
    if (away < 0) --place[a];   // wraps below zero: not found
    if (away == 0 && !(from >> k & 1)) place[a] += (1u << leaf.level) - 1;
  }
  return find(place);
}

std::vector<std::uint32_t> SurfaceOctree::split(const SurfaceCover& cover, std::vector<std::uint32_t> wanted, const RunOptions& run) {
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::erase_if(wanted, [&](std::uint32_t leaf) { return leaves_[leaf].level == 0; });
  std::vector<std::uint32_t> leaves = with_larger_neighbours(std::move(wanted));
  cover_ = &cover;
  tbb::enumerable_thread_specific<Sampler> samplers;
  auto subtrees = in_chunks<Subtree>(leaves.size(), kLeavesPerTask, [&](Subtree& part, std::size_t begin, std::size_t end) {
    if (run.cancelled()) return;
    Sampler& sampler = samplers.local();
    for (std::size_t i = begin; i < end; ++i) {
      const OctreeLeaf& leaf = leaves_[leaves[i]];
      part.roots.push_back(sampler.cut(*this, cover.cube_field(leaf.cell), leaf.cell, leaf.place, leaf.level, 1, leaf.level, false, part));
    }
  });
  cover_ = nullptr;
  if (run.cancelled()) return {};
  std::vector<CellPlace> places(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) places[i] = leaves_[leaves[i]].place;
  adopt(subtrees, [&](std::size_t part, std::size_t i, Node root) { *slot_of(places[part * kLeavesPerTask + i]) = root; });
  return leaves;
}

void SurfaceOctree::append_voids(Node node, const Cube& cube, std::vector<Cube>& voids) const {
  if (node.is_void()) voids.push_back(cube);
  if (!node.has_children()) return;
  for (int c = 0; c < 8; ++c) {
    append_voids(child(node, c), {offset(cube.place, c & 1, c >> 1 & 1, c >> 2, cube.level - 1), cube.level - 1}, voids);
  }
}

bool SurfaceOctree::fill(const SurfaceCover& cover, const RunOptions& run) {
  struct Filled {
    std::vector<Cube> voids;   // of one cell
    std::vector<CellPlace> places;
    Subtree subtree;
  };
  cover_ = &cover;
  tbb::enumerable_thread_specific<Sampler> samplers;
  auto filled = in_chunks<Filled>(cover.size(), kLeavesPerTask, [&](Filled& part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !run.cancelled(); ++i) {
      const Cube cell = cube_of(i);
      part.voids.clear();
      append_voids(*slot_of(cell.place, cell.level), cell, part.voids);
      if (part.voids.empty()) continue;
      const PrunedField field = cover.cube_field(i);
      const int wanted = wanted_level(field, cell.level);
      for (const Cube& cube : part.voids) {
        const Node made = samplers.local().cut_beside_tubes(*this, field, static_cast<std::uint32_t>(i), cube.place, cube.level,
                                                            std::min(wanted, cube.level), part.subtree);
        if (made.is_void()) continue;
        part.places.push_back(cube.place);
        part.subtree.roots.push_back(made);
      }
    }
  });
  cover_ = nullptr;
  if (run.cancelled()) return false;
  std::vector<Subtree> subtrees;
  for (Filled& part : filled) subtrees.push_back(std::move(part.subtree));
  adopt(subtrees, [&](std::size_t part, std::size_t i, Node root) { *slot_of(filled[part].places[i]) = root; });
  return true;
}

}  // namespace cambium
