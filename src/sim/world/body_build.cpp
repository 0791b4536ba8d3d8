// Body: construction from a model, and as a copy of another body.
#include <algorithm>
#include <utility>

#include "sim/behavior/behavior_list.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber {

void Body::build(const std::shared_ptr<const BodyModel>& model, const BuildOptions& options) {
  model_ = model;
  Pose root = model->links.front().start;
  if (options.position) root.position = *options.position;
  if (options.rotation) root.rotation = *options.rotation;
  const Pose displacement = root * model->links.front().start.inverse();
  const auto& geometries = world_.geometries_for(model);
  for (std::size_t i = 0; i < model->links.size(); i++) {
    const LinkModel& link = model->links[i];
    parts_.push_back(std::make_unique<Part>(*this, part_group_, link.name, geometries[i], link.inertial.mass,
                                            displacement * link.start));
    if (!link.self_collision) store().mutable_values(parts_.back()->id(), Part::table().at("self_collision"))[0] = 0;
    parts_.back()->flush();
  }
  for (const Overlap& overlap : model->overlaps) {
    (void)state_.pairs.set_overlaps(static_cast<std::size_t>(overlap.a), static_cast<std::size_t>(overlap.b));
  }
  state_.pairs.checked_count = parts_.size();
  apply_pairs();
  for (const JointModel& m : model->joints) {
    JointSpec spec{m.type, m.frame_in_parent, m.frame_in_child, m.limited, m.lower, m.upper, m.friction, {}};
    if (m.mimic >= 0)
      spec.mimic = Mimic{model->joints[static_cast<std::size_t>(m.mimic)].name, m.mimic_multiplier, m.mimic_offset};
    Part& parent = *parts_[static_cast<std::size_t>(m.parent)];
    Part& child = *parts_[static_cast<std::size_t>(m.child)];
    joints_.push_back(std::make_unique<Joint>(*this, joint_group_, m.name, parent, child, spec));
    Joint& joint = *joints_.back();
    joint.apply_limits();
    joint.constraint().reset(joint.own_axis() == 5 ? Vec3(0, 0, m.start) : Vec3(0));
    joint.publish();
    if (m.type != JointType::fixed) build_motor(joint, m, options.servo_motors);
  }
  couple_followers();
}

void Body::build_motor(Joint& joint, const JointModel& m, bool servo) {
  motors_.push_back(std::make_unique<Motor>(joint, motor_group_));
  Motor& motor = *motors_.back();
  const bool linear = joint.own_axis() == 2;
  store().mutable_values(motor.id(), Motor::table().at(linear ? "max_linear_force" : "max_angular_force"))[2] =
      m.effort;
  store().mutable_values(motor.id(), Motor::table().at(linear ? "linear_velocity" : "angular_velocity"))[2] =
      m.velocity;
  store().mutable_values(motor.id(), Motor::table().at("damping"))[0] = m.damping;
  // planar and floating joints have several axes, and mimic joints follow their leader: none gets a servo by default
  const bool use_servo = servo && m.type != JointType::floating && m.type != JointType::planar && !joint.spec().mimic;
  if (!use_servo) motor.set_mode(MotorMode::off);
}

void Body::build_copy(const Body& source) {
  const Store& source_store = source.store();
  model_ = source.model_;
  const auto copy_values = [&](NodeId from, NodeId to, const PropertyTable& table) {
    std::copy_n(source_store.persistent_block(from), table.persistent_width(), store().persistent_block(to));
    std::copy_n(source_store.transient_block(from), table.transient_width(), store().transient_block(to));
    store().mark_explicitly_set(to,
                                source_store.explicitly_set(from));  // copies the set of explicitly set properties too
  };
  for (const auto& from : source.parts_) {
    const double mass = source_store.values(from->id(), Part::table().at("mass"))[0];
    parts_.push_back(std::make_unique<Part>(*this, part_group_, from->name(), from->geometry(), mass, from->pose()));
    Part& part = *parts_.back();
    part.set_shape(world_.matching_shape(source.world_, from->shape()));
    part.set_start_pose(from->start_pose());
    copy_values(from->id(), part.id(), Part::table());
  }
  copy_values(source.id_, id_, table());
  state_.initial_pose = source.state_.initial_pose;
  state_.pairs = source.state_.pairs;
  apply_pairs();
  // copy Bullet's state bit for bit: poses in the store have been converted to quaternions and back
  for (std::size_t i = 0; i < parts_.size(); i++) {
    parts_[i]->flush();
    source.parts_[i]->flush();
    parts_[i]->set_motion(source.parts_[i]->capture_motion());
  }
  for (const auto& from : source.joints_) {
    Part& parent = *find_part(from->parent().name());
    Part& child = *find_part(from->child().name());
    joints_.push_back(std::make_unique<Joint>(*this, joint_group_, from->name(), parent, child, from->spec()));
    Joint& joint = *joints_.back();
    copy_values(from->id(), joint.id(), Joint::table());
    joint.apply_limits();
    joint.constraint().reset(from->constraint().pose().angles());
    if (from->motor() == nullptr) continue;
    motors_.push_back(std::make_unique<Motor>(joint, motor_group_));
    copy_values(from->motor()->id(), motors_.back()->id(), Motor::table());
  }
  couple_followers();
  world_.behaviors().copy(source, *this);
}

}  // namespace limber
