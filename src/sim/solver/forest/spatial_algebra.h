// Spatial vectors and inertias (Featherstone): linear and angular motion or impulse of a body in one vector, at its
// center of mass, in world axes. Double precision; doesn't depend on Bullet.
#pragma once

#include "base/vec.h"

namespace limber::sim::solver {

/// A velocity (m/s, rad/s), or an impulse (N·s, N·m·s).
struct Spatial {
  Vec3 linear{0};
  Vec3 angular{0};

  Spatial& operator+=(const Spatial& o) {
    linear += o.linear;
    angular += o.angular;
    return *this;
  }
  Spatial operator+(const Spatial& o) const { return {linear + o.linear, angular + o.angular}; }
  Spatial operator-(const Spatial& o) const { return {linear - o.linear, angular - o.angular}; }
  Spatial operator*(double s) const { return {linear * s, angular * s}; }
};
/// Dot product of an impulse and a velocity.
inline double dot(const Spatial& a, const Spatial& b) {
  return a.linear.x * b.linear.x + a.linear.y * b.linear.y + a.linear.z * b.linear.z + a.angular.x * b.angular.x +
         a.angular.y * b.angular.y + a.angular.z * b.angular.z;
}
/// Moves a velocity to a point at `shift` from the reference point of the rigid body, or an impulse at that point back
/// to the reference point.
inline Spatial translated(const Spatial& v, const Vec3& shift) {
  return {v.linear + glm::cross(v.angular, shift), v.angular};
}
inline Spatial translated_back(const Spatial& f, const Vec3& shift) {
  return {f.linear, f.angular + glm::cross(shift, f.linear)};
}

/// Symmetric 3 x 3 matrix.
struct Sym3 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  Vec3 operator*(const Vec3& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  Sym3& operator+=(const Sym3& o) {
    xx += o.xx;
    yy += o.yy;
    zz += o.zz;
    xy += o.xy;
    xz += o.xz;
    yz += o.yz;
    return *this;
  }
  void subtract_outer_product(const Vec3& u, double scale) {
    const Vec3 s = u * scale;
    xx -= u.x * s.x;
    yy -= u.y * s.y;
    zz -= u.z * s.z;
    xy -= u.x * s.y;
    xz -= u.x * s.z;
    yz -= u.y * s.z;
  }
};

/// Symmetric 6 x 6 inertia in blocks: maps a velocity to an impulse.
struct SpatialInertia {
  Sym3 mass;           // linear, linear
  Vec3 coupling[3]{};  // rows: linear; columns: angular
  Sym3 moment;         // angular, angular

  SpatialInertia() : coupling{Vec3(0), Vec3(0), Vec3(0)} {}
  /// Inertia of a rigid body at its center of mass.
  SpatialInertia(double kilograms, const Sym3& inertia) : SpatialInertia() {
    mass.xx = mass.yy = mass.zz = kilograms;
    moment = inertia;
  }

  Spatial operator*(const Spatial& v) const {
    const Vec3& w = v.angular;
    Spatial out{mass * v.linear, moment * w};
    out.linear += Vec3(glm::dot(coupling[0], w), glm::dot(coupling[1], w), glm::dot(coupling[2], w));
    out.angular += coupling[0] * v.linear.x + coupling[1] * v.linear.y + coupling[2] * v.linear.z;
    return out;
  }
  /// Rank-one downdate: this -= scale·u·u'.
  void subtract_outer_product(const Spatial& u, double scale) {
    mass.subtract_outer_product(u.linear, scale);
    moment.subtract_outer_product(u.angular, scale);
    const Vec3 s = u.angular * scale;
    coupling[0] -= s * u.linear.x;
    coupling[1] -= s * u.linear.y;
    coupling[2] -= s * u.linear.z;
  }
  /// Adds the inertia `other` of a rigidly attached body, given at a point `shift` away.
  void add_translated(const SpatialInertia& other, const Vec3& shift);
};

// With A, B, C: mass, coupling, moment, and R y = r x y, so that the velocity at the distance r is v - R w:
// B' = B - A R,  C' = C + (R B)' + R B'.
inline void SpatialInertia::add_translated(const SpatialInertia& other, const Vec3& r) {
  const Sym3& a = other.mass;
  // row i of A R is (A row i) x r, as x'R y = x·(r x y) = (x x r)·y
  const Vec3 shifted_coupling[3] = {other.coupling[0] - glm::cross(Vec3(a.xx, a.xy, a.xz), r),
                                    other.coupling[1] - glm::cross(Vec3(a.xy, a.yy, a.yz), r),
                                    other.coupling[2] - glm::cross(Vec3(a.xz, a.yz, a.zz), r)};
  mass += a;
  for (int i = 0; i < 3; ++i) coupling[i] += shifted_coupling[i];
  // rows of R B: R = (0 -rz ry; rz 0 -rx; -ry rx 0)
  const auto crossed = [&r](const Vec3* b, int i) {
    return i == 0 ? b[2] * r.y - b[1] * r.z : (i == 1 ? b[0] * r.z - b[2] * r.x : b[1] * r.x - b[0] * r.y);
  };
  const Vec3 p[3] = {crossed(other.coupling, 0), crossed(other.coupling, 1), crossed(other.coupling, 2)};
  const Vec3 q[3] = {crossed(shifted_coupling, 0), crossed(shifted_coupling, 1), crossed(shifted_coupling, 2)};
  moment += other.moment;
  moment.xx += p[0].x + q[0].x;
  moment.yy += p[1].y + q[1].y;
  moment.zz += p[2].z + q[2].z;
  moment.xy += p[1].x + q[0].y;
  moment.xz += p[2].x + q[0].z;
  moment.yz += p[2].y + q[1].z;
}

}  // namespace limber::sim::solver
