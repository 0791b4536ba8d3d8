// Vectors, quaternions and poses in double precision (glm), and conversions between them. SI units, right-handed, Z up;
// quaternions are in the order x y z w.
#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "base/math/fixed_math.h"

namespace limber {

using Vec3 = glm::dvec3;
/// Unit quaternion. Beware: glm's constructor takes w first; use quat_xyzw().
using Quat = glm::dquat;
using Mat3 = glm::dmat3;

inline constexpr double kPi = 3.14159265358979323846;

inline Quat quat_xyzw(double x, double y, double z, double w) { return Quat(w, x, y, z); }
inline Quat quat_identity() { return Quat(1, 0, 0, 0); }
inline Quat quat_axis(const Vec3& unit_axis, double angle) {
  const fixed::SinCos half = fixed::sincos(angle / 2);
  return Quat(half.cos, unit_axis * half.sin);
}
/// Spherical interpolation along the shorter arc; `amount` from 0 (a) to 1 (b). The result is a unit quaternion.
inline Quat slerp(const Quat& a, const Quat& b, double amount) {
  const double dot = glm::dot(a, b);
  const double cosine = std::fabs(dot);
  const Quat end = dot < 0 ? -b : b;
  // Close rotations: the weights of the arc differ from those of the chord by less than a double resolves.
  if (cosine > 1 - 1e-15) return glm::normalize(a * (1 - amount) + end * amount);
  const double angle = fixed::acos(cosine);
  return glm::normalize(a * fixed::sin((1 - amount) * angle) + end * fixed::sin(amount * angle));
}

/// Returns the rotation Rz(z)·Ry(y)·Rx(x), the roll-pitch-yaw angles of URDF about fixed axes, in radians.
inline Quat quat_euler(double x, double y, double z) {
  return quat_axis({0, 0, 1}, z) * quat_axis({0, 1, 0}, y) * quat_axis({1, 0, 0}, x);
}

/// The inverse of quat_euler: x and z in (-pi, pi], y in [-pi/2, pi/2]. At y = ±pi/2 only the sum or the difference of
/// x and z is determined; z is 0 there.
inline Vec3 euler_of(const Quat& q) {
  constexpr double kLockCosine = 1e-7;  // cosine of y below which x and z consist of rounding errors
  const Mat3 m = glm::mat3_cast(q);
  const double sin_y = -m[0][2];
  const double y = fixed::asin(sin_y > 1 ? 1 : (sin_y < -1 ? -1 : sin_y));
  if (m[1][2] * m[1][2] + m[2][2] * m[2][2] < kLockCosine * kLockCosine) return {fixed::atan2(-m[2][1], m[1][1]), y, 0};
  return {fixed::atan2(m[1][2], m[2][2]), y, fixed::atan2(m[0][1], m[0][0])};
}

/// Returns the unit vector along v, or zero for the zero vector (no NaN).
inline Vec3 normalized(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : Vec3(0);
}

inline bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
inline bool is_finite(const Quat& q) {
  return std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) && std::isfinite(q.w);
}

// Conversions between arrays of numbers, as in the store and in streams, and vectors (3) or quaternions (4: x y z w).
inline Vec3 vec3_at(const double* v) { return {v[0], v[1], v[2]}; }
inline Quat quat_at(const double* v) { return quat_xyzw(v[0], v[1], v[2], v[3]); }
inline void put(double* to, const Vec3& v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}
inline void put(double* to, const Quat& q) {
  to[0] = q.x;
  to[1] = q.y;
  to[2] = q.z;
  to[3] = q.w;
}

/// A rigid transform: rotation, then translation.
struct Pose {
  Vec3 position{0, 0, 0};
  Quat rotation = quat_identity();

  Pose operator*(const Pose& b) const { return {position + rotation * b.position, rotation * b.rotation}; }
  Vec3 operator*(const Vec3& v) const { return position + rotation * v; }
  Pose inverse() const {
    const Quat r = glm::conjugate(rotation);
    return {r * -position, r};
  }
};

/// True if both differ by rounding errors only: at most about 1e-9 m and 1e-9 rad.
inline bool nearly_same(const Vec3& a, const Vec3& b) { return glm::length(a - b) <= 1e-9 * (1 + glm::length(a)); }
inline bool nearly_same(const Quat& a, const Quat& b) {
  const double sign = glm::dot(a, b) < 0 ? -1 : 1;
  const Quat d = a - sign * b;
  return glm::dot(d, d) <= 1e-18;
}
inline bool nearly_same(const Pose& a, const Pose& b) {
  return nearly_same(a.position, b.position) && nearly_same(a.rotation, b.rotation);
}

}  // namespace limber
