// A BlobTree compiled for evaluation and pruning. Private to blobtree/.
//
// Node ids are those of the BlobTree. Its primitives, with a chain's segments counted singly, are `atoms`, numbered in
// depth-first order; every operator covers a range of them. Pruning gathers the atoms whose support meets a box and
// rebuilds the operators above them from lowest common ancestors, so it never walks the depth of the tree (tape.h). A
// chain is kept as its nodes, 32 bytes each; what evaluation wants of a segment (axis, length, slope) is worked out where
// a tape is gathered.
#pragma once

#include "blobtree/atom_index.h"
#include "blobtree/blobtree.h"
#include "blobtree/float_box.h"
#include "blobtree/flare.h"
#include "blobtree/skeleton_primitives.h"
#include "blobtree/warps.h"

#include <array>
#include <cstdint>
#include <memory>
#include <tuple>
#include <variant>
#include <vector>

namespace cambium {

inline constexpr std::uint32_t kNone = 0xffffffffu;

enum class Op : std::uint8_t {
  kPrimitive, kHalfSpace, kChain, kFlare,
  kSum, kUnion, kIntersection, kDifference, kRicci, kContact, kFork, kScale, kWarp
};

/// Made of atoms that are segments of a chain.
inline bool is_swept(Op op) { return op == Op::kChain || op == Op::kFlare; }

template <class T>
using SkeletonShape = std::variant<PointSkeleton<T>, SegmentSkeleton<T>, ConeSkeleton<T>, DiscSkeleton<T>, CircleSkeleton<T>,
                                   BoxSkeleton<T>>;

/// f = strength * g(distance * inverse_support).
struct CompiledPrimitive {
  CompiledPrimitive() = default;
  CompiledPrimitive(SkeletonShape<double> form, double surface_radius, double factor)
      : shape(std::move(form)), radius(surface_radius), inverse_support(1 / (kSupportPerRadius * surface_radius)),
        strength(factor) {}

  SkeletonShape<double> shape;
  double radius = 0;               ///< of the surface
  double inverse_support = 0;
  double strength = 1;
};

/// Primitives with every kind of shape in an array of its own, so that a small one does not pay for a large one.
class PrimitiveStore {
 public:
  void add(const CompiledPrimitive& primitive);
  CompiledPrimitive operator[](std::size_t i) const;
  std::size_t size() const { return entries_.size(); }
  double radius(std::size_t i) const { return entries_[i].radius; }
  double strength(std::size_t i) const { return entries_[i].strength; }
  void shrink_to_fit();
  std::size_t memory_bytes() const;

 private:
  struct Entry {
    double radius = 0, strength = 1;
    std::uint32_t kind = 0, place = 0;   ///< alternative of SkeletonShape, and where in its array
  };
  std::vector<Entry> entries_;
  std::tuple<std::vector<PointSkeleton<double>>, std::vector<SegmentSkeleton<double>>, std::vector<ConeSkeleton<double>>,
             std::vector<DiscSkeleton<double>>, std::vector<CircleSkeleton<double>>, std::vector<BoxSkeleton<double>>> shapes_;
};

struct CompiledHalfSpace {
  Vec3 point, normal;
  double width = 0;
};

struct CompiledChain {
  double strength = 1;
  std::uint32_t first_node = 0;    ///< into chain_nodes; at least two, a lone one is kept twice
  std::uint32_t node_count = 0;
  std::uint32_t flare = kNone;     ///< into flares; none of a plain chain
};

struct CompiledNode {
  Op op = Op::kSum;
  bool subtracted : 1 = false;     ///< taken away by a difference above
  bool can_be_negative : 1 = false;
  bool can_exceed_one : 1 = false;
  std::uint32_t depth = 0;
  std::uint32_t payload = 0;       ///< index into the array of its op
  std::uint32_t first_child = 0;   ///< into children; of a primitive, into leaves
  std::uint32_t child_count = 0;
  std::uint32_t first_atom = 0;
  std::uint32_t warp = kNone;      ///< nearest warp above: the node's space
  std::array<std::uint32_t, 4> acts_above{kNone, kNone, kNone, kNone};   ///< by ValueClass: see below
};

/// What is known of a value that stands alone under the operators above it. Most of them pass it on as it is: a sum
/// always; a contact or union of what is not negative; a difference (from its first child) of what is at most 1.
/// acts_above is the nearest node above that may not.
struct ValueClass {
  bool can_be_negative = false;
  bool can_exceed_one = false;
  std::size_t index() const { return (can_be_negative ? 1u : 0u) + (can_exceed_one ? 2u : 0u); }
};

struct CompiledBlend {             ///< contact and fork
  double width = kIso, lip = 0;
  std::uint32_t first_lateral = 0; ///< fork only: into laterals, one per child after the axis; directions normalised
};

struct CompiledWarp {
  Warp warp;
  Interval range;                  ///< of its child's values anywhere
};

/// Native coordinates at the begin of an atom (field.md section 7).
struct AtomCoordinates {
  double v = 0;
  double turn = 0;                 ///< radians about the axis from any_normal(axis) to the direction in which u = 0
};

/// Native coordinates on their way along a chain: u is turned no more than the chain turns.
struct CarriedCoordinates {
  double v = 0;
  Vec3 u{1, 0, 0};                 ///< unit, orthogonal to axis
  Vec3 axis{0, 0, 1};

