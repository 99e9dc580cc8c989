// A pruned field made ready for batches: flat steps over chunks of points, with every shape placed relative to the origin
// of the batch. Private to blobtree/. Shapes are placed in double and then rounded to T, so that a 1 mm twig 30 m up loses
// nothing.
//
// A program is plain data: it refers to nothing, so it stays valid whatever becomes of the field it was made from.
// A sum adds each child as it comes (from left to right, as points do); a primitive or chain adds itself to the slot below.
#pragma once

#include "blobtree/interpreter.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

template <class T>
struct LocalFalloff {                     ///< f = strength * s^3, s = 1 - d^2 * per_square; gradient s^2 * slope * offset
  T per_square, strength, slope;
};
template <class T>
struct LocalPoint {
  T center[3];
  LocalFalloff<T> falloff;
};
template <class T>
struct LocalSegment {                     ///< a + s axis, s in [begin, end]; a is the point of it nearest to the origin
  T a[3], axis[3], begin, end;
  LocalFalloff<T> falloff;
};
/// Solid cone in its own coordinates u, v across and h along its axis, in units of the support radius, from the point of
/// the axis nearest to the origin: rows of {x, y, z, offset}. On the slanted side: the point (rho, h) = (core, 0), the
/// tangent towards the apex and how far the side runs both ways.
template <class T>
struct LocalCone {
  T u[4], v[4], h[4], core, tangent_rho, tangent_h, side_begin, side_end, base_h, disc_radius;
  LocalFalloff<T> falloff;
};
template <class T>
struct LocalRing {                        ///< a disc or a circle
  T center[3], normal[3], radius;
  LocalFalloff<T> falloff;
};
template <class T>
struct LocalBox {
  T center[3], half_size[3], axes[3][3];
  LocalFalloff<T> falloff;
};
template <class T>
struct LocalHalfSpace {
  T point[3], normal[3], inverse_two_widths;
};
template <class T>
struct LocalSwept {                       ///< one segment of a chain: a + s axis with radius `radius + slope s`
  T a[3], axis[3], begin, end, radius, slope;
};
/// What widens the segments of a flare (flare.h). Rows {x, y, z, offset}: 1 - z/h, and the coordinates beside the axis, x towards the
/// batch's origin so that no gap begins or ends where azimuths jump.
template <class T>
struct LocalFlare {
  T rest[4], x[4], y[4], spread, sharpness;
  FlareSection section = FlareSection::kEnvelope;
  std::uint32_t first_gap = 0, gap_count = 0;
};
template <class T>
struct LocalFlareGap {                    ///< between prongs, azimuths from x; more: what the next prong has over `length`
  T begin, per_width, length, more;
};
template <class T>
struct LocalLateral {
  T point[3], direction[3], half_per_softness, reach, per_reach;
};
/// The space inside a warp, relative to its own origin. In a linear one q = matrix * p; others map points in double, into
/// floats too.
template <class T>
struct LocalFrame {
  std::uint32_t outside = 0;
  bool linear = false;
  T matrix[3][3] = {};                    ///< rows
  Vec3 origin{0.0};                       ///< of this space, in its own coordinates
  Warp warp;
};

enum class StepKind : std::uint8_t {
  kPoint, kSegment, kCone, kDisc, kCircle, kBox, kHalfSpace, kChain, kFlare,
  kAdd, kUnion, kIntersection, kDifference, kRicci, kContact, kFork, kScale, kWarp
};

struct Step {
  StepKind kind = StepKind::kAdd;
  bool adds = false;                      ///< primitives and chains: the value is added to the slot instead of stored there
  bool with_zero = false;                 ///< operators: a child is left out because it is 0
  bool has_first = false;                 ///< difference and fork: the first child is active
  std::uint16_t frame = 0;
  std::uint32_t slot = 0;                 ///< where the value goes; an operator finds its children from here on
  std::uint32_t first = 0;                ///< index among the shapes of its kind, among segments, laterals or numbers
  std::uint32_t count = 0;                ///< children, or segments of a chain
  std::uint32_t flare = 0;                ///< index of what widens these
  double width = 0, lip = 0;              ///< of contact and fork; `width` also holds an exponent, a factor or a strength
};

template <class T>
struct BatchProgram {
  std::vector<Step> steps;
  std::vector<LocalFrame<T>> frames;      ///< [0] is the world
  std::vector<LocalPoint<T>> points;
  std::vector<LocalSegment<T>> segments;
  std::vector<LocalCone<T>> cones;
  std::vector<LocalRing<T>> rings;
  std::vector<LocalBox<T>> boxes;
  std::vector<LocalHalfSpace<T>> half_spaces;
  std::vector<LocalSwept<T>> swept;
  std::vector<LocalFlare<T>> flares;
  std::vector<LocalFlareGap<T>> flare_gaps;
  std::vector<LocalLateral<T>> laterals;
  std::uint32_t slot_count = 0;

  void clear();
};

/// Makes programs; keeps its memory from one to the next.
class BatchCompiler {
 public:
  /// The tape relative to `origin`, for points in `box`. Cost: linear in the tape.
  /// False if T is float and floats could not keep 1e-4 there; the program is then not usable.
  template <class T>
  bool compile(const TapeView& view, const Box& box, const Vec3& origin, BatchProgram<T>& out);

 private:
  struct Consumer {                       ///< who takes the value of an instruction, and as which child
    std::uint32_t instruction = 0, child = 0;
  };
  void find_consumers(const TapeView& view);

  std::vector<Consumer> consumers_;
  std::vector<std::uint32_t> stack_;
  std::vector<double> reaches_;           ///< per frame: how far from its origin points may be
};

}  // namespace cambium
