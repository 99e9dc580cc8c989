// A BlobTree compiled for evaluation and pruning. Private to blobtree/.
//
// Node ids are those of the BlobTree. Its primitives, with a chain's segments counted singly, are `atoms`, numbered in depth-first
// order; every operator covers a range of them. Pruning gathers the atoms whose support meets a box and rebuilds the operators
// above them from lowest common ancestors, so it never walks the depth of the tree (tape.h). A chain is kept as its nodes, 32 bytes
// each; what evaluation wants of a segment (axis, length, slope) is worked out where a tape is gathered.
#pragma once

#include "blobtree/atom_index.h"
#include "blobtree/blobtree.h"
#include "blobtree/float_box.h"
#include "blobtree/skeleton_primitives.h"
#include "blobtree/warps.h"

#include <cstdint>
#include <memory>
#include <tuple>
#include <variant>
#include <vector>

namespace cambium {

inline constexpr std::uint32_t kNone = 0xffffffffu;

enum class Op : std::uint8_t {
  kPrimitive, kHalfSpace, kChain,
  kSum, kUnion, kIntersection, kDifference, kRicci, kContact, kFork, kScale, kWarp
};

template <class T>
using SkeletonShape = std::variant<PointSkeleton<T>, SegmentSkeleton<T>, ConeSkeleton<T>, DiscSkeleton<T>, CircleSkeleton<T>,
                                   BoxSkeleton<T>>;

/// f = strength * g(distance * inverse_support).
struct CompiledPrimitive {
  CompiledPrimitive() = default;
  CompiledPrimitive(SkeletonShape<double> form, double surface_radius, double factor)
      : shape(std::move(form)), radius(surface_radius), inverse_support(1 / (kSupportPerRadius * surface_radius)), strength(factor) {}

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
};

struct CompiledNode {
  Op op = Op::kSum;
  bool subtracted : 1 = false;     ///< taken away by a difference above
  bool can_be_negative : 1 = false;
  std::uint32_t depth = 0;
  std::uint32_t payload = 0;       ///< index into the array of its op
  std::uint32_t first_child = 0;   ///< into children; of a primitive, into owners
  std::uint32_t child_count = 0;
  std::uint32_t first_atom = 0;
  std::uint32_t warp = kNone;      ///< nearest warp above: the node's space
  std::uint32_t structural_above = kNone;  ///< the nearest node above that acts even on a single child
  std::uint32_t sensitive_above = kNone;   ///< likewise on a child that may be negative
};

struct CompiledBlend {             ///< contact and fork
  double width = kIso, lip = 0;
  std::uint32_t first_lateral = 0; ///< fork only: into laterals, one per child after the axis; directions normalised
};

struct CompiledWarp {
  Warp warp;
  Interval range;                  ///< of its child's values anywhere
};

struct Atom {
  std::uint32_t node = 0;
  std::uint32_t element = 0;       ///< of a chain: the first node of the segment, into chain_nodes
};

/// Native coordinates at the begin of an atom (field.md section 7).
struct AtomCoordinates {
  double v = 0;
  double turn = 0;                 ///< radians about the axis from any_normal(axis) to the direction in which u = 0
};

/// Who a primitive belongs to.
struct Owner {
  std::uint32_t branch = 0, order = 0;
};

struct CompiledTree : std::enable_shared_from_this<CompiledTree> {
  std::vector<CompiledNode> nodes;
  std::vector<std::uint32_t> children;
  PrimitiveStore primitives;
  std::vector<CompiledHalfSpace> half_spaces;
  std::vector<CompiledChain> chains;
  std::vector<ChainNode> chain_nodes;
  std::vector<CompiledBlend> blends;
  std::vector<Lateral> laterals;
  std::vector<double> numbers;     ///< exponents and factors
  std::vector<CompiledWarp> warps;
  std::vector<Atom> atoms;
  std::vector<FloatBox> bounds_of_atoms;   ///< world boxes outside of which they play no part
  std::vector<AtomCoordinates> coordinates;
  std::vector<Owner> owners;       ///< of primitives
  std::uint32_t root = 0;
  Box bounds;
  BoxIndex index;                  ///< over atom bounds
  AncestorIndex ancestors;         ///< lowest common ancestors of atoms

  /// World box outside of which an atom plays no part.
  Box bounds_of(std::uint32_t atom) const { return bounds_of_atoms[atom].box(); }
  /// Smallest surface radius along an atom, metres; infinite for a half-space.
  double radius_of(std::uint32_t atom) const;
  /// The shape of a chain's atom, and of a primitive node.
  SweptSegment<double> segment_of(std::uint32_t atom) const;
  CompiledPrimitive primitive_of(const CompiledNode& node) const { return primitives[node.payload]; }
  double chain_strength_of(const CompiledNode& node) const { return chains[node.payload].strength; }
  const Owner& owner_of(const CompiledNode& primitive) const { return owners[primitive.first_child]; }
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
NativeAxis native_axis(const SweptSegment<double>& segment);
Vec3 any_normal(const Vec3& axis);

}  // namespace cambium
