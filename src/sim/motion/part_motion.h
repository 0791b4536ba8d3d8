// The motion of a part: switching between dynamic, kinematic and static, and applying pose, velocity, mass, gravity and
// surface velocity to Bullet. [sim]
#pragma once

#include "base/result.h"
#include "base/vec.h"

namespace limber::sim {

class Body;
class Part;

bool is_plane(const Part& part);
/// Checks a value of `motion`: a plane is static, and a part without mass can't be dynamic.
Result<void> validate_motion(const Part& part, const double* in);

// On-change callbacks of properties of parts. Those of pose and velocity are also used by the stability check.
void apply_part_motion(Part& part);
void apply_part_mass(Part& part);
void apply_part_pose(Part& part);
void apply_part_velocity(Part& part);
void apply_surface_velocity(Part& part);

/// Sets Bullet's gravity of the part: the world's times the body's factor.
void apply_part_gravity(Part& part);
double gravity_factor(const Body& body);
/// On-change callback of the body's gravity_factor.
void apply_gravity_factor(Body& body);

/// Sets the pose of a part; a kinematic part doesn't move there within the next tick, but is there at once.
void teleport_part(Part& part, const Pose& pose);
/// Applies the pose in the store to Bullet.
void place_part(Part& part);
/// Saves the part's KinematicState for the rollback of a guarded call.
void save_kinematic_state(Part& part);

}  // namespace limber::sim
