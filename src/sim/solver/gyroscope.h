// Gyroscopic effect of a body's rotation on its angular velocity. [any]
#pragma once

#include "base/vec.h"

namespace limber::sim::solver {

/// Returns the change of the angular velocity of a torque-free body in `h` s. `inertia`: principal moments, kg·m²;
/// `spin`: angular velocity along the principal axes, rad/s. Integrates Euler's equations by the implicit midpoint
/// rule, I·(w2 - w1) + h·w×I·w = 0 with w = (w1 + w2)/2, which conserves energy and the length of the momentum for any
/// step.
Vec3 gyroscopic_change(const Vec3& inertia, const Vec3& spin, double h);

/// The same for a spin about an axis of symmetry that is integrated separately (rotation_step.h): the change of `rest`,
/// the angular velocity perpendicular to the unit vector `axis`, with moments `along` the axis and `across` it.
Vec3 gyroscopic_change(double along, double across, const Vec3& axis, double spin, const Vec3& rest, double h);

}  // namespace limber::sim::solver
