// Body: its properties; adding, finding and moving its parts, joints and motors.
#include "sim/world/body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/memory/archive.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/island_world.h"
#include "sim/motion/part_motion.h"
#include "sim/sensors/readouts.h"
#include "sim/sensors/sensor_list.h"
#include "sim/shapes/shape.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

// Adds an object to the end of a list of a body, so that a guarded call that fails removes it.
template <class T>
T& add_recorded(WorldTransaction& transaction, ObjectList<T>& list, std::uint32_t& structure_version,
                std::unique_ptr<T> object) {
  structure_version++;
  // an undone addition is another change of the structure
  transaction.record([](void* version, std::size_t) { ++*static_cast<std::uint32_t*>(version); }, &structure_version);
  T& added = list.add(std::move(object));
  transaction.record_added(list.objects());
  return added;
}

// Callbacks of the properties.

void apply_self_collision(Body& body) {
  for (const auto& part : body.parts()) part->apply_collision();
}

void apply_can_sleep(Body& body) {
  for (const auto& part : body.parts()) body.world().bullet().sleep().allow(part->rigid(), body.can_sleep());
}

void read_asleep(const Body& body, double* out) { out[0] = body.asleep() ? 1 : 0; }

void read_position(const Body& body, double* out) { put(out, body.pose().position); }
void write_position(Body& body, const double* in) { body.set_pose({vec3_at(in), body.pose().rotation}); }

void read_rotation(const Body& body, double* out) {
  const Quat q = body.pose().rotation;
  out[0] = q.x;
  out[1] = q.y;
  out[2] = q.z;
  out[3] = q.w;
}

void write_rotation(Body& body, const double* in) {
  body.set_pose({body.pose().position, quat_xyzw(in[0], in[1], in[2], in[3])});
}

void read_linear_velocity(const Body& body, double* out) {
  put(out, body.parts().empty() ? Vec3(0) : body.root()->linear_velocity());
}

// A velocity of the body moves the static parts only if all are static: it doesn't move the base of an arm.
bool gets_body_velocity(const Part& part) { return part.motion() != PartMotion::fixed || part.body().is_static(); }

void write_linear_velocity(Body& body, const double* in) {
  for (const auto& part : body.parts()) {
    if (gets_body_velocity(*part)) part->set_velocity(vec3_at(in), part->angular_velocity());
  }
}

void read_angular_velocity(const Body& body, double* out) {
  put(out, body.parts().empty() ? Vec3(0) : body.root()->angular_velocity());
}

void write_angular_velocity(Body& body, const double* in) {
  if (body.parts().empty()) return;
  const Vec3 omega = vec3_at(in);
  const Vec3 pivot = body.root()->center();
  const Vec3 velocity = body.root()->linear_velocity();
  for (const auto& part : body.parts()) {
    if (!gets_body_velocity(*part)) continue;
    part->set_velocity(velocity + glm::cross(omega, part->center() - pivot), omega);
  }
}

void read_motion(const Body& body, double* out) {
  static const Property& property = Part::table().at("motion");
  out[0] = body.parts().empty() ? 0 : body.store().values(body.root()->id(), property)[0];
}

// Parts that reject it (planes, and parts without mass to be dynamic) stay as they are.
void write_motion(Body& body, const double* in) {
  static const Property& property = Part::table().at("motion");
  for (const auto& part : body.parts()) (void)body.store().set(part->id(), property, {in, 1});
}

Result<void> reset_body(Body& body, std::span<const double>) {
  body.recovery().reset();
  return {};
}

Result<void> act_remove(Body& body, std::span<const double>) {
  body.world().remove_body(body);
  return {};
}

}  // namespace

