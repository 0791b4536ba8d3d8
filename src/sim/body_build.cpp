// Body: built from a model, or as a copy of another body.
#include <algorithm>
#include <utility>

#include "sim/behavior_list.h"
#include "sim/body.h"
#include "sim/world.h"

namespace limber {

void Body::build(const std::shared_ptr<const BodyModel>& model, const BuildOptions& options) {
  model_ = model;
  Pose root = model->links.front().start;
  if (options.position) root.position = *options.position;
  if (options.rotation) root.rotation = *options.rotation;
  const Pose moved = root * model->links.front().start.inverse();
  const auto& geometries = world_.geometries_of(model);
  for (std::size_t i = 0; i < model->links.size(); i++) {
    const LinkModel& link = model->links[i];
    parts_.push_back(
        std::make_unique<Part>(*this, part_group_, link.name, geometries[i], link.inertial.mass, moved * link.start));
    if (!link.self_collision) store().tell(parts_.back()->id(), Part::table().at("self_collision"))[0] = 0;
    parts_.back()->settle();
  }
  for (const Overlap& overlap : model->overlaps) {
    (void)pairs_.set_overlaps(static_cast<std::size_t>(overlap.a), static_cast<std::size_t>(overlap.b));
  }
  pairs_.checked = parts_.size();
  apply_pairs();
  for (const JointModel& m : model->joints) {
    JointSpec spec{m.type, m.frame_in_parent, m.frame_in_child, m.limited, m.lower, m.upper, m.friction, {}};
    if (m.mimic >= 0)
      spec.mimic = Mimic{model->joints[static_cast<std::size_t>(m.mimic)].name, m.mimic_multiplier, m.mimic_offset};
    Part& parent = *parts_[static_cast<std::size_t>(m.parent)];
    Part& child = *parts_[static_cast<std::size_t>(m.child)];
    joints_.push_back(std::make_unique<Joint>(*this, joint_group_, m.name, parent, child, spec));
    Joint& joint = *joints_.back();
    joint.effect_limits();
    joint.constraint().reset(joint.own_axis() == 5 ? Vec3(0, 0, m.start) : Vec3(0));
    joint.tell();
    if (m.type != JointType::fixed) build_motor(joint, m, options.servo_motors);
  }
  couple_followers();
}

void Body::build_motor(Joint& joint, const JointModel& m, bool servo) {
  motors_.push_back(std::make_unique<Motor>(joint, motor_group_));
  Motor& motor = *motors_.back();
  const bool linear = joint.own_axis() == 2;
  store().tell(motor.id(), Motor::table().at(linear ? "max_linear_force" : "max_angular_force"))[2] = m.effort;
  store().tell(motor.id(), Motor::table().at(linear ? "linear_velocity" : "angular_velocity"))[2] = m.velocity;
  store().tell(motor.id(), Motor::table().at("damping"))[0] = m.damping;
  // planar and floating joints move in several axes, followers with their leader: no servo holds these by default
  const bool holds = servo && m.type != JointType::floating && m.type != JointType::planar && !joint.spec().mimic;
  if (!holds) motor.set_mode(MotorMode::off);
}

void Body::build_copy(const Body& source) {
  const Store& theirs = source.store();
  model_ = source.model_;
  const auto copy_values = [&](NodeId from, NodeId to, const Table& table) {
    std::copy_n(theirs.kept_block(from), table.kept_width(), store().kept_block(to));
    std::copy_n(theirs.live_block(from), table.live_width(), store().live_block(to));
    store().say(to, theirs.said(from));  // a copy of what was said
  };
  for (const auto& from : source.parts_) {
    const double mass = theirs.values(from->id(), Part::table().at("mass"))[0];
    parts_.push_back(std::make_unique<Part>(*this, part_group_, from->name(), from->geometry(), mass, from->pose()));
    Part& part = *parts_.back();
    part.set_shape(world_.same_shape(source.world_, from->shape()));
    part.set_start_pose(from->start_pose());
    copy_values(from->id(), part.id(), Part::table());
  }
  copy_values(source.id_, id_, table());
  planned_ = source.planned_;
  pairs_ = source.pairs_;
  apply_pairs();
  // to the bit: what the store tells of a pose has gone through a quaternion
  for (std::size_t i = 0; i < parts_.size(); i++) {
    parts_[i]->settle();
    source.parts_[i]->settle();
    parts_[i]->stand(source.parts_[i]->stance());
  }
  for (const auto& from : source.joints_) {
    Part& parent = *find_part(from->parent().name());
    Part& child = *find_part(from->child().name());
    joints_.push_back(std::make_unique<Joint>(*this, joint_group_, from->name(), parent, child, from->spec()));
    Joint& joint = *joints_.back();
    copy_values(from->id(), joint.id(), Joint::table());
    joint.effect_limits();
    joint.constraint().reset(from->constraint().angles());
    if (from->motor() == nullptr) continue;
    motors_.push_back(std::make_unique<Motor>(joint, motor_group_));
    copy_values(from->motor()->id(), motors_.back()->id(), Motor::table());
  }
  couple_followers();
  world_.behaviors().copy(source, *this);
}

}  // namespace limber
