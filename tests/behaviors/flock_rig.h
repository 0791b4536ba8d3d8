// FlockRig: bodies of one or several balls, and their neighbours found and summed the slow way, in double precision.
#pragma once

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "behaviors/rig.h"

namespace limber::test {

/// Means over the neighbours of a part, by looking at every part of every other body.
struct SlowMeans {
  int count = 0;
  Vec3 offset{0}, velocity{0}, spin{0};  ///< Of neighbours; velocities not relative to the own.
  Vec3 unit_sum{0};                      ///< Mean of r̂ (1 − d/most).
};

struct FlockRig : Rig {
  std::vector<Part*> parts;

  /// `bodies` bodies of 1 .. `most_parts` balls, anywhere in a cube, each part with a motion of its own.
  void fill(int bodies, int most_parts, double side) {
    for (int i = 0; i < bodies; i++) {
      Body& b = body("body" + std::to_string(i));
      const int count = 1 + static_cast<int>(draw(0, most_parts - 1e-9));
      for (int k = 0; k < count; k++) {
        Part& part = ball(b, draw3(-side / 2, side / 2), draw(0.5, 2));
        part.set_velocity(draw3(-2, 2), draw3(-3, 3));
        parts.push_back(&part);
      }
    }
  }

  SlowMeans slow_means(const Part& of, double least, double most) const {
    SlowMeans m;
    if (most <= least) return m;
    for (const Part* other : parts) {
      if (&other->body() == &of.body() || !other->body().enabled()) continue;
      // what is compared is what Bullet knows: single precision
      const auto single = [](const Vec3& v) {
        return Vec3(static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
      };
      const Vec3 r = single(other->center()) - single(of.center());
      const double d = std::sqrt(r.x * r.x + r.y * r.y + r.z * r.z);
      if (d < least || d > most) continue;
      m.count++;
      m.offset += r;
      m.velocity += other->linear_velocity();
      m.spin += other->angular_velocity();
      if (d > 0) m.unit_sum += r / d * (1 - d / most);
    }
    if (m.count == 0) return m;
    for (Vec3* v : {&m.offset, &m.velocity, &m.spin, &m.unit_sum}) *v /= m.count;
    return m;
  }
};

inline double length_of(const Vec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
inline Vec3 unit(const Vec3& v) { return length_of(v) > 0 ? v / length_of(v) : Vec3(0); }
inline double clamped(double v, double low, double high) { return v < low ? low : v > high ? high : v; }

}  // namespace limber::test
