// The turtle's frame (lsystem.md): H heading, L left, U, and its rotations.
#pragma once

#include "blobtree/geometry.h"

namespace cambium {

/// Orthonormal, U = L x H. World is z up.
struct TurtleFrame {
  Vec3 heading{0, 0, 1};
  Vec3 left{-1, 0, 0};
  Vec3 up{0, 1, 0};

  void yaw(double radians);                          ///< `+`: H towards L
  void pitch(double radians);                        ///< `&`: H towards U
  void roll(double radians);                         ///< `/`: L towards U
  void turn_back();                                  ///< `|`: half a turn about U
  void level();                                      ///< `$`: L horizontal; nothing where H is vertical
  /// Tropism: about H x T by elasticity |H x T| radians.
  void bend(const Vec3& tropism, double elasticity);
  /// `@R`: H along `heading`, U near `up`, or near the present U if that is null. False if the two are parallel or zero.
  bool orient(const Vec3& new_heading, const Vec3* new_up);
  void restore_orthonormality();                     ///< after many rotations
};

}  // namespace cambium
