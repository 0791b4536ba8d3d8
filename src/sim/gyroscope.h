// What a body's own turning does to its spin. [any]
#pragma once

#include "base/vec.h"

namespace limber {

/// Change of the angular velocity of a body that no torque acts on, in `h` s; `inertia` are its moments about its
/// principal axes, kg·m², `spin` its angular velocity along them, rad/s. Euler's equations by the implicit midpoint:
/// I·(w2 - w1) + h·w×I·w = 0 with w = (w1 + w2)/2, which keeps energy and the momentum's length, whatever the step.
Vec3 gyroscopic_change(const Vec3& inertia, const Vec3& spin, double h);

/// The same for a spin about an axis of symmetry that is integrated apart (spin.h): the change of `rest`, the angular
/// velocity perpendicular to the unit vector `axis`, with moments `along` the axis and `across` it.
Vec3 gyroscopic_change(double along, double across, const Vec3& axis, double spin, const Vec3& rest, double h);

}  // namespace limber
