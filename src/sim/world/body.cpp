// Body: its properties; adding, finding and moving its parts, joints and motors.
#include "sim/world/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log/log.h"
#include "base/text.h"
#include "properties/values_hash.h"
#include "sim/behavior/behavior_list.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/gear_constraint.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/bullet/spin.h"
#include "sim/world/world.h"

namespace limber {

namespace {

using namespace properties;

template <class T>
T* find_by_name(const Store& store, NodeId group, std::string_view name) {
  const NodeId id = store.child(group, name);
  return id.null() ? nullptr : static_cast<T*>(store.object(id));
}

void add_vector(NumberHash& numbers, const btVector3& v) { numbers.add(v.x(), v.y(), v.z()); }

void add_motion(NumberHash& numbers, const btRigidBody& rigid) {
  const btTransform& frame = rigid.getWorldTransform();
  for (int i = 0; i < 3; i++) add_vector(numbers, frame.getBasis()[i]);
  add_vector(numbers, frame.getOrigin());
  add_vector(numbers, rigid.getLinearVelocity());
  add_vector(numbers, rigid.getAngularVelocity());
}

}  // namespace

const PropertyTable& Body::table() {
  static const PropertyTable table(
      "body", "/physics/body/<body>", "",
      {
          state(computed<&Body::read_position, &Body::write_position>(
              vec3("position", "m", {0, 0, 0}, -1e4, 1e4,
                   "Position of the root's link frame, world; setting it moves the whole body rigidly. Beyond 10 km, "
                   "the stability check restores the body."))),
          state(computed<&Body::read_rotation, &Body::write_rotation>(quat(
              "rotation",
              "Rotation of the root's link frame, world: x y z w; setting it rotates the whole body about the root."))),
          state(computed<&Body::read_linear_velocity, &Body::write_linear_velocity>(
              vec3("linear_velocity", "m/s", {0, 0, 0}, -1e4, 1e4,
                   "Velocity of the root; setting it sets that of all parts. From 500 m/s on, the stability check "
                   "restores the body."))),
          state(computed<&Body::read_angular_velocity, &Body::write_angular_velocity>(
              vec3("angular_velocity", "rad/s", {0, 0, 0}, -1e4, 1e4,
                   "Angular velocity of the root; setting it rotates the whole body about the root. From 1000 rad/s of "
                   "tumbling on, the stability check restores the body."))),
          on_change<&Body::apply_self_collision>(boolean(
              "self_collision", true,
              "Whether its parts collide with each other, except for pairs connected by a joint and excluded_pairs.")),
          on_change<&Body::apply_can_sleep>(boolean(
              "can_sleep", true,
              "Whether its parts may fall asleep at rest; sleeping parts cost nothing until something acts on them.")),
          computed<&Body::read_asleep>(readout(boolean("asleep", false, "True if all its movable parts sleep."))),
          transient(state(on_change<&Body::apply_enabled>(
              boolean("enabled", true,
                      "False: removed from the simulation, as after the second instability; reset enables it.")))),
          invokes<&Body::act_reset>(action("reset", 0, 0, "Returns to the start pose, at rest.")),
          invokes<&Body::act_remove>(action("remove", 0, 0, "Removes the body.")),
      });
  return table;
}

Body::Body(World& world, NodeId group, std::string name)
    : world_(world), id_(world.store().add(table(), group, std::move(name), this)) {
  part_group_ = store().add_group(id_, "part");
  joint_group_ = store().add_group(id_, "joint");
  motor_group_ = store().add_group(id_, "motor");
  behavior_group_ = store().add_group(id_, "behavior");
}

Body::~Body() {
  world_.behaviors().on_body_destroyed(*this);
  // joints detach from their parts before the parts are destroyed
  motors_.clear();
  joints_.clear();
  parts_.clear();
  store().remove(id_);
}

const std::string& Body::name() const { return store().name(id_); }
Store& Body::store() const { return world_.store(); }

Part* Body::find_part(std::string_view name) const { return find_by_name<Part>(store(), part_group_, name); }
Joint* Body::find_joint(std::string_view name) const { return find_by_name<Joint>(store(), joint_group_, name); }
Motor* Body::find_motor(std::string_view name) const { return find_by_name<Motor>(store(), motor_group_, name); }

Behavior* Body::find_behavior(std::string_view name) const {
  return find_by_name<Behavior>(store(), behavior_group_, name);
}

Result<Pose> Body::link_pose(std::string_view name) const {
  if (const Part* part = find_part(name)) return part->pose();
  std::vector<std::string_view> names;
  for (const auto& part : parts_) names.push_back(part->name());
  if (model_ != nullptr) {
    for (const MergedLink& merged : model_->merged) {
      if (merged.name == name) return parts_[static_cast<std::size_t>(merged.link)]->pose() * merged.offset;
      names.push_back(merged.name);
    }
  }
  return Error{fmt::format("body '{}' has no link '{}'{}", this->name(), name, name_hint(name, names))};
}

// Saves the body's state before a guarded call changes it.
void Body::save_for_rollback() {
  if (!world_.transaction().first_in_call(saved_in_call_)) return;
  world_.transaction().save_fields(state_.initial_pose, state_.good_pose_count, state_.joints_dirty,
                                   state_.restored_once);
}

// Counts an addition to the end of a list, and records it, so that a guarded call that fails removes the element.
template <auto kList>
void Body::record_added() {
  structure_version_++;
  world_.transaction().record(
      [](void* owner, std::size_t) {
        auto& body = *static_cast<Body*>(owner);
        (body.*kList).pop_back();
        body.structure_version_++;
      },
      this);
}

void Body::mark_joints_dirty() {
  save_for_rollback();
  state_.joints_dirty = true;
}

Result<Part*> Body::add_part(std::string name, Shape& shape, double mass, const Pose& pose) {
  if (const Result<void> free = world_.check_new_name(part_group_, "part", name); !free) return Error{free.error()};
  if (!is_finite(pose.position) || !is_finite(pose.rotation) || glm::dot(pose.rotation, pose.rotation) < 1e-18) {
    return Error{fmt::format("part '{}/{}' needs a position of three numbers and a rotation that is not zero",
                             this->name(), name)};
  }
  const Property& mass_property = Part::table().at("mass");
  if (mass != 0 && !(mass >= mass_property.min && mass <= mass_property.max)) {
    return Error{fmt::format("part '{}/{}' needs a mass of {} .. {} kg, or 0 for a static part, not {}", this->name(),
                             name, mass_property.min, mass_property.max, mass)};
  }
  if (shape.model().kind == ShapeKind::plane && mass > 0) {
    return Error{fmt::format("part '{}/{}' is a plane: its mass must be 0, not {} kg", this->name(), name, mass)};
  }
  if (shape.placed().empty()) {
    return Error{fmt::format("compound '{}' is empty; add its children before a part is made of it", shape.name())};
  }
  auto part = std::make_unique<Part>(*this, part_group_, std::move(name), shape.geometry(), mass,
                                     Pose{pose.position, glm::normalize(pose.rotation)});
  part->set_shape(shape.id());
  if (shape.model().kind == ShapeKind::plane) {
    // friction and restitution of two parts multiply: a plane with 1 leaves the other part's values unchanged
    store().mutable_values(part->id(), Part::table().at("friction"))[0] = 1;
    store().mutable_values(part->id(), Part::table().at("restitution"))[0] = 1;
  }
  parts_.push_back(std::move(part));
  record_added<&Body::parts_>();
  return parts_.back().get();
}

Result<Joint*> Body::add_joint(std::string name, Part& parent, Part& child, JointType type, const Vec3& position,
                               const Vec3& axis) {
  if (const Result<void> free = world_.check_new_name(joint_group_, "joint", name); !free) return Error{free.error()};
  const auto fault = [&](std::string_view problem) {
    return Error{fmt::format("joint '{}/{}': {}", this->name(), name, problem)};
  };
  if (&parent == &child) return fault("parent and child must be different parts");
  if (&parent.body() != this || &child.body() != this) return fault("both parts must be of this body");
  if (!is_finite(position) || !is_finite(axis)) return fault("position and axis must be numbers");
  if (glm::length(axis) < 1e-9) return fault("the axis must not be zero");
  if (parent.is_static() && child.is_static()) return fault("both parts are static; one must have mass");
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
  joints_.push_back(std::make_unique<Joint>(*this, joint_group_, std::move(name), parent, child, spec));
  record_added<&Body::joints_>();
  joints_.back()->update_from_parts();
  return joints_.back().get();
}

Result<Motor*> Body::add_motor(Joint& joint) {
  const auto fault = [&](std::string_view problem) {
    return Error{fmt::format("joint '{}/{}' {}", joint.body().name(), joint.name(), problem)};
  };
  if (&joint.body() != this) return fault("belongs to another body");
  if (joint.motor() != nullptr) return fault("has a motor already");
  if (joint.type() == JointType::fixed) return fault("is fixed and can't have a motor");
  motors_.push_back(std::make_unique<Motor>(joint, motor_group_));
  record_added<&Body::motors_>();
  return motors_.back().get();
}

Pose Body::pose() const { return parts_.empty() ? state_.initial_pose : root()->pose(); }

void Body::set_pose(const Pose& pose) {
  if (parts_.empty()) {
    save_for_rollback();
    state_.initial_pose = pose;
    return;
  }
  const Pose displacement = pose * this->pose().inverse();
  for (const auto& part : parts_) part->set_pose(part.get() == root() ? pose : displacement * part->pose());
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
  if (state_.in_world) {
    state_.joints_dirty = true;  // World::flush() then adds it to Bullet's world and updates its joints
  } else {
    for (const auto& joint : joints_) joint->remove_from_world();
    for (const auto& part : parts_) part->remove_from_world();
    state_.added_parts = state_.added_joints = 0;
  }
}

// Parts are added to Bullet's world in their poses before the next step, not in those of their creation: copies of an
// arm are created in one place and would collide with each other there.
void Body::add_to_world() {
  if (!state_.in_world) return;
  for (; state_.added_parts < parts_.size(); state_.added_parts++) parts_[state_.added_parts]->add_to_world();
  for (; state_.added_joints < joints_.size(); state_.added_joints++) joints_[state_.added_joints]->add_to_world();
  for (Joint* follower : followers_) follower->add_mimic_gear();
}

void Body::apply_self_collision() {
  for (const auto& part : parts_) part->apply_collision();
}

bool Body::self_collision() const {
  static const Property& property = table().at("self_collision");
  return store().values(id_, property)[0] != 0;
}

bool Body::can_sleep() const {
  static const Property& property = table().at("can_sleep");
  return store().values(id_, property)[0] != 0;
}

bool Body::asleep() const {
  bool has_movable_part = false;
  for (const auto& part : parts_) {
    if (part->is_static()) continue;
    if (!part->asleep()) return false;
    has_movable_part = true;
  }
  return has_movable_part && state_.in_world;
}

void Body::apply_can_sleep() {
  for (const auto& part : parts_) world_.bullet().sleep().allow(part->rigid(), can_sleep());
}

void Body::reset() {
  save_for_rollback();
  for (const auto& part : parts_) {
    part->set_pose(part->start_pose());
    part->set_velocity(Vec3(0), Vec3(0));
    part->clear_forces();
  }
  for (const auto& joint : joints_) joint->restore_start();
  world_.behaviors().on_body_reset(*this);
  state_.restored_once = false;
  state_.good_pose_count = 0;
  set_enabled(true);
}

void Body::prepare_step() {
  if (std::exchange(state_.is_new, false)) save_start_pose();
  if (has_unchecked_parts()) find_overlaps();
}

void Body::publish() {
  separated_joint_ = nullptr;
  for (const auto& part : parts_) {
    part->publish();
    clamped_ = clamped_ || clamped_by(part->rigid()) > 0;
  }
  for (const auto& joint : joints_) {
    joint->publish();
    if (joint->check_separation()) separated_joint_ = joint.get();
    const JointConstraint& constraint = joint->constraint();
    has_joint_warnings_ =
        has_joint_warnings_ || constraint.drives().spring_limited() || constraint.drives().target_outside();
  }
  if (!state_.restored_this_tick && separated_joint_ == nullptr) save_good_pose();
}

const Joint* Body::consume_separated_joint() {
  const Joint* const separated = std::exchange(separated_joint_, nullptr);
  return state_.restored_this_tick ? nullptr : separated;
}

void Body::insert_behavior(std::size_t index, Behavior& behavior) {
  behaviors_.insert(behaviors_.begin() + static_cast<std::ptrdiff_t>(index), &behavior);
}

void Body::replace_behavior(const Behavior& previous, Behavior& behavior) {
  *std::ranges::find(behaviors_, &previous) = &behavior;
}

std::size_t Body::remove_behavior(const Behavior& behavior) {
  const auto at = std::ranges::find(behaviors_, &behavior);
  return static_cast<std::size_t>(behaviors_.erase(at) - behaviors_.begin());
}

void Body::serialize(Archive& archive) {
  auto& [in_world, joints_dirty, restored_this_tick, restored_once, is_new, warned_static_velocity, warned_clamped,
         added_parts, added_joints, good_pose_count, good_poses, pairs, initial_pose] = state_;
  archive.serialize_all(in_world, joints_dirty, restored_this_tick, restored_once, is_new, warned_static_velocity,
                        warned_clamped, added_parts, added_joints, good_pose_count, good_poses, pairs, initial_pose);
  for (const auto& part : parts_) part->serialize(archive);
  for (const auto& joint : joints_) joint->serialize(archive);
  for (const auto& motor : motors_) motor->serialize(archive);
}

void Body::warn_clamped() {
  if (!std::exchange(clamped_, false) || state_.warned_clamped) return;
  state_.warned_clamped = true;
  const auto clamped_of = [](const std::unique_ptr<Part>& part) { return clamped_by(part->rigid()); };
  const Part& part = **std::ranges::max_element(parts_, {}, clamped_of);
  const double allowed = kMaxRotationPerStep * world_.substeps() / world_.timestep();
  const double excess = clamped_by(part.rigid());
  const double requested = std::max(glm::length(part.angular_velocity()), allowed + excess);
  log_warning(
      "part '{}/{}': rotation of {:.4g} rad/s is clamped by {:.4g} rad/s, since it exceeds 45 degrees per substep; "
      "about {} substeps would allow it (reported once per body)",
      name(), part.name(), requested, excess, std::ceil(requested * world_.timestep() / kMaxRotationPerStep));
}

void Body::log_warnings() {
  warn_clamped();
  if (!std::exchange(has_joint_warnings_, false)) return;
  for (const auto& joint : joints_) {
    if (joint->motor() == nullptr) continue;
    if (joint->constraint().drives().spring_limited()) joint->motor()->warn_capped();
    if (joint->constraint().drives().target_outside()) joint->motor()->warn_target_outside();
  }
}

std::uint64_t Body::state_hash(std::uint64_t hash) const {
  const Store& values = store();
  NumberHash numbers(hash_bytes(name(), hash));
  const auto add_node = [&](NodeId id) { numbers.add_word(node_hash(values, id)); };
  add_node(id_);
  if (parts_.empty()) {
    std::array<double, 7> pose{};
    put(pose.data(), state_.initial_pose.position);
    put(pose.data() + 3, state_.initial_pose.rotation);
    numbers.add(pose);
  }
  for (const auto& part : parts_) {
    add_motion(numbers, part->rigid());
    add_node(part->id());
  }
  for (const auto& joint : joints_) add_node(joint->id());
  for (const auto& motor : motors_) add_node(motor->id());
  for (const PartPair& pair : state_.pairs.list) {
    numbers.add(static_cast<double>(pair.a), static_cast<double>(pair.b), pair.excluded() ? 1 : 0);
  }
  hash = numbers.value();
  for (const Behavior* behavior : behaviors_) hash = behavior->state_hash(hash);
  return hash;
}

bool Body::is_static() const {
  return !parts_.empty() &&
         std::all_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->is_static(); });
}

