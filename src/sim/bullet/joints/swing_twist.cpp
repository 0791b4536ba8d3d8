// SwingTwist: angles and axes from the quaternion of a rotation.
#include "sim/bullet/joints/swing_twist.h"

#include <cmath>

#include "base/math/fixed_math.h"

namespace limber::sim::bullet {
namespace {

/// A shorter vector has no direction: the rounding errors of single precision are as large.
constexpr double kMinLength = 1e-6;

Vec3 unit_or_zero(const Vec3& v) {
  const double length = glm::length(v);
  return length > kMinLength ? v / length : Vec3(0);
}

}  // namespace

SwingTwist swing_twist(Quat rotation) {
  if (rotation.w < 0) rotation = -rotation;
  const Vec3 vector(rotation.x, rotation.y, rotation.z);
  SwingTwist out;
  out.swing = 2 * fixed::atan2(fixed::hypot(vector.x, vector.y), fixed::hypot(rotation.w, vector.z));
  out.twist = 2 * fixed::atan2(vector.z, rotation.w);
  out.angle = 2 * fixed::atan2(glm::length(vector), rotation.w);
  out.z = rotation * Vec3(0, 0, 1);
  out.swing_axis = unit_or_zero(Vec3(-out.z.y, out.z.x, 0));
  // (z + z')/(1 + cos swing), see docs/understand/solver.md
  const double scale = 1 + out.z.z;
  out.twist_axis = scale > kMinLength ? (Vec3(0, 0, 1) + out.z) / scale : Vec3(0);
  out.angle_axis = unit_or_zero(vector);
  return out;
}

double turned_into(double angle, double lower, double upper) {
  return angle - 2 * kPi * std::round((angle - 0.5 * (lower + upper)) / (2 * kPi));
}

}  // namespace limber::sim::bullet
