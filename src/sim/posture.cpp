// Taking a body's stance and handing it to the one that replaces it.
#include "sim/posture.h"

#include <algorithm>

#include "sim/world.h"

namespace limber {

namespace {

// velocity of a point that goes along with a part
Vec3 velocity_at(const Part& part, const Vec3& point) {
  return part.linear_velocity() + glm::cross(part.angular_velocity(), point - part.center());
}

}  // namespace

Posture::Posture(const Body& body) {
  for (const auto& part : body.parts()) parts_.push_back({part->name(), part->geometry()->frame, part->stance()});
  for (const auto& joint : body.joints()) {
    const Part& parent = joint->parent();
    const Part& child = joint->child();
    const Pose from = parent.pose() * joint->spec().frame_in_parent;
    const Pose to = child.pose() * joint->spec().frame_in_child;
    const Quat back = glm::conjugate(from.rotation);
    const double* const told = body.store().live_block(joint->id());
    joints_.push_back({joint->name(),
                       parent.name(),
                       child.name(),
                       joint->spec(),
                       from.inverse() * to,
                       back * (velocity_at(child, to.position) - velocity_at(parent, to.position)),
                       back * (child.angular_velocity() - parent.angular_velocity()),
                       {told, told + Joint::table().live_width()}});
  }
}

const Posture::PartStance* Posture::find(const std::vector<PartStance>& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const PartStance& p) { return p.name == name; });
  return found == list.end() ? nullptr : &*found;
}

const Posture::JointStance* Posture::joint_like(const Joint& joint) const {
  const auto found = std::find_if(joints_.begin(), joints_.end(), [&](const JointStance& j) {
    return j.name == joint.name() && j.spec.type == joint.type();
  });
  return found == joints_.end() ? nullptr : &*found;
}

// one body's parts, each placed once, after the part that it hangs on
class Posture::Giving {
 public:
  Giving(const Posture& posture, Body& body, const std::vector<bool>& start_anew)
      : posture_(posture), body_(body), start_anew_(start_anew), states_(body.parts().size()) {
    // where each joint's child would hang if nothing but the making counted
    for (const auto& joint : body.joints()) {
      const Pose from = joint->parent().pose() * joint->spec().frame_in_parent;
      made_.push_back(from.inverse() * (joint->child().pose() * joint->spec().frame_in_child));
    }
  }

  void place_all() {
    for (std::size_t i = 0; i < states_.size(); i++) place(i);
  }

 private:
  enum class State : std::uint8_t { waits, begun, placed, as_before };

  std::size_t index_of(const Part& part) const {
    const auto parts = body_.parts();
    return static_cast<std::size_t>(
        std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.get() == &part; }) - parts.begin());
  }

  void place(std::size_t i) {
    if (states_[i] != State::waits) return;
    states_[i] = State::begun;  // a loop of joints comes back here
    const Part& part = *body_.parts()[i];
    const auto joints = body_.joints();
    for (std::size_t j = 0; j < joints.size(); j++) {
      if (&joints[j]->child() != &part) continue;
      place(index_of(joints[j]->parent()));
      states_[i] = hang(i, j);
      return;
    }
    states_[i] = State::placed;
    const PartStance* before = posture_.find(posture_.parts_, part.name());
    if (before == nullptr && i == 0 && !posture_.parts_.empty()) before = &posture_.parts_.front();
    if (before != nullptr) states_[i] = stand(i, *before);
  }

  // where the part of before stood; as_before when that is so to the bit
  State stand(std::size_t i, const PartStance& before) {
    Part& part = *body_.parts()[i];
    if (nearly_same(part.geometry()->frame, before.frame)) {
      part.stand(before.stance);
      return part.name() == before.name ? State::as_before : State::placed;
    }
    part.set_pose(before.stance.pose);
    part.set_velocity(before.stance.linear_velocity, before.stance.angular_velocity);
    return State::placed;
  }

  State hang(std::size_t i, std::size_t j) {
    Part& part = *body_.parts()[i];
    const Joint& joint = *body_.joints()[j];
    const Part& parent = joint.parent();
    const bool anew = j < start_anew_.size() && start_anew_[j];
    const JointStance* const before = anew ? nullptr : posture_.joint_like(joint);
    const PartStance* const stood = posture_.find(posture_.parts_, part.name());
    const bool same = before != nullptr && stood != nullptr && before->parent == parent.name() &&
                      before->child == part.name() && states_[index_of(parent)] == State::as_before &&
                      nearly_same(before->spec.frame_in_parent, joint.spec().frame_in_parent) &&
                      nearly_same(before->spec.frame_in_child, joint.spec().frame_in_child);
    if (same) return stand(i, *stood);
    const Pose from = parent.pose() * joint.spec().frame_in_parent;
    const Pose at = from * (before != nullptr ? before->motion : made_[j]);
    part.set_pose(at * joint.spec().frame_in_child.inverse());
    const Vec3 spin = parent.angular_velocity() + (before != nullptr ? from.rotation * before->angular : Vec3(0));
    const Vec3 speed =
        velocity_at(parent, at.position) + (before != nullptr ? from.rotation * before->linear : Vec3(0));
    part.set_velocity(speed + glm::cross(spin, part.center() - at.position), spin);
    return State::placed;
  }

  const Posture& posture_;
  Body& body_;
  const std::vector<bool>& start_anew_;
  std::vector<State> states_;
  std::vector<Pose> made_;
};

void Posture::give_to(Body& body, const std::vector<bool>& start_anew) const {
  Giving(*this, body, start_anew).place_all();
  // full turns are counted on
  for (std::size_t j = 0; j < body.joints().size(); j++) {
    const Joint& joint = *body.joints()[j];
    const JointStance* const before = joint_like(joint);
    if (before == nullptr || (j < start_anew.size() && start_anew[j])) continue;
    std::copy(before->told.begin(), before->told.end(), body.store().live_block(joint.id()));
  }
  body.note_moved();
}

}  // namespace limber
