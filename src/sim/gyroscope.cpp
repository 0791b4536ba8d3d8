// Newton's method on three equations.
#include "sim/gyroscope.h"

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

constexpr int kNewtons = 4;      // quadratic: the first is as good as most solvers', the third at the last digits
constexpr double kMiss = 1e-10;  // of the momentum; Bullet's velocities know seven digits

double spin_energy(const Vec3& inertia, const Vec3& spin) { return glm::dot(inertia * spin, spin); }

}  // namespace

Vec3 gyroscopic_change(const Vec3& inertia, const Vec3& spin, double h) {
  const double least = std::min({inertia.x, inertia.y, inertia.z});
  const double most = std::max({inertia.x, inertia.y, inertia.z});
  if (!(most - least > 1e-6 * most)) return Vec3(0);  // a ball or a cube: every axis is as good
  Vec3 change(0);
  for (int round = 0; round < kNewtons; ++round) {
    const Vec3 middle = spin + change / 2.0;
    const Vec3 momentum = inertia * middle;
    const Vec3 miss = inertia * change + h * glm::cross(middle, momentum);
    if (glm::length(miss) <= kMiss * glm::length(momentum)) break;
    // the columns of I + h/2·([w]·I - [I·w]), with [v] the matrix of v×
    const auto column = [&](int k) {
      Vec3 axis(0);
      axis[k] = 1;
      return inertia * axis + h / 2 * (glm::cross(middle, inertia * axis) - glm::cross(momentum, axis));
    };
    const Vec3 more = glm::inverse(Mat3(column(0), column(1), column(2))) * miss;
    if (!is_finite(more)) break;
    change -= more;
  }
  // where steps are too long to tell, it at least gives no energy
  const double before = spin_energy(inertia, spin);
  const double after = spin_energy(inertia, spin + change);
  if (after > before) change = (spin + change) * std::sqrt(before / after) - spin;
  return change;
}

// across·(r2 - r1) = -h·along·spin·r×axis with r = (r1 + r2)/2 turns r about the axis.
Vec3 gyroscopic_change(double along, double across, const Vec3& axis, double spin, const Vec3& rest, double h) {
  const double angle = 2 * fixed::atan(h * along * spin / (2 * across));
  return rest * (fixed::cos(angle) - 1) + glm::cross(axis, rest) * fixed::sin(angle);
}

}  // namespace limber
