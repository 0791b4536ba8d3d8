// Implicit midpoint rule by Newton's method.
#include "sim/solver/gyroscope.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

constexpr int kMaxNewtonSteps = 4;            // converges quadratically: the third iteration reaches the last digits
constexpr double kRelativeTolerance = 1e-10;  // relative to the momentum; Bullet's velocities have seven digits

double spin_energy(const Vec3& inertia, const Vec3& spin) { return glm::dot(inertia * spin, spin); }

}  // namespace

Vec3 gyroscopic_change(const Vec3& inertia, const Vec3& spin, double h) {
  const double min_moment = std::min({inertia.x, inertia.y, inertia.z});
  const double max_moment = std::max({inertia.x, inertia.y, inertia.z});
  if (!(max_moment - min_moment > 1e-6 * max_moment)) return Vec3(0);  // a ball or a cube: no gyroscopic effect
  Vec3 change(0);
  for (int iteration = 0; iteration < kMaxNewtonSteps; ++iteration) {
    const Vec3 middle = spin + change / 2.0;
    const Vec3 momentum = inertia * middle;
    const Vec3 residual = inertia * change + h * glm::cross(middle, momentum);
    if (glm::length(residual) <= kRelativeTolerance * glm::length(momentum)) break;
    // the columns of I + h/2·([w]·I - [I·w]), with [v] the matrix of v×
    const auto column = [&](int k) {
      Vec3 axis(0);
      axis[k] = 1;
      return inertia * axis + h / 2 * (glm::cross(middle, inertia * axis) - glm::cross(momentum, axis));
    };
    const Vec3 correction = glm::inverse(Mat3(column(0), column(1), column(2))) * residual;
    if (!is_finite(correction)) break;
    change -= correction;
  }
  // if the step is too long to converge, at least don't add energy
  const double before = spin_energy(inertia, spin);
  const double after = spin_energy(inertia, spin + change);
  if (after > before) change = (spin + change) * std::sqrt(before / after) - spin;
  return change;
}

// The midpoint rule across·(r2 - r1) = -h·along·spin·r×axis, with r = (r1 + r2)/2, is a rotation of r about the axis.
Vec3 gyroscopic_change(double along, double across, const Vec3& axis, double spin, const Vec3& rest, double h) {
  const double angle = 2 * fixed::atan(h * along * spin / (2 * across));
  return rest * (fixed::cos(angle) - 1) + glm::cross(axis, rest) * fixed::sin(angle);
}

}  // namespace limber::sim::solver
