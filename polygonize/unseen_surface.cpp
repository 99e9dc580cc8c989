#include "polygonize/unseen_surface.h"

#include "blobtree/lone_chain.h"
#include "polygonize/ordered_chunks.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kLeavesPerTask = 256;
constexpr std::size_t kMostCubes = 1024;   // of one leaf: bounds of warped fields tell little, however small a cube is

struct Doubt {
  std::uint32_t leaf;
  Vec3 place;
};

/// What some leaves were found to hold.
struct Found {
  std::vector<std::uint32_t> leaves;   // through which the surface passes
  std::vector<Doubt> doubts;
};

/// Finds nodes fast that are near the last one.
class NodeFinder {
 public:
  explicit NodeFinder(const SurfaceOctree& tree) : tree_(tree), path_(static_cast<std::size_t>(tree.root_level()) + 1, tree.root()) {}

  /// That of a cube, or the leaf or nothing that it is in.
  SurfaceOctree::Node find(const CellPlace& place, int level) {
    const std::uint32_t differs = (place[0] ^ at_[0]) | (place[1] ^ at_[1]) | (place[2] ^ at_[2]);
    const int common = std::max({level, lowest_, static_cast<int>(std::bit_width(differs))});
    if (common > tree_.root_level()) return {};   // outside
    at_ = place;
    for (lowest_ = common; lowest_ > level && node().has_children(); --lowest_) {
      int child = 0;
      for (int a = 0; a < 3; ++a) child |= static_cast<int>(place[a] >> (lowest_ - 1) & 1u) << a;
      path_[static_cast<std::size_t>(lowest_) - 1] = tree_.child(node(), child);
    }
    return node();
  }

  bool is_live(std::uint32_t leaf) {
    const OctreeLeaf& l = tree_.leaves()[leaf];
    const SurfaceOctree::Node at = find(l.place, l.level);
    return at.is_leaf() && at.leaf() == leaf;
  }

 private:
  SurfaceOctree::Node node() const { return path_[static_cast<std::size_t>(lowest_)]; }

  const SurfaceOctree& tree_;
  std::vector<SurfaceOctree::Node> path_;   // from the last node up, by level
  CellPlace at_{};
  int lowest_ = tree_.root_level();
};

/// Looks for the surface in one leaf after another. Scratch of one thread.
class LeafSearch {
 public:
  LeafSearch(const SurfaceOctree& tree, const SurfaceCover& cover) : tree_(tree), cover_(cover), near_(tree) {
    while (std::ldexp(tree.grid().cell, finest_) < tree.narrow()) ++finest_;
  }

  void search(std::uint32_t leaf, Found& found) {
    const OctreeLeaf& l = tree_.leaves()[leaf];
    if (!l.uniform() || !near_.is_live(leaf)) return;
    const PrunedField field = cover_.cube_field(l.cell);
    inside_ = l.mask != 0;
    if (!inside_ && LoneChain::of(field)) return;   // nowhere thinner than the radii that leaves were sized by
    const int smallest = inside_ ? finest_ : 0;   // what is thinner counts as wood, and is no doubt
    if (inside_ && l.level <= smallest) return;
    cubes_.assign(1, {l.place, l.level});
    std::optional<Vec3> doubtful;
    for (std::size_t next = 0; next < cubes_.size(); ++next) {
      const Cube cube = cubes_[next];
      if (sibling_shows_surface(cube)) continue;   // the cheapest first
      const Box box = tree_.grid().box(cube.place, cube.level);
      if (!evaluator_.interval(field, box).contains(kIso) || neighbour_shows_surface(cube)) continue;
      if (cube.level >= finest_ && l.level > finest_ && shows(field, box.center())) return found.leaves.push_back(leaf);
      if (cube.level > smallest && cubes_.size() < kMostCubes) {
        add_parts(cube);
      } else {
        doubtful = box.center();   // the last is of the smallest
      }
    }
    if (doubtful && !inside_) found.doubts.push_back({leaf, *doubtful});
  }

 private:
  struct Cube {
    CellPlace place;
    int level;
  };

  void add_parts(const Cube& cube) {
    for (std::uint32_t c = 0; c < 8; ++c) {
      Cube part{cube.place, cube.level - 1};
      for (int a = 0; a < 3; ++a) part.place[a] += (c >> a & 1) << part.level;
      cubes_.push_back(part);
    }
  }

