// Body: its properties; adding, finding and moving its parts, joints and motors.
#include "sim/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/text.h"
#include "params/values_hash.h"
#include "sim/behavior_list.h"
#include "sim/spin.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

template <class T>
T* find_by_name(const Store& store, NodeId group, std::string_view name) {
  const NodeId id = store.child(group, name);
  return id.null() ? nullptr : static_cast<T*>(store.thing(id));
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

const Table& Body::table() {
  static const Table table(
      "body", "/physics/body/<body>", "",
      {
          state(view<&Body::read_position, &Body::write_position>(
              vec3("position", "m", {0, 0, 0}, -1e4, 1e4,
                   "The root's link frame, world; setting it moves the whole body rigidly. The stability check "
                   "restores it from 10 km on."))),
          state(view<&Body::read_rotation, &Body::write_rotation>(quat(
              "rotation", "The root's link frame, world: x y z w; setting it turns the whole body about the root."))),
          state(view<&Body::read_linear_velocity, &Body::write_linear_velocity>(
              vec3("linear_velocity", "m/s", {0, 0, 0}, -1e4, 1e4,
                   "The root's; setting it gives the whole body this motion. The stability check restores it from 500 "
                   "m/s on."))),
          state(view<&Body::read_angular_velocity, &Body::write_angular_velocity>(
              vec3("angular_velocity", "rad/s", {0, 0, 0}, -1e4, 1e4,
                   "The root's; setting it turns the whole body about the root. The stability check restores what "
                   "tumbles at 1000 rad/s."))),
          effect<&Body::effect_self_collision>(
              boolean("self_collision", true,
                      "Whether its parts collide with each other; two that a joint connects never do, nor pairs of "
                      "excluded_pairs.")),
          effect<&Body::effect_can_sleep>(
              boolean("can_sleep", true,
                      "Whether its parts fall asleep when they are at rest; asleep, they cost nothing until something "
                      "acts on them.")),
          view<&Body::read_asleep>(readout(boolean("asleep", false, "All its parts that can move are asleep."))),
          live(state(effect<&Body::effect_enabled>(boolean(
              "enabled", true, "False: out of the world, as health leaves a body that broke twice; reset enables.")))),
          act<&Body::act_reset>(action("reset", 0, 0, "Back to the start pose, at rest.")),
          act<&Body::act_remove>(action("remove", 0, 0, "Takes the body away.")),
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
  world_.behaviors().body_gone(*this);
  // joints let go of parts before those go
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

// before a guarded call changes it
void Body::keep() {
  if (world_.undo().active()) world_.undo().keep(*this);
}

void Body::note_moved() {
  keep();
  moved_ = true;
}

Result<Part*> Body::add_part(std::string name, Shape& shape, double mass, const Pose& pose) {
  if (const Result<void> free = world_.name_is_free(part_group_, "part", name); !free) return Error{free.error()};
  if (!is_finite(pose.position) || !is_finite(pose.rotation) || glm::dot(pose.rotation, pose.rotation) < 1e-18) {
    return Error{fmt::format("part '{}/{}' needs a position of three numbers and a rotation that is not zero",
                             this->name(), name)};
  }
  const Row& mass_row = Part::table().at("mass");
  if (mass != 0 && !(mass >= mass_row.min && mass <= mass_row.max)) {
    return Error{fmt::format("part '{}/{}' needs a mass of {} .. {} kg, or 0 to never move, not {}", this->name(), name,
                             mass_row.min, mass_row.max, mass)};
  }
  if (shape.model().kind == ShapeKind::plane && mass > 0) {
    return Error{
        fmt::format("part '{}/{}' is a plane, which has mass 0 and never moves, not {} kg", this->name(), name, mass)};
  }
  if (shape.placed().empty()) {
    return Error{fmt::format("compound '{}' is empty; add its children before a part is made of it", shape.name())};
  }
  auto part = std::make_unique<Part>(*this, part_group_, std::move(name), shape.geometry(), mass,
                                     Pose{pose.position, glm::normalize(pose.rotation)});
  part->set_shape(shape.id());
  if (shape.model().kind == ShapeKind::plane) {
    // two parts' values multiply: a plane leaves the other's as they are
    store().tell(part->id(), Part::table().at("friction"))[0] = 1;
    store().tell(part->id(), Part::table().at("restitution"))[0] = 1;
  }
  parts_.push_back(std::move(part));
  structure_++;
  world_.undo().made_part(*this);
  return parts_.back().get();
}

Result<Joint*> Body::add_joint(std::string name, Part& parent, Part& child, JointType type, const Vec3& position,
                               const Vec3& axis) {
  if (const Result<void> free = world_.name_is_free(joint_group_, "joint", name); !free) return Error{free.error()};
  const auto fault = [&](std::string_view what) {
    return Error{fmt::format("joint '{}/{}': {}", this->name(), name, what)};
  };
  if (&parent == &child) return fault("a part can't hang on itself");
  if (&parent.body() != this || &child.body() != this) return fault("both parts must be of this body");
  if (!is_finite(position) || !is_finite(axis)) return fault("position and axis must be numbers");
  if (glm::length(axis) < 1e-9) return fault("the axis must not be zero");
  if (parent.is_static() && child.is_static()) return fault("both parts are static; one must have mass");
  // z of the joint's frame is the axis; about it the frame is turned as little as possible from the world's
  const Vec3 z = normalized(axis);
  const Vec3 side = std::abs(z.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 y = normalized(glm::cross(z, side));
  const bool upright = z.z > 1 - 1e-12;
  const Pose frame{position, upright ? quat_identity() : glm::normalize(glm::quat_cast(Mat3(glm::cross(y, z), y, z)))};
  JointSpec spec;
  spec.type = type;
  spec.frame_in_parent = parent.pose().inverse() * frame;
  spec.frame_in_child = child.pose().inverse() * frame;
  // the parts stand where they were put before the joint reads its zero
  parent.settle();
  child.settle();
  joints_.push_back(std::make_unique<Joint>(*this, joint_group_, std::move(name), parent, child, spec));
  world_.undo().made_joint(*this);
  joints_.back()->read_anew();
  structure_++;
  return joints_.back().get();
}

Result<Motor*> Body::add_motor(Joint& joint) {
  const auto fault = [&](std::string_view what) {
    return Error{fmt::format("joint '{}/{}' {}", joint.body().name(), joint.name(), what)};
  };
  if (&joint.body() != this) return fault("belongs to another body");
  if (joint.motor() != nullptr) return fault("has a motor already");
  if (joint.type() == JointType::fixed) return fault("is fixed and takes no motor");
  motors_.push_back(std::make_unique<Motor>(joint, motor_group_));
  structure_++;
  world_.undo().made_motor(*this);
  return motors_.back().get();
}

Pose Body::pose() const { return parts_.empty() ? planned_ : root()->pose(); }

void Body::set_pose(const Pose& pose) {
  if (parts_.empty()) {
    keep();
    planned_ = pose;
    return;
  }
  const Pose moved = pose * this->pose().inverse();
  for (const auto& part : parts_) part->set_pose(part.get() == root() ? pose : moved * part->pose());
}

bool Body::enabled() const {
  static const Row& row = table().at("enabled");
  return store().values(id_, row)[0] != 0;
}

void Body::set_enabled(bool on) {
  const double value = on ? 1 : 0;
  (void)store().set(id_, table().at("enabled"), {&value, 1});
}

void Body::effect_enabled() {
  if (enabled() == in_world_) return;
  in_world_ = enabled();
  if (in_world_) {
    moved_ = true;  // world_ settles it: there it enters too
  } else {
    for (const auto& joint : joints_) joint->leave();
    for (const auto& part : parts_) part->leave();
    entered_parts_ = entered_joints_ = 0;
  }
}

// Parts enter Bullet's world where they are before the next step, not where they were made: copies of an arm are made
// in one place, and there each would meet all others.
void Body::enter() {
  if (!in_world_) return;
  for (; entered_parts_ < parts_.size(); entered_parts_++) parts_[entered_parts_]->enter();
  for (; entered_joints_ < joints_.size(); entered_joints_++) joints_[entered_joints_]->enter();
  for (Joint* follower : followers_) follower->enter_mimic_gear();
}

void Body::effect_self_collision() {
  for (const auto& part : parts_) part->effect_collision();
}

bool Body::self_collision() const {
  static const Row& row = table().at("self_collision");
  return store().values(id_, row)[0] != 0;
}

bool Body::can_sleep() const {
  static const Row& row = table().at("can_sleep");
  return store().values(id_, row)[0] != 0;
}

bool Body::asleep() const {
  bool any = false;
  for (const auto& part : parts_) {
    if (part->is_static()) continue;
    if (!part->asleep()) return false;
    any = true;
  }
  return any && in_world_;
}

void Body::effect_can_sleep() {
  for (const auto& part : parts_) world_.bullet().sleep().allow(part->rigid(), can_sleep());
}

void Body::reset() {
  keep();
  for (const auto& part : parts_) {
    part->set_pose(part->start_pose());
    part->set_velocity(Vec3(0), Vec3(0));
    part->clear_forces();
  }
  for (const auto& joint : joints_) joint->go_to_start();
  world_.behaviors().body_reset(*this);
  restored_once_ = false;
  good_poses_ = 0;
  set_enabled(true);
}

void Body::take_start_pose() {
  for (const auto& part : parts_) part->set_start_pose(part->pose());
  for (const auto& joint : joints_) joint->take_start();
}

void Body::take_good_pose() {
  last_good_.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); i++) last_good_[i] = parts_[i]->pose();
  good_poses_ = parts_.size();
}

void Body::tell() {
  for (const auto& part : parts_) {
    part->tell();
    clamped_ = clamped_ || clamped_by(part->rigid()) > 0;
  }
  for (const auto& joint : joints_) {
    joint->tell();
    if (joint->comes_apart()) torn_ = joint.get();
    const JointConstraint& constraint = joint->constraint();
    warns_ = warns_ || constraint.holds_spring() || constraint.target_outside();
  }
}

void Body::say_clamp() {
  if (!std::exchange(clamped_, false) || said_clamp_) return;
  said_clamp_ = true;
  const auto clamp = [](const std::unique_ptr<Part>& part) { return clamped_by(part->rigid()); };
  const Part& part = **std::ranges::max_element(parts_, {}, clamp);
  const double allowed = kTurnClamp * world_.substeps() / world_.timestep();
  const double by = clamped_by(part.rigid());
  const double wanted = std::max(glm::length(part.angular_velocity()), allowed + by);
  log_warning(
      "part '{}/{}': rotation of {:.4g} rad/s is clamped by {:.4g} rad/s, since it exceeds 45 degrees per substep; "
      "about "
      "{} substeps would allow it (reported once per body)",
      name(), part.name(), wanted, by, std::ceil(wanted * world_.timestep() / kTurnClamp));
}

void Body::say_caps() {
  say_clamp();
  if (!std::exchange(warns_, false)) return;
  for (const auto& joint : joints_) {
    if (joint->motor() == nullptr) continue;
    if (joint->constraint().holds_spring()) joint->motor()->say_cap();
    if (joint->constraint().target_outside()) joint->motor()->warn_outside();
  }
}

std::uint64_t Body::state_hash(std::uint64_t hash) const {
  const Store& values = store();
  NumberHash numbers(hash_bytes(name(), hash));
  const auto add_node = [&](NodeId id) { numbers.add_word(node_hash(values, id)); };
  add_node(id_);
  if (parts_.empty()) {
    std::array<double, 7> pose{};
    put(pose.data(), planned_.position);
    put(pose.data() + 3, planned_.rotation);
    numbers.add(pose);
  }
  for (const auto& part : parts_) {
    add_motion(numbers, part->rigid());
    add_node(part->id());
  }
  for (const auto& joint : joints_) add_node(joint->id());
  for (const auto& motor : motors_) add_node(motor->id());
  for (const PartPair& pair : pairs_.list) {
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

void Body::report_static_velocity(std::string_view what) {
  if (std::exchange(reported_static_velocity_, true)) return;
  log_warning(
      "body '{}': {} static (mass 0), so a velocity has no effect; ignored (reported once). Give a mass, or set the "
      "position.",
      name(), what);
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
  if (is_static()) return report_static_velocity("its parts are");
  for (const auto& part : parts_) {
    if (!part->is_static()) part->set_velocity(vec3_at(in), part->angular_velocity());
  }
}

void Body::read_angular_velocity(double* out) const { put(out, parts_.empty() ? Vec3(0) : root()->angular_velocity()); }

void Body::write_angular_velocity(const double* in) {
  if (parts_.empty()) return;
  if (is_static()) return report_static_velocity("its parts are");
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
