// Mouse springs.
#include "engine/commands/mouse_springs.h"

#include <algorithm>

#include "sim/world/body.h"
#include "sim/world/part.h"

namespace limber::engine {

bool MouseSprings::attach(sim::World& world, NodeId part, const Vec3& point, const Vec3& target) {
  const auto same =
      std::find_if(springs_.begin(), springs_.end(), [&](const Spring& spring) { return spring.part == part; });
  if (same == springs_.end() && springs_.size() >= kMaxSprings) return false;
  Spring& spring = same == springs_.end() ? springs_.emplace_back() : *same;
  spring = {part, point, target, world.time() + kTimeout};
  return true;
}

void MouseSprings::release(NodeId part) {
  std::erase_if(springs_, [&](const Spring& spring) { return spring.part == part; });
}

void MouseSprings::apply_forces(sim::World& world) {
  if (springs_.empty()) return;
  const Store& store = world.store();
  std::erase_if(springs_,
                [&](const Spring& spring) { return !store.alive(spring.part) || world.time() > spring.until; });
  for (const Spring& spring : springs_) {
    sim::Part& part = *static_cast<sim::Part*>(store.object(spring.part));
    double mass = 0;
    for (const auto& other : part.body().parts()) mass += other->is_static() ? 0 : other->mass();
    const Pose pose = part.pose();
    const Vec3 at = pose.position + pose.rotation * spring.point;
    if (part.is_static()) {
      // a kinematic part follows the mouse
      if (part.motion() == sim::PartMotion::kinematic)
        part.set_pose({pose.position + (spring.target - at), pose.rotation});
      continue;
    }
    const Vec3 velocity = part.linear_velocity() + glm::cross(part.angular_velocity(), at - part.center());
    // sized for the mass of the whole body, but limited for the part, so that explicit integration stays stable
    const double dt = world.timestep();
    const double stiffness = std::min(mass * kOmega * kOmega, 0.3 * part.mass() / (dt * dt));
    const double damping = std::min(2 * mass * kOmega, 0.4 * part.mass() / dt);
    part.apply_force_at(stiffness * (spring.target - at) - damping * velocity, at);
  }
}

}  // namespace limber::engine
