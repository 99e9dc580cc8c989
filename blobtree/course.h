// How the field goes along a short straight way: bounds of its values and of its slope, through every operator. What certifies
// roots on rays. Private to blobtree/ but for Course itself (field.h).
//
// A slope is the derivative by the metres of the way. Where the field has a crease the bounds hold the slopes of both sides, so the
// mean value theorem stands: f(b) - f(a) is between (b - a) slope.lo and (b - a) slope.hi for all a < b of the way.
#pragma once

#include "blobtree/field.h"
#include "blobtree/skeleton_primitives.h"

#include <cstddef>

namespace cambium {

/// The way through one frame's space. Where all warps outside are rigid it is straight: from middle - half velocity to
/// middle + half velocity. Inside a bend it is nearly so: all that is known then is the ball that holds it, and how far its velocity may
/// be from that in the middle. Else not even that, but how fast it goes at most.
struct Way {
  Vec3 middle{0.0}, velocity{0.0};   ///< the latter by metres in the world, in the middle
  double half = 0;                   ///< metres in the world; half speed is at most as far as the way goes from its middle
  double turn = 0;                   ///< |velocity anywhere - velocity| at most
  bool straight = true;              ///< or nearly so: all but ball, speed and certain is known
  bool wide = false;                 ///< also all ways parallel to it in the ball
  Ball ball;
  double speed = 1;                  ///< |velocity| in the middle; at most, where it is not straight
  bool certain = true;               ///< as UnwarpedBall's
  double fastest() const { return speed + turn; }
};

/// The square of a distance over its support radius, along a way, with its slope: both smooth but for where a segment's nearest
/// piece changes, and there the slope is continuous.
struct SquaredRatio {
  Interval value, slope;
};

/// A segment of a chain as the middle of a straight way sees it.
struct SeenSegment {
  const SweptSegment<double>* segment;
  Vec3 v;                  ///< from the nearest axis point
  double r, per_r;         ///< the radius there, and 1 over it
  double x;                ///< the swept ratio
  double least, change;    ///< the segment's least radius; the ratio's change along the way, at most
};

/// The operators of field.md section 4 over the courses of their active children, as in operators.h.
Course sum_of(const Course* f, std::size_t n);
Course max_of(const Course* f, std::size_t n, bool with_zero);
Course min_of(const Course* f, std::size_t n, bool with_zero);
Course difference_of(const Course& first, const Course* taken, std::size_t n, bool capped);
Course ricci_of(const Course* f, std::size_t n, double exponent);
Course contact_of(const Course* f, std::size_t n, bool with_zero, double width, double lip);
Course fork_of(const Course& axis, const Course* f, const Course* weights, std::size_t n, bool with_zero, double width, double lip);
Course scaled(const Course& f, double factor);

/// The slope with which a child pushes another in contact, D'(f) of field.md section 4, over an interval of f.
Interval contact_push_slope(const Interval& f, double width, double lip);

}  // namespace cambium
