// The compiled field of a BlobTree, pruned fields that are exact in a box, and the evaluator.
// Field and PrunedField are immutable and may be shared by threads; an Evaluator is scratch, one per thread.
#pragma once

#include "blobtree/blobtree.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace cambium {

struct CompiledTree;  // private to blobtree/
class Tape;
struct CoverOptions;
struct RunOptions;
class SurfaceCover;

/// Field value and its analytic gradient (1/m). The outward normal is -gradient/|gradient|.
struct Sample {
  double value = 0;
  Vec3 gradient{0.0};
};

/// Bounds of the field along a straight way: of its values, and of its slope, which is its derivative by metres of the way. Across
/// creases too f(b) - f(a) is between (b - a) slope.lo and (b - a) slope.hi. Default: of nothing, which is 0.
struct Course {
  Interval value, slope;
};

/// What one primitive contributes at a point (field.md section 7): weight f_i > 0 and its native coordinates.
struct Contribution {
  double weight = 0;
  double u = 0;        ///< turns, [0, 1)
  double v = 0;        ///< metres along the branch axis, straight on beyond its ends
  double radius = 0;   ///< local surface radius, metres; of a flare in its valleys, the same all around
  double from_axis = 0;             ///< metres from the line through the nearest piece of the axis
  Vec3 weight_gradient{0.0};        ///< 1/m
  Vec3 u_gradient{0.0};             ///< turns per metre, around the branch; where a chain turns it leaves that out
  Vec3 v_gradient{0.0};             ///< metres per metre, along the branch; likewise
  std::uint32_t primitive = 0;      ///< which one (a chain is one): the same number all over the field
  std::uint32_t branch = 0;
  std::uint32_t order = 0;
};

/// How the surface at a point came about, each in [0, 1]: made by the subtracted side of a difference or intersection with a
/// half-space (a cut face), raised or pressed by contact modelling (a ridge), dented by negative strength (a scar).
struct SurfaceTraits {
  double cut = 0;
  double ridge = 0;
  double dent = 0;
};

/// Primitives (chain segments count singly) that can be non-zero in some box, ascending in depth-first order.
struct ActiveSet {
  std::vector<std::uint32_t> atoms;
};

/// A field that equals the whole field exactly (to the last bit in double) inside box(), and holds only what can be
/// non-zero there. A handle: cheap to copy.
class PrunedField {
 public:
  PrunedField() = default;
  const Box& box() const { return box_; }
  const Vec3& origin() const { return origin_; }   ///< batches are relative to this (the box's centre)
  bool empty() const;                              ///< zero everywhere in the box
  std::size_t atom_count() const;
  std::size_t memory_bytes() const;                ///< what it holds beside the Field; neighbouring cells of a cover share it
  /// The smallest surface radius of an active primitive, metres (infinite if none has one).
  double smallest_radius() const;
  /// The same field in a part of its box, with what is active there. Cost: linear in atom_count().
  PrunedField narrowed(const Box& part) const;

 private:
  friend class Field;
  friend class Evaluator;
  friend class SurfaceCover;
  friend class CoverRun;
  friend class CellSearch;
  friend class ActiveChain;
  friend class LoneChain;
  PrunedField(const CompiledTree& tree, const Tape& tape, std::shared_ptr<const void> owner, const Box& box);
  const CompiledTree* tree_ = nullptr;
  const Tape* tape_ = nullptr;
  std::shared_ptr<const void> owner_;              ///< of tree and tape; none where a cover owns them
  Box box_;
  Vec3 origin_{0.0};
};

/// Compiled once from a BlobTree. Memory: linear in primitives.
class Field {
 public:
  /// Errors: InvalidNode if the field is unbounded (a half-space that nothing bounds) or a bend is invalid (support >= rho).
  explicit Field(const BlobTree& tree);

  /// Outside this box the field is exactly 0.
  const Box& bounds() const;
  std::size_t atom_count() const;      ///< primitives, chain segments counted singly
  std::size_t memory_bytes() const;    ///< of everything held; about 45 per chain segment and 250 per axis with laterals

  /// Thread safe; cost: the primitives active at p and a logarithmic search. For many points prune once and use batches.
  double value(const Vec3& p) const;
  Sample sample(const Vec3& p) const;
  /// Conservative: contains every value taken in the box.
  Interval interval(const Box& box) const;

  PrunedField prune(const Box& box) const;
  PrunedField whole() const;           ///< unpruned: every primitive and operator, for tests and tiny trees

  ActiveSet active(const Box& box) const;
  ActiveSet narrow(const ActiveSet& from, const Box& box) const;   ///< box inside the box of `from`; cost: |from|
  PrunedField prune(const ActiveSet& active, const Box& box) const;

  /// Surface radius and support box of one atom (for cell-size rules and reports).
  double atom_radius(std::uint32_t atom) const;    ///< smallest surface radius along it; kInfinity for a half-space
  Box atom_bounds(std::uint32_t atom) const;

 private:
  friend class CellSearch;
  friend std::optional<SurfaceCover> cover_surface(const Field&, const CoverOptions&, const RunOptions&);
  std::shared_ptr<const CompiledTree> tree_;
};

/// Scratch for evaluation: one per thread.
class Evaluator {
 public:
  Evaluator();
  ~Evaluator();
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;

  double value(const PrunedField& field, const Vec3& p);
  Sample sample(const PrunedField& field, const Vec3& p);
  /// Conservative over the part of the ball inside field.box().
  Interval interval(const PrunedField& field, const Ball& ball);
  Interval interval(const PrunedField& field, const Box& box);
  /// Bounds along the straight way from middle - half direction to middle + half direction, which lies in field.box(); direction
  /// is a unit vector. As the way gets shorter the slopes close in on each other in proportion, but for creases, the
  /// ends of a bend, and twists and tapers, where they stay apart. Cost: about that of one interval.
  Course course(const PrunedField& field, const Vec3& middle, const Vec3& direction, double half);
  /// The same of all ways in one direction through a ball, for the part of it inside field.box(): where the slope keeps its sign, at
  /// most one sheet of the surface is there.
  Course course(const PrunedField& field, const Ball& ball, const Vec3& direction);

  /// Batches: SoA floats relative to field.origin(), equal lengths. Agree with value()/sample() to 1e-4.
  void values(const PrunedField& field, std::span<const float> x, std::span<const float> y, std::span<const float> z,
              std::span<float> f);
  void samples(const PrunedField& field, std::span<const float> x, std::span<const float> y, std::span<const float> z,
               std::span<float> f, std::span<float> gx, std::span<float> gy, std::span<float> gz);

  /// Appends nothing but what contributes at p; primitives taken away by a difference do not. Clears `out` first.
  void contributions(const PrunedField& field, const Vec3& p, std::vector<Contribution>& out);
  SurfaceTraits surface_traits(const PrunedField& field, const Vec3& p);

  struct Scratch;  ///< private to blobtree/

 private:
  Course course(const Ball& ball, const Vec3& direction, bool wide, const PrunedField& field);

  std::unique_ptr<Scratch> scratch_;
};

}  // namespace cambium