const PropertyTable& Body::table() {
  static const PropertyTable table(
      "body", "/physics/body/<body>", "",
      {
          state(computed<&read_position, &write_position>(
              vec3("position", "m", {0, 0, 0}, -1e4, 1e4,
                   "Position of the root's link frame, world; setting it moves the whole body rigidly. Beyond 10 km, "
                   "the stability check restores the body."))),
          state(computed<&read_rotation, &write_rotation>(quat(
              "rotation",
              "Rotation of the root's link frame, world: x y z w; setting it rotates the whole body about the root."))),
          state(computed<&read_linear_velocity, &write_linear_velocity>(
              vec3("linear_velocity", "m/s", {0, 0, 0}, -1e4, 1e4,
                   "Velocity of the root; setting it sets that of all parts. From 500 m/s on, the stability check "
                   "restores the body."))),
          state(computed<&read_angular_velocity, &write_angular_velocity>(
              vec3("angular_velocity", "rad/s", {0, 0, 0}, -1e4, 1e4,
                   "Angular velocity of the root; setting it rotates the whole body about the root. From 1000 rad/s of "
                   "tumbling on, the stability check restores the body."))),
          state(computed<&read_motion, &write_motion>(
              choice("motion", {"dynamic", "kinematic", "static"}, 0,
                     "How the root moves; setting it sets that of all parts (a part without mass can't be dynamic)."))),
          on_change<&apply_gravity_factor>(
              number("gravity_factor", "", 1, -100, 100, "Factor on gravity: 0 floats, negative values rise.")),
          on_change<&apply_self_collision>(boolean(
              "self_collision", true,
              "Whether its parts collide with each other, except for pairs connected by a joint and excluded_pairs.")),
          on_change<&apply_can_sleep>(boolean(
              "can_sleep", true,
              "Whether its parts may fall asleep at rest; sleeping parts cost nothing until something acts on them.")),
          computed<&read_asleep>(readout(boolean("asleep", false, "True if all its movable parts sleep."))),
          computed<&read_body_mass>(
              readout(number("mass", "kg", 0, 0, kUnbounded, "Total mass of its movable parts."))),
          computed<&read_center_of_mass>(
              readout(vec3("center_of_mass", "m", {0, 0, 0}, -kUnbounded, kUnbounded,
                           "Center of mass of its movable parts, world, after the last tick."))),
          computed<&read_body_momentum>(
              readout(vec3("momentum", "kg·m/s", {0, 0, 0}, -kUnbounded, kUnbounded, "Total momentum, world axes."))),
          computed<&read_body_angular_momentum>(
              readout(vec3("angular_momentum", "kg·m²/s", {0, 0, 0}, -kUnbounded, kUnbounded,
                           "Angular momentum about its center of mass, world axes."))),
          computed<&read_body_kinetic_energy>(
              readout(number("kinetic_energy", "J", 0, 0, kUnbounded, "Energy of its motion and rotation."))),
          computed<&read_body_potential_energy>(
              readout(number("potential_energy", "J", 0, -kUnbounded, kUnbounded,
                             "Energy in the gravity field; 0 at the world's origin."))),
          transient(state(on_change<&Body::apply_enabled>(
              boolean("enabled", true,
                      "False: removed from the simulation, as after the second instability; reset enables it.")))),
          invokes<&reset_body>(action("reset", 0, 0, "Returns to the start pose, at rest.")),
          invokes<&act_remove>(action("remove", 0, 0, "Removes the body.")),
      });
  return table;
}

Body::Body(World& world, NodeId group, std::string name)
    : world_(world),
      id_(world.store().add(table(), group, std::move(name), this)),
      parts_(store(), store().add_group(id_, "part")),
      joints_(store(), store().add_group(id_, "joint")),
      motors_(store(), store().add_group(id_, "motor")),
      sensors_(std::make_unique<SensorList>(*this)),
      behaviors_(store(), store().add_group(id_, "behavior")) {}

Body::~Body() {
  world_.behaviors().on_body_destroyed(*this);
  // joints detach from their parts before the parts are destroyed
  sensors_->clear();
  motors_.objects().clear();
  joints_.objects().clear();
  parts_.objects().clear();
  store().remove(id_);
}

const std::string& Body::name() const { return store().name(id_); }
Store& Body::store() const { return world_.store(); }

