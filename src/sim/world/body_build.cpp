// Body: construction from a model, and as a copy of another body.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/log/log.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/gears/gear.h"
#include "sim/sensors/sensor_list.h"
#include "sim/shapes/shape_list.h"
#include "sim/tendons/tendon_list.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

// Gives the motor of a model's joint its limits, and its mode.
void set_up_motor(Motor& motor, const model::JointModel& m, std::optional<bool> servo) {
  const Joint& joint = motor.joint();
  Store& store = joint.body().store();
  const bool linear = joint.own_axis() == 2;
  store.mutable_values(motor.id(), Motor::table().at(linear ? "max_linear_force" : "max_angular_force"))[2] = m.effort;
  store.mutable_values(motor.id(), Motor::table().at(linear ? "linear_velocity" : "angular_velocity"))[2] = m.velocity;
  store.mutable_values(motor.id(), Motor::table().at("damping"))[0] = m.damping;
  if (!m.takes_servo() || !servo.value_or(m.driven)) motor.set_mode(MotorMode::off);
  if (m.spring.stiffness <= 0 || (servo && !m.driven)) return;
  const std::string side = linear ? "linear" : "angular";
  store.mutable_values(motor.id(), Motor::table().at(side + "_spring_stiffness"))[2] = m.spring.stiffness;
  store.mutable_values(motor.id(), Motor::table().at(side + "_spring_rest_length"))[2] = m.spring.rest;
  if (m.driven) {
    store.mutable_values(motor.id(), Motor::table().at(side + "_spring_damping"))[2] = m.spring.damping;
  } else {
    motor.set_mode(MotorMode::spring);
  }
}

void add_tendon(Body& body, const model::TendonModel& from) {
  std::vector<Tendon::Point> points;
  for (const model::TendonModel::Point& point : from.points)
    points.push_back({body.parts()[static_cast<std::size_t>(point.link)].get(), point.position});
  const Result<Tendon*> added = body.world().tendons().add(body, from.name, std::move(points));
  if (!added) return log_warning("{}", added.error());
  const auto set = [&](const char* property, double value) {
    const Property& p = Tendon::table().at(property);
    body.store().mutable_values((*added)->id(), p)[0] = std::clamp(value, p.min, p.max);
  };
  set("stiffness", from.stiffness);
  set("damping", from.damping);
  if (from.rest) set("rest_length", *from.rest);
  set("pushes", from.pushes ? 1 : 0);
  if (from.radius) set("radius", *from.radius);
  (*added)->apply_settings();
}

// Sets the limits of a model's ball joint; apply_limits() applies them.
void set_ball_limits(const Joint& joint, const model::BallLimitsModel& limits) {
  Store& store = joint.body().store();
  const auto set = [&](const char* property, double value) {
    store.mutable_values(joint.id(), Joint::table().at(property))[0] = value;
  };
  set("cone_limit", limits.cone);
  set("twist_lower", limits.twist_lower);
  set("twist_upper", limits.twist_upper);
  set("rotation_limit", limits.angle);
}

SensorKind sensor_kind(model::SensorModel::Kind kind) {
  switch (kind) {
    case model::SensorModel::Kind::imu:
      return SensorKind::imu;
    case model::SensorModel::Kind::range_finder:
      return SensorKind::range_finder;
    case model::SensorModel::Kind::touch:
      break;
  }
  return SensorKind::touch;
}

// Adds a model's sensor to its part.
void add_sensor(SensorList& sensors, Part& part, const model::SensorModel& m) {
  const SensorKind kind = sensor_kind(m.kind);
  const Result<Sensor*> sensor = sensors.add(m.name, kind, part);
  LIMBER_CHECK(sensor.ok());
  if (!sensor) return;
  Store& store = part.body().store();
  const auto values = [&](const char* property) {
    return store.mutable_values((*sensor)->id(), Sensor::table(kind).at(property));
  };
  put(values("position"), m.pose.position);
  if (kind == SensorKind::imu) put(values("rotation"), m.pose.rotation);
  if (kind == SensorKind::touch) values("radius")[0] = m.radius;
  if (kind != SensorKind::range_finder) return;
  put(values("direction"), m.pose.rotation * Vec3(0, 0, 1));
  if (m.range > 0) values("range")[0] = m.range;
}

}  // namespace

