// Part: its properties, and the conversion between the link frame of the public interface and Bullet's frame.
#include "sim/world/part.h"

#include <array>

#include <fmt/format.h>

#include "base/memory/prefetch.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/rotation_step.h"
#include "sim/bullet/surface_motion.h"
#include "sim/collision/contact_friction.h"
#include "sim/collision/time_of_impact.h"
#include "sim/motion/part_motion.h"
#include "sim/sensors/readouts.h"
#include "sim/world/body.h"
#include "sim/world/world.h"

namespace limber::sim {

namespace {

using namespace properties;

// Properties that every tick reads and writes.
struct MotionProperties {
  const Property* position;
  const Property* rotation;
  const Property* linear_velocity;
  const Property* angular_velocity;
};

const MotionProperties& motion_properties() {
  static const MotionProperties found{&Part::table().at("position"), &Part::table().at("rotation"),
                                      &Part::table().at("linear_velocity"), &Part::table().at("angular_velocity")};
  return found;
}

double number_of(const Part& part, const Property& property) {
  return part.body().store().values(part.id(), property)[0];
}

// Callbacks of the properties.

void apply_damping(Part& part) {
  static const Property& linear = Part::table().at("linear_damping");
  static const Property& angular = Part::table().at("angular_damping");
  btRigidBody& rigid = part.rigid();
  const std::array<btScalar, 2> before{rigid.getLinearDamping(), rigid.getAngularDamping()};
  rigid.setDamping(static_cast<btScalar>(number_of(part, linear)), static_cast<btScalar>(number_of(part, angular)));
  if (before != std::array<btScalar, 2>{rigid.getLinearDamping(), rigid.getAngularDamping()}) part.wake();
}

std::array<btScalar, 8> surface_of(const btRigidBody& rigid) {
  const btVector3& anisotropic = rigid.getAnisotropicFriction();
  return {rigid.getFriction(),
          rigid.getRollingFriction(),
          rigid.getSpinningFriction(),
          rigid.getRestitution(),
          anisotropic.x(),
          anisotropic.y(),
          anisotropic.z(),
          anisotropic.w()};
}

void apply_surface(Part& part) {
  static const Property& friction = Part::table().at("friction");
  static const Property& rolling = Part::table().at("rolling_friction");
  static const Property& spinning = Part::table().at("spinning_friction");
  static const Property& direction = Part::table().at("friction_direction");
  static const Property& factor = Part::table().at("friction_factor");
  static const Property& bounce = Part::table().at("restitution");
  btRigidBody& rigid = part.rigid();
  const std::array<btScalar, 8> before = surface_of(rigid);
  rigid.setFriction(static_cast<btScalar>(number_of(part, friction)));
  rigid.setRollingFriction(static_cast<btScalar>(number_of(part, rolling)));
  rigid.setSpinningFriction(static_cast<btScalar>(number_of(part, spinning)));
  const Vec3 in_link = vec3_at(part.body().store().values(part.id(), direction));
  collision::set_friction_direction(rigid, bullet::to_bt(glm::inverse(part.geometry()->frame.rotation) * in_link),
                                    static_cast<btScalar>(number_of(part, factor)));
  const auto restitution = static_cast<btScalar>(number_of(part, bounce));
  rigid.setRestitution(restitution);
  if (surface_of(rigid) != before) part.wake();
  // A part that bounces must not be slowed down before it touches: contacts that Bullet predicts would absorb a share
  // of the bounce.
  const btScalar threshold = restitution > 0 && !part.is_static() ? btScalar(0) : btScalar(BT_LARGE_FLOAT);
  if (rigid.getContactProcessingThreshold() == threshold) return;
  rigid.setContactProcessingThreshold(threshold);
  // existing contacts keep the threshold that they were created with
  bullet::IslandWorld& bullet = part.body().world().bullet();
  if (!rigid.isInWorld()) return;
  bullet.getPairCache()->cleanProxyFromPairs(rigid.getBroadphaseHandle(), bullet.getDispatcher());
}

void read_center(const Part& part, double* out) { put(out, part.center()); }
void read_inertia(const Part& part, double* out) { put(out, part.geometry()->unit_inertia * part.mass()); }
void read_principal_axes(const Part& part, double* out) { put(out, part.principal_axes()); }
void read_rotation_clamped(const Part& part, double* out) { out[0] = bullet::clamped_speed(part.rigid()); }

// Prefetches all of the rigid body, since on-change callbacks access fields all over it.
void prefetch_rigid_body(const void* object) {
  prefetch(&static_cast<const Part*>(object)->rigid(), sizeof(btRigidBody));
}

Result<void> validate_mass(const Part& part, const double*) {
  if (part.mass() > 0) return {};
  return Error{"the part was created static (mass 0); create it with a mass instead"};
}

// Marks a property that sets the pose: rays then find the part there.
Property moves(Property property) {
  property.on_write = [](void* part, const Property&) {
    static_cast<const Part*>(part)->body().world().sensing().parts().invalidate();
  };
  return property;
}

// Calls one of two member functions of the part: with 3 numbers, or with 6, of which the last 3 are a point.
Result<void> act_at(Part& part, std::span<const double> a, void (Part::*act)(const Vec3&),
                    void (Part::*act_at_point)(const Vec3&, const Vec3&)) {
  if (a.size() == 3) {
    (part.*act)(vec3_at(a.data()));
  } else if (a.size() == 6) {
    (part.*act_at_point)(vec3_at(a.data()), vec3_at(a.data() + 3));
  } else {
    return Error{fmt::format("takes 3 numbers, or 6 with a point, not {}", a.size())};
  }
  return {};
}

Result<void> act_force(Part& part, std::span<const double> a) {
  return act_at(part, a, &Part::apply_force, &Part::apply_force_at);
}

Result<void> act_impulse(Part& part, std::span<const double> a) {
  return act_at(part, a, &Part::apply_impulse, &Part::apply_impulse_at);
}

Result<void> act_torque(Part& part, std::span<const double> a) {
  part.apply_torque(vec3_at(a.data()));
  return {};
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a list of entries
const PropertyTable& Part::table() {
  static const PropertyTable table(
      "part", "/physics/body/<body>/part/<part>", "/physics/part",
      {
          validated_by<&validate_mass>(on_change<&apply_part_mass>(number(
              "mass", "kg", 1, 0.001, 1e6, "Mass; the inertia scales with it. A part created with mass 0 is static."))),
          validated_by<&validate_motion>(on_change<&apply_part_motion>(choice(
              "motion", {"dynamic", "kinematic", "static"}, 0,
              "dynamic: moved by forces; kinematic: moved by setting its pose or velocity, pushes others and is never "
              "pushed; static: doesn't move. A part created with mass 0 is static."))),
          on_change<&apply_damping>(
              number("linear_damping", "1/s", 0, 0, 1, "Fraction of the velocity lost per second.")),
          on_change<&apply_damping>(
              number("angular_damping", "1/s", 0, 0, 1, "Fraction of the angular velocity lost per second.")),
          on_change<&apply_surface>(
              number("friction", "", 0.5, 0, 100, "Coulomb friction; the values of two touching parts multiply.")),
          on_change<&apply_surface>(number("rolling_friction", "m", 0, 0, 100,
                                           "Resistance to rolling; the values of two touching parts are mixed.")),
          on_change<&apply_surface>(number("spinning_friction", "m", 0, 0, 100,
                                           "Resistance to spinning about the contact's normal; mixed like rolling "
                                           "friction.")),
          on_change<&apply_surface>(
              vec3("friction_direction", "", {0, 0, 0}, -1, 1,
                   "Direction in the link frame in which friction is scaled by friction_factor; zeros: none.")),
          on_change<&apply_surface>(number("friction_factor", "", 1, 0, 100,
                                           "Ratio of the friction along friction_direction to that across it.")),
          on_change<&apply_surface>(number(
              "restitution", "", 0, 0, 1,
              "Restitution: share of the normal speed after a bounce; the values of two touching parts multiply.")),
          on_change<&apply_surface_velocity>(vec3(
              "surface_velocity", "m/s", {0, 0, 0}, -1e3, 1e3,
              "Velocity of its surface along itself, in the link frame, as of a conveyor belt: friction moves parts "
              "that touch it at this velocity.")),
          on_change<&Part::apply_collision>(
              boolean("self_collision", true, "Whether it collides with other parts of its body.")),
          on_change<&Part::apply_collision>(integer(
              "collision_group", 1, 0, 65535,
              "Its groups, as a bit set of 16. Two parts collide if each one's group has a bit in the other's mask.")),
          on_change<&Part::apply_collision>(
              integer("collision_mask", 65535, 0, 65535, "The groups that it collides with, as a bit set of 16.")),
          on_change<&Part::apply_report_contacts>(
              boolean("report_contacts", false, "Report contacts of this part with others, and measure their forces.")),
          boolean("stream_contacts", false,
                  "Send each contact point of this part over OSC after each tick, if report_contacts is on."),
          // neighbors: engine/output/render_scene copies both at once
          vec3("tint", "hsb", {0, 0, 1}, 0, 1,
               "Color that multiplies the colors and textures of its shapes: hue, saturation, brightness."),
          number("transparency", "", 0, 0, 1, "0: as its shapes; 1: invisible."),
          moves(transient(state(on_change<&apply_part_pose>(
              vec3("position", "m", {0, 0, 0}, -1e6, 1e6,
                   "Origin of the link frame, world. Beyond 10 km, the stability check restores the body."))))),
          moves(transient(state(on_change<&apply_part_pose>(quat("rotation", "Link frame, world: x y z w."))))),
          transient(state(on_change<&apply_part_velocity>(
              vec3("linear_velocity", "m/s", {0, 0, 0}, -1e4, 1e4,
                   "Velocity of the center of mass, world. From 500 m/s on, the stability check restores the body.")))),
          transient(state(on_change<&apply_part_velocity>(vec3(
              "angular_velocity", "rad/s", {0, 0, 0}, -1e4, 1e4,
              "Angular velocity, world axes. The stability check restores the body from 1000 rad/s on, not counting "
              "rotation about a driven joint's axis or a principal axis, and from 20000 rad/s on in any case.")))),
          computed<&read_center>(readout(vec3("center", "m", {0, 0, 0}, -1e6, 1e6, "Center of mass, world."))),
          computed<&read_inertia>(readout(vec3("inertia", "kg·m²", {0, 0, 0}, 0, kUnbounded,
                                               "Moments of inertia about the principal axes; static: 0."))),
          computed<&read_principal_axes>(
              readout(properties::quat("principal_axes", "Principal axes of inertia, world: x y z w."))),
          computed<&read_rotation_clamped>(readout(number(
              "rotation_clamped", "rad/s", 0, 0, kUnbounded,
              "Angular speed clamped off in the last tick; 0: not clamped. Rotation is limited to π/4 per substep, "
              "except about a driven joint's axis or a principal axis. More substeps raise the limit."))),
          computed<&read_contact_count>(readout(
              integer("contact_count", 0, 0, kUnbounded, "Number of its contact points, if report_contacts is on."))),
          computed<&read_contact_normal_force>(
              readout(number("contact_normal_force", "N", 0, 0, kUnbounded,
                             "Sum of the normal forces at its contact points, mean of the last tick."))),
          computed<&read_contact_friction_force>(
              readout(number("contact_friction_force", "N", 0, 0, kUnbounded,
                             "Size of the total friction force on it, mean of the last tick."))),
          computed<&read_contact_force>(
              readout(vec3("contact_force", "N", {0, 0, 0}, -kUnbounded, kUnbounded,
                           "Total force of its contacts on it, world, mean of the last tick."))),
          invokes<&act_force>(action("apply_force", 3, 6,
                                     "Force in N for one tick, world; at a world point, else the center. From 500 "
                                     "m/s on, the stability check restores the body.")),
          invokes<&act_impulse>(action("apply_impulse", 3, 6,
                                       "Impulse in N·s, world; at a world point, else the center. From 500 m/s on, "
                                       "the stability check restores the body.")),
          invokes<&act_torque>(action("apply_torque", 3, 3,
                                      "Torque in N·m for one tick, world axes. From 1000 rad/s of tumbling on, the "
                                      "stability check restores the body.")),
      },
      &prefetch_rigid_body);
  return table;
}

Part::Part(Body& body, NodeId group, std::string name, std::shared_ptr<const Geometry> geometry, double mass,
           const Pose& pose)
    : body_(body),
      id_(body.store().add(table(), group, std::move(name), this)),
      accumulator_(body.world().force_accumulators().add(*this)),
      geometry_(std::move(geometry)),
      state_{.kinematic = {.motion = mass > 0 ? PartMotion::dynamic : PartMotion::fixed}, .start = pose} {
  body_.store().mutable_values(id_, table().at("mass"))[0] = is_static() ? 0 : mass;
  body_.store().mutable_values(id_, table().at("motion"))[0] = static_cast<double>(motion());
  const btVector3 inertia = is_static() ? btVector3(0, 0, 0) : bullet::to_bt(geometry_->unit_inertia * mass);
  btRigidBody::btRigidBodyConstructionInfo info(is_static() ? btScalar(0) : static_cast<btScalar>(mass), nullptr,
                                                geometry_->shape.get(), inertia);
  info.m_startWorldTransform = bullet::to_bt(pose * geometry_->frame);
  {
    const bullet::BulletMemory::Scope scope(&body_.world().bullet_memory());
    rigid_ = std::make_unique<btRigidBody>(info);
  }
  rigid_->setUserPointer(this);
  rigid_->setActivationState(DISABLE_DEACTIVATION);
  rigid_->setCcdMotionThreshold(collision::inner_radius(*geometry_->shape));  // see ContinuousCollision
  set_pose(pose);
  body_.world().mass_table().add(*this);
}

Part::~Part() {
  World& world = body_.world();
  if (reports_contacts()) world.sensing().contacts().set_reporting(false);
  world.sensing().contacts().remove_part(*this);
  world.kinematics().remove(*this);
  remove_from_world();
  delete bullet::surface_velocity(*rigid_);
  world.force_accumulators().remove(accumulator_);
  body_.store().remove(id_);
}

void Part::add_to_world() {
  if (rigid_->isInWorld()) return;
  // it may have been removed while it was asleep
  rigid_->forceActivationState(DISABLE_DEACTIVATION);
  body_.world().bullet().addRigidBody(rigid_.get());
  body_.world().bullet().sleep().allow(*rigid_, body_.can_sleep());
}

void Part::remove_from_world() {
  if (rigid_->isInWorld()) body_.world().bullet().removeRigidBody(rigid_.get());
}

void Part::wake() {
  if (rigid_->isInWorld()) body_.world().bullet().sleep().wake(*rigid_);
}

const std::string& Part::name() const { return body_.store().name(id_); }

Pose Part::pose() const {
  const Store& store = body_.store();
  return {vec3_at(store.values(id_, *motion_properties().position)),
          quat_at(store.values(id_, *motion_properties().rotation))};
}

Vec3 Part::center() const { return pose() * geometry_->frame.position; }

double Part::mass() const {
  static const Property& property = table().at("mass");
  return body_.store().values(id_, property)[0];
}

Vec3 Part::linear_velocity() const { return vec3_at(body_.store().values(id_, *motion_properties().linear_velocity)); }
Vec3 Part::angular_velocity() const {
  return vec3_at(body_.store().values(id_, *motion_properties().angular_velocity));
}

void Part::set_pose(const Pose& pose) {
  Store& store = body_.store();
  store.save_before_write(id_, *motion_properties().position);
  store.save_before_write(id_, *motion_properties().rotation);
  put(store.mutable_values(id_, *motion_properties().position), pose.position);
  put(store.mutable_values(id_, *motion_properties().rotation), pose.rotation);
  store.mark_dirty(id_, *motion_properties().position);
  body_.world().sensing().parts().invalidate();
}

void Part::set_velocity(const Vec3& linear, const Vec3& angular) {
  Store& store = body_.store();
  store.save_before_write(id_, *motion_properties().linear_velocity);
  store.save_before_write(id_, *motion_properties().angular_velocity);
  put(store.mutable_values(id_, *motion_properties().linear_velocity), linear);
  put(store.mutable_values(id_, *motion_properties().angular_velocity), angular);
  store.mark_dirty(id_, *motion_properties().linear_velocity);
}

bool Part::asleep() const { return !is_static() && !rigid_->isActive(); }

Part::Motion Part::capture_motion() const {
  const btMatrix3x3& r = rigid_->getWorldTransform().getBasis();
  const btVector3& p = rigid_->getWorldTransform().getOrigin();
  const btVector3& v = rigid_->getLinearVelocity();
  const btVector3& w = rigid_->getAngularVelocity();
  return {.pose = pose(),
          .linear_velocity = linear_velocity(),
          .angular_velocity = angular_velocity(),
          .bullet_pose = {r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2], p[0], p[1],
                          p[2]},
          .bullet_linear_velocity = {v[0], v[1], v[2]},
          .bullet_angular_velocity = {w[0], w[1], w[2]},
          .set_linear_velocity = state_.kinematic.linear,
          .set_angular_velocity = state_.kinematic.angular};
}

void Part::set_motion(const Motion& motion) {
  // writes Bullet's pose directly instead of marking the property dirty, which would round it: the store's pose is
  // converted to a quaternion
  double* const transient = body_.store().transient_block(id_);
  put(transient + motion_properties().position->offset, motion.pose.position);
  put(transient + motion_properties().rotation->offset, motion.pose.rotation);
  put(transient + motion_properties().linear_velocity->offset, motion.linear_velocity);
  put(transient + motion_properties().angular_velocity->offset, motion.angular_velocity);
  const auto& m = motion.bullet_pose;
  const btTransform transform(btMatrix3x3(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]),
                              btVector3(m[9], m[10], m[11]));
  const auto vector = [](const std::array<float, 3>& v) { return btVector3(v[0], v[1], v[2]); };
  rigid_->setWorldTransform(transform);
  rigid_->setInterpolationWorldTransform(transform);
  rigid_->setLinearVelocity(vector(motion.bullet_linear_velocity));
  rigid_->setAngularVelocity(vector(motion.bullet_angular_velocity));
  rigid_->updateInertiaTensor();
  state_.kinematic.linear = motion.set_linear_velocity;
  state_.kinematic.angular = motion.set_angular_velocity;
  if (is_static()) body_.world().kinematics().add(*this);
}

void Part::save_for_rollback() {
  WorldTransaction& transaction = body_.world().transaction();
  if (transaction.first_in_call(saved_in_call_)) transaction.save_forces(*this);
}

void Part::flush() {
  WorldTransaction& transaction = body_.world().transaction();
  if (!transaction.active()) return body_.store().flush();
  transaction.save_motion(*this);
  save_kinematic_state(*this);
  body_.store().flush(id_);
}

void Part::apply_force(const Vec3& force) {
  save_for_rollback();
  body_.world().force_accumulators().wrench(accumulator_).force += force;
}

void Part::apply_torque(const Vec3& torque) {
  save_for_rollback();
  body_.world().force_accumulators().wrench(accumulator_).torque += torque;
}

void Part::apply_impulse(const Vec3& impulse) {
  save_for_rollback();
  body_.world().force_accumulators().impulse(accumulator_).linear += impulse;
}

void Part::apply_force_at(const Vec3& force, const Vec3& at) {
  apply_force(force);
  apply_torque(glm::cross(at - center(), force));
}

void Part::apply_impulse_at(const Vec3& impulse, const Vec3& at) {
  apply_impulse(impulse);
  body_.world().force_accumulators().impulse(accumulator_).angular += glm::cross(at - center(), impulse);
}

void Part::clear_forces() {
  save_for_rollback();
  body_.world().force_accumulators().clear(accumulator_);
}

void Part::publish() {
  double* const transient = body_.store().transient_block(id_);
  const MotionProperties& properties = motion_properties();
  const Pose pose = bullet::from_bt(rigid_->getWorldTransform()) * geometry_->frame.inverse();
  put(transient + properties.position->offset, pose.position);
  put(transient + properties.rotation->offset, pose.rotation);
  put(transient + properties.linear_velocity->offset, bullet::from_bt(rigid_->getLinearVelocity()));
  put(transient + properties.angular_velocity->offset, bullet::from_bt(rigid_->getAngularVelocity()));
}

bool Part::reports_contacts() const { return state_.report_contacts; }

void Part::apply_collision() {
  static const Property& group = table().at("collision_group");
  static const Property& mask = table().at("collision_mask");
  static const Property& own = table().at("self_collision");
  static const Property& of_body = Body::table().at("self_collision");
  const Store& store = body_.store();
  bullet::CollisionFilter filter;
  filter.group = static_cast<std::uint16_t>(store.values(id_, group)[0]);
  filter.mask = static_cast<std::uint16_t>(store.values(id_, mask)[0]);
  filter.body = static_cast<std::int32_t>(body_.id().slot);
  filter.self_collision = store.values(body_.id(), of_body)[0] != 0 && store.values(id_, own)[0] != 0;
  body_.world().bullet().set_filter(*rigid_, filter);
}

void Part::apply_report_contacts() {
  const bool wanted = body_.store().values(id_, table().at("report_contacts"))[0] != 0;
  if (wanted != state_.report_contacts) body_.world().sensing().contacts().set_reporting(wanted);
  state_.report_contacts = wanted;
}

}  // namespace limber::sim