// Saves the body's state before a guarded call changes it.
void Body::save_for_rollback() {
  if (!world_.transaction().first_in_call(saved_in_call_)) return;
  world_.transaction().save_fields(state_.initial_pose, state_.joints_dirty);
}

void Body::mark_joints_dirty() {
  save_for_rollback();
  state_.joints_dirty = true;
}

Result<Part*> Body::add_part(std::string name, Shape& shape, double mass, const Pose& pose) {
  if (const Result<void> free = parts_.check_new_name("part", name); !free) return Error{free.error()};
  if (!is_finite(pose.position) || !is_finite(pose.rotation) || glm::dot(pose.rotation, pose.rotation) < 1e-18) {
    return Error{fmt::format("part '{}/{}' needs a position of three numbers and a rotation that is not zero",
                             this->name(), name)};
  }
  const Property& mass_property = Part::table().at("mass");
  if (mass != 0 && !(mass >= mass_property.min && mass <= mass_property.max)) {
    return Error{fmt::format("part '{}/{}' needs a mass of {} .. {} kg, or 0 for a static part, not {}", this->name(),
                             name, mass_property.min, mass_property.max, mass)};
  }
  if (model::is_ground(shape.model()) && mass > 0) {
    return Error{fmt::format("part '{}/{}' is a {}: its mass must be 0, not {} kg", this->name(), name,
                             shape.model().surface != nullptr ? "surface" : "plane", mass)};
  }
  if (shape.placed().empty()) {
    return Error{fmt::format("compound '{}' is empty; add its children before a part is made of it", shape.name())};
  }
  auto part = std::make_unique<Part>(*this, parts_.group(), std::move(name), shape.geometry(), mass,
                                     Pose{pose.position, glm::normalize(pose.rotation)});
  part->set_shape(shape.id());
  if (model::is_ground(shape.model())) {
    // friction and restitution of two parts multiply: ground with 1 leaves the other part's values unchanged
    store().mutable_values(part->id(), Part::table().at("friction"))[0] = 1;
    store().mutable_values(part->id(), Part::table().at("restitution"))[0] = 1;
  }
  return &add_recorded(world_.transaction(), parts_, structure_version_, std::move(part));
}

