// A BlobTree compiled for evaluation and pruning. Private to blobtree/.
//
// Node ids are those of the BlobTree. Its primitives, with a chain's segments counted singly, are `atoms`, numbered in depth-first
// order; every operator covers a range of them. Pruning gathers the atoms whose support meets a box and rebuilds the operators
// above them from lowest common ancestors, so it never walks the depth of the tree (tape.h).
#pragma once

#include "blobtree/atom_index.h"
#include "blobtree/blobtree.h"
#include "blobtree/skeleton_primitives.h"
#include "blobtree/warps.h"

#include <cstdint>
#include <memory>
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
  SkeletonShape<double> shape;
  double inverse_support = 0;
  double strength = 1;
};

struct CompiledHalfSpace {
  Vec3 point, normal;
  double width = 0;
};

struct CompiledNode {
  Op op = Op::kSum;
  bool subtracted = false;         ///< taken away by a difference above
  bool can_be_negative = false;
  std::uint32_t parent = kNone;
  std::uint32_t depth = 0;
  std::uint32_t payload = 0;       ///< index into the array of its op
  std::uint32_t first_child = 0, child_count = 0;   ///< into children
  std::uint32_t first_atom = 0, end_atom = 0;
  std::uint32_t warp = kNone;      ///< nearest warp above: the node's space
  std::uint32_t keep_structural = kNone;  ///< this or the nearest node above that acts even on a single child
  std::uint32_t keep_sensitive = kNone;   ///< likewise for a child that may be negative
  Interval range;                  ///< of its values anywhere
};

struct CompiledBlend {             ///< contact and fork
  double width = kIso, lip = 0;
  std::vector<Lateral> laterals;   ///< fork only; directions normalised
};

struct Atom {
  std::uint32_t node = 0;
  std::uint32_t segment = kNone;   ///< into segments, for chains
  double radius = kInfinity;       ///< smallest surface radius along it
  Box bounds;                      ///< world box outside of which it plays no part
};

/// Native coordinates at the begin of an atom (field.md section 7).
struct AtomCoordinates {
  double v = 0;
  Vec3 u_direction{1, 0, 0};       ///< unit, orthogonal to the atom's axis
};

struct CompiledTree : std::enable_shared_from_this<CompiledTree> {
  std::vector<CompiledNode> nodes;
  std::vector<std::uint32_t> children;
  std::vector<CompiledPrimitive> primitives;
  std::vector<CompiledHalfSpace> half_spaces;
  std::vector<double> chain_strengths;
  std::vector<SweptSegment<double>> segments;
  std::vector<CompiledBlend> blends;
  std::vector<double> numbers;     ///< exponents and factors
  std::vector<Warp> warps;
  std::vector<Atom> atoms;
  std::vector<AtomCoordinates> coordinates;
  std::vector<std::uint32_t> branch, order;   ///< per node
  std::uint32_t root = 0;
  Box bounds;
  BoxIndex index;                  ///< over atom bounds
  AncestorIndex ancestors;         ///< lowest common ancestors of atoms

  /// World box outside of which an atom plays no part.
  Box bounds_of(std::uint32_t atom) const { return atoms[atom].bounds; }
  /// Smallest surface radius along an atom, metres; infinite for a half-space.
  double radius_of(std::uint32_t atom) const { return atoms[atom].radius; }
  /// The shape of a chain's atom, and of a primitive node.
  SweptSegment<double> segment_of(std::uint32_t atom) const { return segments[atoms[atom].segment]; }
  CompiledPrimitive primitive_of(const CompiledNode& node) const { return primitives[node.payload]; }
};

/// Errors: InvalidNode for an unbounded field or a bend whose child reaches its centre.
CompiledTree compile(const BlobTree& tree);

/// Bounds of values over a ball in the shape's own space.
Interval primitive_interval(const CompiledPrimitive& primitive, const Ball& ball);
Interval half_space_interval(const CompiledHalfSpace& half_space, const Ball& ball);

}  // namespace cambium
