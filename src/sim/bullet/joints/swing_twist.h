// SwingTwist: a rotation as a twist about z, followed by a swing of the z axis.
#pragma once

#include "base/vec.h"

namespace limber::sim::bullet {

/// R = swing·twist, with the twist about z and the swing about an axis in the x-y plane. All axes are given in the
/// frame that R rotates from: the parent's frame of a joint.
struct SwingTwist {
  double swing = 0;  ///< Angle between both z axes, 0 .. π.
  double twist = 0;  ///< Angle about the own axis, -π .. π; arbitrary where the swing is π.
  double angle = 0;  ///< Of the whole rotation, 0 .. π.
  Vec3 z{0, 0, 1};   ///< The rotated z axis.
  /// The rate of an angle is the dot product of its axis with the relative angular velocity. `swing_axis` and
  /// `angle_axis` are unit vectors, or zero where the angle is 0 (the swing: or π); the length of `twist_axis` is
  /// 1/cos(swing/2), and it is zero where the swing is π.
  Vec3 swing_axis{0};
  Vec3 twist_axis{0, 0, 1};
  Vec3 angle_axis{0};
};

/// `rotation`: a unit quaternion.
SwingTwist swing_twist(Quat rotation);

/// The angle, changed by full turns to be nearest to the center of [lower, upper].
double turned_into(double angle, double lower, double upper);

}  // namespace limber::sim::bullet
