// The octree that an adaptive mesh is contoured on: the cells of a surface cover, cut into leaves whose corners know whether
// they are inside. Leaves follow the radius of what is active in them and may be cut further.
#pragma once

#include "blobtree/run_options.h"
#include "blobtree/surface_cover.h"
#include "polygonize/cube_edges.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace cambium {

/// A cube of 2^level units along its edge. Bit c of mask: corner c, at (c & 1, c >> 1 & 1, c >> 2 & 1), is inside.
struct OctreeLeaf {
  std::uint32_t cell = 0;            ///< of the cover that holds it
  CellPlace place{};                 ///< its low corner, in units
  std::uint8_t level = 0;
  std::uint8_t mask = 0;
  bool uniform() const { return mask == 0 || mask == 255; }
};

/// How large leaves may be at first, metres.
struct LeafRule {
  double radii = 1;                  ///< in smallest active surface radii
  double sagitta = kInfinity;        ///< and at most sqrt(sagitta * radius)
  double longest = kInfinity;
  double shortest_gap = 0;           ///< leaves are not cut below this to show that two sheets are apart; see SurfaceOctree::narrow()

  double edge(double radius) const;
};

class TubeRuns;

class SurfaceOctree {
 public:
  /// A node: nothing (no surface in it or on its boundary, or only that of a run of tubes), a leaf, or eight children.
  struct Node {
    std::uint32_t word = kVoid;
    static constexpr std::uint32_t kVoid = 0xffffffffu, kLeafBit = 0x80000000u;
    bool is_void() const { return word == kVoid; }
    bool is_leaf() const { return word != kVoid && (word & kLeafBit); }
    bool has_children() const { return !(word & kLeafBit); }
    std::uint32_t leaf() const { return word & ~kLeafBit; }
  };

  /// nullopt if cancelled. Corners are decided in double wherever a float batch could be mistaken, and a pruned field equals the
  /// whole one exactly, so neighbours never disagree. Cost: the leaves' corners, in dense batches. The same at any thread count.
  /// Units are the cover's level-0 cells halved `finer` times. Where `tubes` (which outlive the octree's last cut) run there is nothing:
  /// no polygon is around an edge that touches what is not there, so the surface stays open.
  static std::optional<SurfaceOctree> build(const SurfaceCover& cover, int finer, const LeafRule& rule, const RunOptions& run,
                                            const TubeRuns* tubes = nullptr);

  Node root() const { return root_; }
  int root_level() const { return grid_.levels; }
  Node child(Node node, int child) const { return nodes_[node.word + static_cast<std::uint32_t>(child)]; }
  const std::vector<OctreeLeaf>& leaves() const { return leaves_; }
  const CellGrid& grid() const { return grid_; }

  /// Where sheets with a crease between them are closer than this along an axis or a diagonal, what is between them counts as inside: it
  /// is the edge of the smallest leaves that show gaps, so every wider gap has a corner in it and cracks end in a clean floor.
  double narrow() const;
  double edge(const OctreeLeaf& leaf) const { return grid_.cell * static_cast<double>(std::uint64_t{1} << leaf.level); }
  Vec3 point(const CellPlace& place) const { return grid_.corner(place); }
  Box box(const OctreeLeaf& leaf) const { return grid_.box(leaf.place, leaf.level); }

  /// The leaf that holds the unit cube at `place`, or none.
  std::optional<std::uint32_t> find(const CellPlace& place) const;
  /// Whether a leaf cannot stay as it is beside a crossed minimal edge along `axis` of a leaf on level `finest`: it is more than twice as
  /// large, or the edge is half of one of its own whose ends are of one kind. quadrant: where it is around the edge; spans: it lies
  /// in two quadrants, so that the edge is inside one of its faces.
  bool must_split(std::uint32_t leaf, int axis, int quadrant, int finest, bool spans) const {
    const OctreeLeaf& l = leaves_[leaf];
    if (l.level > finest + 1) return true;
    if (spans || l.level == finest) return false;
    return !edge_crossed(l.mask, 4 * axis + 3 - quadrant);
  }
  /// The leaf in quadrant `to` around the low end of the edge of a leaf along `axis` that it sees from quadrant `from`, or none.
  std::optional<std::uint32_t> find_beside(const OctreeLeaf& leaf, int axis, int from, int to) const;
  /// Cuts each leaf listed, but for those on level 0, into eight, with neighbours that are larger. Cut leaves' numbers die; the eight get
  /// new ones, from leaves().size() on. Returns those that were cut, ascending; empty if cancelled. Cost: that of the leaves cut.
  std::vector<std::uint32_t> split(const SurfaceCover& cover, std::vector<std::uint32_t> leaves, const RunOptions& run);
  /// Makes leaves, from leaves().size() on, of what is nothing where tubes run no longer. False if cancelled. Cost: a look at every node,
  /// and that of the leaves made.
  bool fill(const SurfaceCover& cover, const RunOptions& run);

 private:
  struct Subtree {
    std::vector<Node> nodes;         // children relative to these, leaves likewise
    std::vector<OctreeLeaf> leaves;
    std::vector<Node> roots;         // of one or several trees
  };
  struct Cube {
    CellPlace place{};               // its low corner, in units
    int level = 0;
  };
  class Sampler;
  Cube cube_of(std::size_t cell) const;                      // of the cover
  int wanted_level(const PrunedField& field, int level) const;
  void append_voids(Node node, const Cube& cube, std::vector<Cube>& voids) const;
  std::vector<std::uint32_t> with_larger_neighbours(std::vector<std::uint32_t> leaves) const;
  std::array<std::array<std::uint32_t, 2>, 3> places_of(std::size_t cell) const;   // of the cover, in units: low, high
  std::optional<std::size_t> cell_at(const CellPlace& place) const;
  Node* slot_of(const CellPlace& place, int lowest = 0);
  template <class Place>
  void adopt(std::vector<Subtree>& subtrees, Place&& place);
  Node join(const SurfaceCover& cover, const std::vector<Node>& roots, std::size_t begin, std::size_t end, int level);

  const SurfaceCover* cover_ = nullptr;   // while it is being sampled
  const TubeRuns* tubes_ = nullptr;
  CellGrid grid_;
  int finer_ = 0;
  LeafRule rule_;
  Node root_;
  std::vector<Node> nodes_;
  std::vector<OctreeLeaf> leaves_;
};

}  // namespace cambium
