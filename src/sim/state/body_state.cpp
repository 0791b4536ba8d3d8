// BodyState: saves a body's state and transfers it to its replacement.
#include "sim/state/body_state.h"

#include <algorithm>

#include "sim/world/joint.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

// Velocity of a point that moves with a part.
Vec3 velocity_at(const Part& part, const Vec3& point) {
  return part.linear_velocity() + glm::cross(part.angular_velocity(), point - part.center());
}

}  // namespace

BodyState::BodyState(const Body& body) {
  for (const auto& part : body.parts())
    parts_.push_back({part->name(), part->geometry()->frame, part->capture_motion()});
  for (const auto& joint : body.joints()) {
    const Part& parent = joint->parent();
    const Part& child = joint->child();
    const Pose from = parent.pose() * joint->spec().frame_in_parent;
    const Pose to = child.pose() * joint->spec().frame_in_child;
    const Quat to_parent = glm::conjugate(from.rotation);
    const double* const readouts = body.store().transient_block(joint->id());
    joints_.push_back({joint->name(),
                       parent.name(),
                       child.name(),
                       joint->spec(),
                       from.inverse() * to,
                       to_parent * (velocity_at(child, to.position) - velocity_at(parent, to.position)),
                       to_parent * (child.angular_velocity() - parent.angular_velocity()),
                       {readouts, readouts + Joint::table().transient_width()}});
  }
}

const BodyState::PartState* BodyState::find(const std::vector<PartState>& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const PartState& p) { return p.name == name; });
  return found == list.end() ? nullptr : &*found;
}

const BodyState::JointState* BodyState::find_joint(const Joint& joint) const {
  const auto found = std::find_if(joints_.begin(), joints_.end(), [&](const JointState& j) {
    return j.name == joint.name() && j.spec.type == joint.type();
  });
  return found == joints_.end() ? nullptr : &*found;
}

// Places each part of a body once, after its parent.
class BodyState::StateTransfer {
 public:
  StateTransfer(const BodyState& state, Body& body, const std::vector<bool>& joints_to_reset)
      : state_(state), body_(body), joints_to_reset_(joints_to_reset), outcomes_(body.parts().size()) {
    // relative poses of the joints as built
    for (const auto& joint : body.joints()) {
      const Pose from = joint->parent().pose() * joint->spec().frame_in_parent;
      built_poses_.push_back(from.inverse() * (joint->child().pose() * joint->spec().frame_in_child));
    }
  }

  void place_all() {
    for (std::size_t i = 0; i < outcomes_.size(); i++) place(i);
  }

 private:
  enum class Outcome : std::uint8_t { pending, in_progress, placed, unchanged };

  std::size_t index_of(const Part& part) const {
    const auto parts = body_.parts();
    return static_cast<std::size_t>(
        std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.get() == &part; }) - parts.begin());
  }

  void place(std::size_t i) {
    if (outcomes_[i] != Outcome::pending) return;
    outcomes_[i] = Outcome::in_progress;  // ends the recursion in a loop of joints
    const Part& part = *body_.parts()[i];
    const auto joints = body_.joints();
    for (std::size_t j = 0; j < joints.size(); j++) {
      if (&joints[j]->child() != &part) continue;
      place(index_of(joints[j]->parent()));
      outcomes_[i] = place_by_joint(i, j);
      return;
    }
    outcomes_[i] = Outcome::placed;
    const PartState* saved = state_.find(state_.parts_, part.name());
    if (saved == nullptr && i == 0 && !state_.parts_.empty()) saved = &state_.parts_.front();
    if (saved != nullptr) outcomes_[i] = restore_part(i, *saved);
  }

  // Moves a part to its saved pose; returns unchanged if this reproduces it exactly.
  Outcome restore_part(std::size_t i, const PartState& saved) {
    Part& part = *body_.parts()[i];
    if (nearly_same(part.geometry()->frame, saved.frame)) {
      part.set_motion(saved.motion);
      return part.name() == saved.name ? Outcome::unchanged : Outcome::placed;
    }
    part.set_pose(saved.motion.pose);
    part.set_velocity(saved.motion.linear_velocity, saved.motion.angular_velocity);
    return Outcome::placed;
  }

  Outcome place_by_joint(std::size_t i, std::size_t j) {
    Part& part = *body_.parts()[i];
    const Joint& joint = *body_.joints()[j];
    const Part& parent = joint.parent();
    const bool reset = j < joints_to_reset_.size() && joints_to_reset_[j];
    const JointState* const saved = reset ? nullptr : state_.find_joint(joint);
    const PartState* const saved_part = state_.find(state_.parts_, part.name());
    const bool same = saved != nullptr && saved_part != nullptr && saved->parent == parent.name() &&
                      saved->child == part.name() && outcomes_[index_of(parent)] == Outcome::unchanged &&
                      nearly_same(saved->spec.frame_in_parent, joint.spec().frame_in_parent) &&
                      nearly_same(saved->spec.frame_in_child, joint.spec().frame_in_child);
    if (same) return restore_part(i, *saved_part);
    const Pose from = parent.pose() * joint.spec().frame_in_parent;
    const Pose joint_pose = from * (saved != nullptr ? saved->motion : built_poses_[j]);
    part.set_pose(joint_pose * joint.spec().frame_in_child.inverse());
    const Vec3 angular_velocity =
        parent.angular_velocity() + (saved != nullptr ? from.rotation * saved->angular : Vec3(0));
    const Vec3 linear_velocity =
        velocity_at(parent, joint_pose.position) + (saved != nullptr ? from.rotation * saved->linear : Vec3(0));
    part.set_velocity(linear_velocity + glm::cross(angular_velocity, part.center() - joint_pose.position),
                      angular_velocity);
    return Outcome::placed;
  }

  const BodyState& state_;
  Body& body_;
  const std::vector<bool>& joints_to_reset_;
  std::vector<Outcome> outcomes_;
  std::vector<Pose> built_poses_;
};

void BodyState::apply_to(Body& body, const std::vector<bool>& joints_to_reset) const {
  StateTransfer(*this, body, joints_to_reset).place_all();
  // restores the counts of full turns
  for (std::size_t j = 0; j < body.joints().size(); j++) {
    const Joint& joint = *body.joints()[j];
    const JointState* const saved = find_joint(joint);
    if (saved == nullptr || (j < joints_to_reset.size() && joints_to_reset[j])) continue;
    std::copy(saved->readouts.begin(), saved->readouts.end(), body.store().transient_block(joint.id()));
  }
  body.mark_joints_dirty();
}

}  // namespace limber::sim