  // Beside leaves that show the surface polygons are made, and measured: what is beyond them within a leaf is theirs to find.
  bool sibling_shows_surface(const Cube& cube) {
    for (std::uint32_t other = 1; other < 8; ++other) {
      Cube sibling = cube;
      for (int a = 0; a < 3; ++a) sibling.place[a] ^= (other >> a & 1) << cube.level;
      if (shows_surface(sibling)) return true;
    }
    return false;
  }

  bool neighbour_shows_surface(const Cube& cube) {
    for (int direction = 0; direction < 27; ++direction) {
      const std::array<int, 3> step{direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
      Cube neighbour = cube;
      for (int a = 0; a < 3; ++a) neighbour.place[a] += static_cast<std::uint32_t>(step[a]) << cube.level;   // wraps below zero
      if (shows_surface(neighbour)) return true;
    }
    return false;
  }

  // Whether it is in a leaf that shows the surface; of the smallest cubes, whether one in it does.
  bool shows_surface(const Cube& cube) {
    const SurfaceOctree::Node node = near_.find(cube.place, cube.level);
    if (node.has_children()) return cube.level <= finest_ && any_leaf_shows(node);
    return node.is_leaf() && !tree_.leaves()[node.leaf()].uniform();
  }

  bool any_leaf_shows(SurfaceOctree::Node node) const {
    if (!node.has_children()) return node.is_leaf() && !tree_.leaves()[node.leaf()].uniform();
    for (int child = 0; child < 8; ++child)
      if (any_leaf_shows(tree_.child(node, child))) return true;
    return false;
  }

  // Whether a point is of the other kind than the leaf's corners, in a plate or slot thick enough to be shown.
  bool shows(const PrunedField& field, const Vec3& p) {
    const auto differs = [&](const Vec3& q) { return (evaluator_.value(field, q) >= kIso) != inside_; };
    if (!differs(p)) return false;
    for (int a = 0; a < 3; ++a)
      for (const double side : {-0.5, 0.5}) {
        Vec3 q = p;
        q[a] += side * tree_.narrow();
        if (!differs(q)) return false;
      }
    return true;
  }

  const SurfaceOctree& tree_;
  const SurfaceCover& cover_;
  NodeFinder near_;
  Evaluator evaluator_;
  std::vector<Cube> cubes_;   // of the leaf being searched: coarse ones first
  int finest_ = 0;
  bool inside_ = false;
};

/// Leaves from `first` on.
std::vector<Found> search_leaves(const SurfaceOctree& tree, const SurfaceCover& cover, std::size_t first, const RunOptions& run) {
  tbb::enumerable_thread_specific<LeafSearch> searches([&] { return LeafSearch(tree, cover); });
  return in_chunks<Found>(tree.leaves().size() - first, kLeavesPerTask, [&](Found& part, std::size_t begin, std::size_t end) {
    LeafSearch& search = searches.local();
    for (std::size_t i = first + begin; i < first + end && !run.cancelled(); ++i) search.search(static_cast<std::uint32_t>(i), part);
  });
}

}  // namespace

bool show_unseen_surface(SurfaceOctree& tree, const SurfaceCover& cover, std::vector<Vec3>& uncertain, const RunOptions& run) {
  std::vector<Doubt> doubts;
  for (std::size_t first = 0; first < tree.leaves().size();) {
    const std::size_t end = tree.leaves().size();
    std::vector<std::uint32_t> to_cut;
    for (const Found& part : search_leaves(tree, cover, first, run)) {
      to_cut.insert(to_cut.end(), part.leaves.begin(), part.leaves.end());
      doubts.insert(doubts.end(), part.doubts.begin(), part.doubts.end());
    }
    if (run.cancelled()) return false;
    first = end;
    if (!to_cut.empty()) tree.split(cover, std::move(to_cut), run);
    if (run.cancelled()) return false;
  }
  NodeFinder finder(tree);
  for (const Doubt& doubt : doubts)   // leaves that were cut beside others have been searched again
    if (finder.is_live(doubt.leaf)) uncertain.push_back(doubt.place);
  return true;
}

}  // namespace cambium