Result<Joint*> Body::add_joint(std::string name, Part& parent, Part& child, model::JointType type, const Vec3& position,
                               const Vec3& axis) {
  if (const Result<void> free = joints_.check_new_name("joint", name); !free) return Error{free.error()};
  const auto fault = [&](std::string_view problem) {
    return Error{fmt::format("joint '{}/{}': {}", this->name(), name, problem)};
  };
  if (&parent == &child) return fault("parent and child must be different parts");
  if (&parent.body() != this || &child.body() != this) return fault("both parts must be of this body");
  if (!is_finite(position) || !is_finite(axis)) return fault("position and axis must be numbers");
  if (glm::length(axis) < 1e-9) return fault("the axis must not be zero");
  if (parent.mass() == 0 && child.mass() == 0) return fault("both parts are static; one must have mass");
  // z of the joint's frame is the axis; an upright axis keeps the world's orientation
  const Vec3 z = normalized(axis);
  const Vec3 reference = std::abs(z.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 y = normalized(glm::cross(z, reference));
  const bool upright = z.z > 1 - 1e-12;
  const Pose frame{position, upright ? quat_identity() : glm::normalize(glm::quat_cast(Mat3(glm::cross(y, z), y, z)))};
  JointSpec spec;
  spec.type = type;
  spec.frame_in_parent = parent.pose().inverse() * frame;
  spec.frame_in_child = child.pose().inverse() * frame;
  // Bullet must have the poses that were set before the joint reads its zero
  parent.flush();
  child.flush();
  auto joint = std::make_unique<Joint>(*this, joints_.group(), std::move(name), parent, child, spec);
  joint->update_from_parts();
  return &add_recorded(world_.transaction(), joints_, structure_version_, std::move(joint));
}

Result<Motor*> Body::add_motor(Joint& joint) {
  const auto fault = [&](std::string_view problem) {
    return Error{fmt::format("joint '{}/{}' {}", joint.body().name(), joint.name(), problem)};
  };
  if (&joint.body() != this) return fault("belongs to another body");
  if (joint.motor() != nullptr) return fault("has a motor already");
  if (joint.type() == model::JointType::fixed) return fault("is fixed and can't have a motor");
  return &add_recorded(world_.transaction(), motors_, structure_version_,
                       std::make_unique<Motor>(joint, motors_.group()));
}

Pose Body::pose() const { return parts().empty() ? state_.initial_pose : root()->pose(); }

void Body::set_pose(const Pose& pose) {
  if (parts().empty()) {
    save_for_rollback();
    state_.initial_pose = pose;
    return;
  }
  const Pose displacement = pose * this->pose().inverse();
  for (const auto& part : parts()) part->set_pose(part.get() == root() ? pose : displacement * part->pose());
}

bool Body::enabled() const {
  static const Property& property = table().at("enabled");
  return store().values(id_, property)[0] != 0;
}

void Body::set_enabled(bool on) {
  const double value = on ? 1 : 0;
  (void)store().set(id_, table().at("enabled"), {&value, 1});
}

void Body::apply_enabled() {
  if (enabled() == state_.in_world) return;
  state_.in_world = enabled();
  world_.sensing().parts().invalidate_bodies();
  if (state_.in_world) {
    state_.joints_dirty = true;  // World::flush() then adds it to Bullet's world and updates its joints
  } else {
    for (const auto& joint : joints()) joint->remove_from_world();
    for (const auto& part : parts()) part->remove_from_world();
    state_.added_parts = state_.added_joints = 0;
  }
}

// Parts are added to Bullet's world in their poses before the next step, not in those of their creation: copies of an
// arm are created in one place and would collide with each other there.
void Body::add_to_world() {
  if (!state_.in_world) return;
  for (; state_.added_parts < parts().size(); state_.added_parts++) parts()[state_.added_parts]->add_to_world();
  for (; state_.added_joints < joints().size(); state_.added_joints++) joints()[state_.added_joints]->add_to_world();
  for (Joint* follower : followers_) follower->add_mimic_gear();
}

std::uint32_t Body::structure_version() const { return structure_version_ + world_.kinematics().motion_changes(); }

bool Body::can_sleep() const {
  static const Property& property = table().at("can_sleep");
  return store().values(id_, property)[0] != 0;
}

bool Body::asleep() const {
  bool has_movable_part = false;
  for (const auto& part : parts()) {
    if (part->is_static()) continue;
    if (!part->asleep()) return false;
    has_movable_part = true;
  }
  return has_movable_part && state_.in_world;
}

bool Body::update_moved_joints() {
  if (!std::exchange(state_.joints_dirty, false)) return false;
  for (const auto& joint : joints()) joint->update_from_parts();
  return true;
}

void Body::publish() {
  for (const auto& part : parts()) {
    part->publish();
    warnings_.note(*part);
  }
  Joint* separated = nullptr;
  for (const auto& joint : joints()) {
    joint->publish();
    if (joint->check_separation()) separated = joint.get();
    warnings_.note(*joint);
  }
  recovery_.save_good_pose(separated);
}

void Body::serialize(Archive& archive) {
  auto& [in_world, joints_dirty, added_parts, added_joints, initial_pose] = state_;
  archive.serialize_all(in_world, joints_dirty, added_parts, added_joints, initial_pose);
  archive.serialize_all(pairs_, recovery_, warnings_);
  for (const auto& part : parts()) part->serialize(archive);
  for (const auto& joint : joints()) joint->serialize(archive);
  for (const auto& motor : motors()) motor->serialize(archive);
  sensors_->serialize(archive);
}

bool Body::is_static() const {
  return !parts().empty() &&
         std::all_of(parts().begin(), parts().end(), [](const auto& part) { return part->is_static(); });
}

}  // namespace limber::sim