void Body::warn_static_velocity(std::string_view subject) {
  if (std::exchange(state_.warned_static_velocity, true)) return;
  log_warning(
      "body '{}': {} static (mass 0), so a velocity has no effect; ignored (reported once). Give a mass, or set the "
      "position.",
      name(), subject);
}

void Body::read_position(double* out) const { put(out, pose().position); }
void Body::write_position(const double* in) { set_pose({vec3_at(in), pose().rotation}); }

void Body::read_rotation(double* out) const {
  const Quat q = pose().rotation;
  out[0] = q.x;
  out[1] = q.y;
  out[2] = q.z;
  out[3] = q.w;
}

void Body::write_rotation(const double* in) { set_pose({pose().position, quat_xyzw(in[0], in[1], in[2], in[3])}); }

void Body::read_linear_velocity(double* out) const { put(out, parts_.empty() ? Vec3(0) : root()->linear_velocity()); }

void Body::write_linear_velocity(const double* in) {
  if (is_static()) return warn_static_velocity("its parts are");
  for (const auto& part : parts_) {
    if (!part->is_static()) part->set_velocity(vec3_at(in), part->angular_velocity());
  }
}

void Body::read_angular_velocity(double* out) const { put(out, parts_.empty() ? Vec3(0) : root()->angular_velocity()); }

void Body::write_angular_velocity(const double* in) {
  if (parts_.empty()) return;
  if (is_static()) return warn_static_velocity("its parts are");
  const Vec3 omega = vec3_at(in);
  const Vec3 pivot = root()->center();
  const Vec3 velocity = root()->linear_velocity();
  for (const auto& part : parts_) {
    if (part->is_static()) continue;
    part->set_velocity(velocity + glm::cross(omega, part->center() - pivot), omega);
  }
}

Result<void> Body::act_reset(std::span<const double>) {
  reset();
  return {};
}

Result<void> Body::act_remove(std::span<const double>) {
  world_.remove_body(*this);
  return {};
}

}  // namespace limber