void Body::build(const std::shared_ptr<const model::BodyModel>& model, const BuildOptions& options) {
  model_ = model;
  Pose root = model->links.front().start;
  if (options.position) root.position = *options.position;
  if (options.rotation) root.rotation = *options.rotation;
  const Pose displacement = root * model->links.front().start.inverse();
  const auto& geometries = world_.shapes().geometries_of(model);
  for (std::size_t i = 0; i < model->links.size(); i++) {
    const model::LinkModel& link = model->links[i];
    Part& part = parts_.add(std::make_unique<Part>(*this, parts_.group(), link.name, geometries[i], link.inertial.mass,
                                                   displacement * link.start));
    if (!link.self_collision) store().mutable_values(part.id(), Part::table().at("self_collision"))[0] = 0;
    part.flush();
  }
  pairs_.build(*model);
  for (const model::JointModel& m : model->joints) {
    JointSpec spec{m.type, m.frame_in_parent, m.frame_in_child, m.limited, m.lower, m.upper, m.friction, {}};
    if (m.mimic >= 0)
      spec.mimic = Mimic{model->joints[static_cast<std::size_t>(m.mimic)].name, m.mimic_multiplier, m.mimic_offset};
    Part& parent = *parts()[static_cast<std::size_t>(m.parent)];
    Part& child = *parts()[static_cast<std::size_t>(m.child)];
    Joint& joint = joints_.add(std::make_unique<Joint>(*this, joints_.group(), m.name, parent, child, spec));
    store().mutable_values(joint.id(), Joint::table().at("armature"))[0] = m.armature;
    set_ball_limits(joint, m.ball);
    joint.apply_limits();
    joint.constraint().reset(joint.own_axis() == 5 ? Vec3(0, 0, m.start) : Vec3(0));
    joint.publish();
    if (m.type == model::JointType::fixed) continue;
    set_up_motor(motors_.add(std::make_unique<Motor>(joint, motors_.group())), m, options.servo_motors);
  }
  for (const model::JointModel& m : model->loops) {
    const JointSpec spec{m.type, m.frame_in_parent, m.frame_in_child, m.limited, m.lower, m.upper, m.friction, {}};
    Joint& joint = joints_.add(std::make_unique<Joint>(*this, joints_.group(), m.name,
                                                       *parts()[static_cast<std::size_t>(m.parent)],
                                                       *parts()[static_cast<std::size_t>(m.child)], spec));
    joint.apply_limits();
    joint.update_from_parts();
  }
  for (const model::SensorModel& m : model->sensors)
    add_sensor(*sensors_, *parts()[static_cast<std::size_t>(m.link)], m);
  followers_ = couple_mimic_joints(*this);
  for (const model::TendonModel& tendon : model->tendons) add_tendon(*this, tendon);
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
  for (const auto& from : source.parts()) {
    const double mass = source_store.values(from->id(), Part::table().at("mass"))[0];
    Part& part =
        parts_.add(std::make_unique<Part>(*this, parts_.group(), from->name(), from->geometry(), mass, from->pose()));
    part.set_shape(world_.shapes().matching(source_store, from->shape()));
    part.set_start_pose(from->start_pose());
    copy_values(from->id(), part.id(), Part::table());
  }
  copy_values(source.id_, id_, table());
  state_.initial_pose = source.state_.initial_pose;
  pairs_.build_copy(source.pairs_);
  // copy Bullet's state bit for bit: poses in the store have been converted to quaternions and back
  for (std::size_t i = 0; i < parts().size(); i++) {
    parts()[i]->flush();
    source.parts()[i]->flush();
    parts()[i]->set_motion(source.parts()[i]->capture_motion());
  }
  for (const auto& from : source.joints()) {
    Part& parent = *find_part(from->parent().name());
    Part& child = *find_part(from->child().name());
    Joint& joint =
        joints_.add(std::make_unique<Joint>(*this, joints_.group(), from->name(), parent, child, from->spec()));
    copy_values(from->id(), joint.id(), Joint::table());
    joint.apply_limits();
    joint.constraint().reset(from->constraint().pose().angles());
    if (from->motor() == nullptr) continue;
    const Motor& motor = motors_.add(std::make_unique<Motor>(joint, motors_.group()));
    copy_values(from->motor()->id(), motor.id(), Motor::table());
  }
  for (const auto& from : source.sensors().list()) {
    const Sensor& sensor = sensors_->add_copy(*from, *find_part(from->part().name()));
    copy_values(from->id(), sensor.id(), Sensor::table(from->kind()));
  }
  followers_ = couple_mimic_joints(*this);
  world_.tendons().copy(source, *this);
  world_.behaviors().copy(source, *this);
}

}  // namespace limber::sim
