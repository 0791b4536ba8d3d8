// FlockRig: bodies of one or several balls, and a brute-force computation of neighbor means in double precision.
#pragma once

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "behaviors/rig.h"

namespace limber::sim::test {

/// Means over the neighbors of a part, by a loop over all parts of all other bodies.
struct BruteForceMeans {
  int count = 0;
  Vec3 offset{0}, velocity{0}, spin{0};  ///< Of neighbors; velocities not relative to the own.
  Vec3 unit_sum{0};                      ///< Mean of r̂ (1 − d/max_distance).
};

struct FlockRig : Rig {
  std::vector<Part*> parts;

  /// Adds `bodies` bodies of 1 .. `max_parts` balls at random positions in a cube, each part with its own motion.
  void fill(int bodies, int max_parts, double side) {
    for (int i = 0; i < bodies; i++) {
      Body& b = body("body" + std::to_string(i));
      const int count = 1 + static_cast<int>(draw(0, max_parts - 1e-9));
      for (int k = 0; k < count; k++) {
        Part& part = ball(b, draw3(-side / 2, side / 2), draw(0.5, 2));
        part.set_velocity(draw3(-2, 2), draw3(-3, 3));
        parts.push_back(&part);
      }
    }
  }

  BruteForceMeans brute_force_means(const Part& of, double min_distance, double max_distance) const {
    BruteForceMeans m;
    if (max_distance <= min_distance) return m;
    for (const Part* other : parts) {
      if (&other->body() == &of.body() || !other->body().enabled()) continue;
      // compare with Bullet's positions, in single precision
      const auto single = [](const Vec3& v) {
        return Vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
      };
      const Vec3 r = single(other->center()) - single(of.center());
      const double d = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z);
      if (d < min_distance || d > max_distance) continue;
      m.count++;
      m.offset += r;
      m.velocity += other->linear_velocity();
      m.spin += other->angular_velocity();
      if (d > 0) m.unit_sum += r / d * (1 - d / max_distance);
    }
    if (m.count == 0) return m;
    for (Vec3* v : {&m.offset, &m.velocity, &m.spin, &m.unit_sum}) *v /= m.count;
    return m;
  }
};

inline double length_of(const Vec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
inline Vec3 unit(const Vec3& v) { return length_of(v) > 0 ? v / length_of(v) : Vec3(0); }
inline double clamped(double v, double low, double high) { return v < low ? low : v > high ? high : v; }

}  // namespace limber::sim::test
