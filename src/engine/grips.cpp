// Springs of hands.
#include "engine/grips.h"

#include <algorithm>

namespace limber {

bool Grips::hold(World& world, NodeId part, const Vec3& point, const Vec3& target) {
  const auto same = std::find_if(grips_.begin(), grips_.end(), [&](const Grip& g) { return g.part == part; });
  if (same == grips_.end() && grips_.size() >= kMost) return false;
  Grip& grip = same == grips_.end() ? grips_.emplace_back() : *same;
  grip = {part, point, target, world.time() + kLasts};
  return true;
}

void Grips::let_go(NodeId part) {
  std::erase_if(grips_, [&](const Grip& g) { return g.part == part; });
}

void Grips::pull(World& world) {
  if (grips_.empty()) return;
  const Store& store = world.store();
  std::erase_if(grips_, [&](const Grip& g) { return !store.alive(g.part) || world.time() > g.until; });
  for (const Grip& grip : grips_) {
    Part& part = *static_cast<Part*>(store.thing(grip.part));
    double mass = 0;
    for (const auto& other : part.body().parts()) mass += other->is_static() ? 0 : other->mass();
    const Pose pose = part.pose();
    const Vec3 at = pose.position + pose.rotation * grip.point;
    const Vec3 velocity = part.linear_velocity() + glm::cross(part.angular_velocity(), at - part.center());
    // as strong as the whole body needs, but no more than the part alone takes in a tick without beginning to shake
    const double dt = world.timestep();
    const double stiffness = std::min(mass * kOmega * kOmega, 0.3 * part.mass() / (dt * dt));
    const double damping = std::min(2 * mass * kOmega, 0.4 * part.mass() / dt);
    part.apply_force_at(stiffness * (grip.target - at) - damping * velocity, at);
  }
}

}  // namespace limber