  static CarriedCoordinates from(const AtomCoordinates& at, const Vec3& axis);
  AtomCoordinates at_atom() const;
  /// From one segment to the one after it; a segment without length has no direction to turn to.
  void advance(const SweptSegment<double>& passed, const SweptSegment<double>& next);
};

/// What is kept of a primitive beside its shape.
struct Leaf {
  std::uint32_t branch = 0, order = 0;
  std::uint32_t first_run = 0;     ///< its atoms are in runs of kRunAtoms, the last one shorter
};
inline constexpr std::uint32_t kRunAtoms = 8;

struct CompiledTree : std::enable_shared_from_this<CompiledTree> {
  std::vector<CompiledNode> nodes;
  std::vector<std::uint32_t> children;
  PrimitiveStore primitives;
  std::vector<CompiledHalfSpace> half_spaces;
  std::vector<CompiledChain> chains;
  std::vector<ChainNode> chain_nodes;
  std::vector<CompiledFlare> flares;
  std::vector<CompiledBlend> blends;
  std::vector<Lateral> laterals;
  std::vector<double> numbers;     ///< exponents and factors
  std::vector<CompiledWarp> warps;
  std::vector<Leaf> leaves;        ///< primitives in depth-first order
  std::vector<std::uint32_t> node_of_atom;
  std::vector<FloatBox> run_bounds;             ///< world boxes outside of which the atoms of a run play no part
  std::vector<AtomCoordinates> run_begin;       ///< of its first atom
  std::vector<std::uint32_t> run_first_atom;
  std::uint32_t root = 0;
  Box bounds;
  BoxIndex index;                  ///< over run_bounds
  AncestorIndex ancestors;         ///< lowest common ancestors of leaves

  std::size_t atom_count() const { return node_of_atom.size(); }
  const CompiledNode& node_of(std::uint32_t atom) const { return nodes[node_of_atom[atom]]; }
  const Leaf& leaf_of(const CompiledNode& primitive) const { return leaves[primitive.first_child]; }
  std::uint32_t run_of(std::uint32_t atom) const {
    const CompiledNode& node = node_of(atom);
    return leaf_of(node).first_run + (atom - node.first_atom) / kRunAtoms;
  }
  std::uint32_t end_atom_of_run(std::uint32_t run) const {
    return run + 1 < run_first_atom.size() ? run_first_atom[run + 1] : static_cast<std::uint32_t>(atom_count());
  }
  /// Lowest common ancestor of two atoms, a < b; of two segments of one chain it is the chain.
  std::uint32_t common_ancestor(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t node = node_of_atom[a];
    return node == node_of_atom[b] ? node : ancestors.common(nodes[node].first_child, node_of(b).first_child);
  }
  /// The two nodes of a chain's segment; `node` is the atom's.
  const ChainNode* segment_ends(const CompiledNode& node, std::uint32_t atom) const {
    return &chain_nodes[chains[node.payload].first_node + (atom - node.first_atom)];
  }
  const CompiledFlare& flare_of(const CompiledNode& node) const { return flares[chains[node.payload].flare]; }
  /// How many times as far as its chain's segment an atom reaches at most. 1 of a flare's atom: it is the chain's.
  double reach_of(const CompiledNode& node, std::uint32_t atom) const {
    return node.op == Op::kFlare ? flare_reach(flare_of(node), segment_ends(node, atom)) : 1;
  }
  /// Support of a segment, in the space of its chain or flare.
  Box segment_support(const CompiledNode& node, std::uint32_t atom) const;
  /// World box outside of which an atom plays no part.
  Box bounds_of(std::uint32_t atom) const;
  CarriedCoordinates coordinates_of(std::uint32_t atom) const;
  /// Smallest surface radius along an atom, metres; infinite for a half-space.
  double radius_of(std::uint32_t atom) const;
  /// The shape of a chain's atom, and of a primitive node.
  SweptSegment<double> segment_of(std::uint32_t atom) const;
  CompiledPrimitive primitive_of(const CompiledNode& node) const { return primitives[node.payload]; }
  double chain_strength_of(const CompiledNode& node) const { return chains[node.payload].strength; }
  /// k counts from 0.
  const Lateral& lateral_of(const CompiledNode& fork, std::size_t k) const {
    return laterals[blends[fork.payload].first_lateral + k];
  }
  std::size_t memory_bytes() const;
};

/// Errors: InvalidNode for an unbounded field or a bend whose child reaches its centre.
CompiledTree compile(const BlobTree& tree);

/// Bounds of values over a ball in the shape's own space.
Interval primitive_interval(const CompiledPrimitive& primitive, const Ball& ball);
Interval half_space_interval(const CompiledHalfSpace& half_space, const Ball& ball);

/// Where the axis of an atom's native coordinates begins and points, and a normal of it to count turns from.
struct NativeAxis {
  Vec3 origin, axis;
};
NativeAxis native_axis(const CompiledPrimitive& primitive);

Vec3 any_normal(const Vec3& axis);

}  // namespace cambium
