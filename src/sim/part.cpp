// Part: its rows, and the way between the link frame that users see and the frame that Bullet moves.
#include "sim/part.h"

#include <array>

#include <fmt/format.h>

#include "base/prefetch.h"
#include "sim/body.h"
#include "sim/contact_friction.h"
#include "sim/spin.h"
#include "sim/world.h"

namespace limber {

namespace {

using namespace rows;

// where the rows that every tick reads and writes lie in the live block
struct LiveRows {
  const Row* position;
  const Row* rotation;
  const Row* linear_velocity;
  const Row* angular_velocity;
};

const LiveRows& live_rows() {
  static const LiveRows found{&Part::table().at("position"), &Part::table().at("rotation"),
                              &Part::table().at("linear_velocity"), &Part::table().at("angular_velocity")};
  return found;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a list of entries
const Table& Part::table() {
  static const Table table(
      "part", "/physics/body/<body>/part/<part>", "/physics/part",
      {
          refuse<&Part::refuse_mass>(effect<&Part::effect_mass>(number(
              "mass", "kg", 1, 0.001, 1e6, "Mass; the inertia scales with it. A part made with mass 0 never moves."))),
          effect<&Part::effect_damping>(
              number("linear_damping", "1/s", 0, 0, 1, "Fraction of the velocity lost per second.")),
          effect<&Part::effect_damping>(
              number("angular_damping", "1/s", 0, 0, 1, "Fraction of the angular velocity lost per second.")),
          effect<&Part::effect_surface>(
              number("friction", "", 0.5, 0, 100, "Coulomb friction; the values of two touching parts multiply.")),
          effect<&Part::effect_surface>(number("rolling_friction", "m", 0, 0, 100,
                                               "Resistance to rolling; the values of two touching parts are mixed.")),
          effect<&Part::effect_surface>(number("spinning_friction", "m", 0, 0, 100,
                                               "Resistance to spinning about the contact's normal; mixed like rolling "
                                               "friction.")),
          effect<&Part::effect_surface>(
              vec3("friction_direction", "", {0, 0, 0}, -1, 1,
                   "Direction, link frame, in which friction is scaled by friction_factor; zeros: in none.")),
          effect<&Part::effect_surface>(number("friction_factor", "", 1, 0, 100,
                                               "Friction along friction_direction as a multiple of that across it.")),
          effect<&Part::effect_surface>(number("restitution", "", 0, 0, 1,
                                               "What a bounce gives back; the values of two touching parts multiply.")),
          effect<&Part::effect_collision>(
              boolean("self_collision", true, "Whether it collides with other parts of its body.")),
          effect<&Part::effect_collision>(
              integer("collision_group", 1, 0, 65535,
                      "The groups it is in, a bit each (16). Two parts collide if each one's group has a bit in the "
                      "other's mask.")),
          effect<&Part::effect_collision>(
              integer("collision_mask", 65535, 0, 65535, "The groups it collides with, a bit each (16).")),
          effect<&Part::effect_reports>(
              boolean("report_contacts", false, "Tell when this part begins to touch another.")),
          live(state(effect<&Part::effect_pose>(
              vec3("position", "m", {0, 0, 0}, -1e6, 1e6,
                   "Origin of the link frame, world. The stability check restores the body from 10 km on.")))),
          live(state(effect<&Part::effect_pose>(quat("rotation", "Link frame, world: x y z w.")))),
          live(state(effect<&Part::effect_velocity>(
              vec3("linear_velocity", "m/s", {0, 0, 0}, -1e4, 1e4,
                   "Velocity of the centre of mass, world. The stability check restores the body from 500 m/s on.")))),
          live(state(effect<&Part::effect_velocity>(
              vec3("angular_velocity", "rad/s", {0, 0, 0}, -1e4, 1e4,
                   "Angular velocity, world axes. The stability check restores the body from 1000 rad/s on, spin about "
                   "a driven joint's axis or a principal axis not counted, and from 20000 rad/s in any case.")))),
          view<&Part::read_center>(readout(vec3("center", "m", {0, 0, 0}, -1e6, 1e6, "Centre of mass, world."))),
          view<&Part::read_inertia>(readout(vec3("inertia", "kg·m²", {0, 0, 0}, 0, kUnbounded,
                                                 "Moments of inertia about the principal axes; static: 0."))),
          view<&Part::read_principal_axes>(
              readout(rows::quat("principal_axes", "Principal axes of inertia, world: x y z w."))),
          view<&Part::read_rotation_clamped>(
              readout(number("rotation_clamped", "rad/s", 0, 0, kUnbounded,
                             "Rotation held back in the last tick: clamped beyond π/4 per substep, spins about a "
                             "driven joint's axis or "
                             "a principal axis apart; 0: no clamp. More substeps lift it."))),
          act<&Part::act_force>(action("apply_force", 3, 6,
                                       "Force in N for one tick, world; at a world point, else the centre. The "
                                       "stability check restores what exceeds 500 m/s.")),
          act<&Part::act_impulse>(action("apply_impulse", 3, 6,
                                         "Impulse in N·s, world; at a world point, else the centre. The stability "
                                         "check restores what exceeds 500 m/s.")),
          act<&Part::act_torque>(action(
              "apply_torque", 3, 3,
              "Torque in N·m for one tick, world axes. The stability check restores what tumbles at 1000 rad/s.")),
      },
      &Part::fetch);
  return table;
}

Part::Part(Body& body, NodeId group, std::string name, std::shared_ptr<const Geometry> geometry, double mass,
           const Pose& pose)
    : body_(body),
      id_(body.store().add(table(), group, std::move(name), this)),
      load_(body.world().loads().add(*this)),
      geometry_(std::move(geometry)),
      is_static_(mass <= 0),
      start_(pose) {
  body_.store().tell(id_, table().at("mass"))[0] = is_static_ ? 0 : mass;
  const btVector3 inertia = is_static_ ? btVector3(0, 0, 0) : to_bt(geometry_->unit_inertia * mass);
  btRigidBody::btRigidBodyConstructionInfo info(is_static_ ? btScalar(0) : static_cast<btScalar>(mass), nullptr,
                                                geometry_->shape.get(), inertia);
  info.m_startWorldTransform = to_bt(pose * geometry_->frame);
  {
    const BulletMemory::Scope scope(&body_.world().bullet_memory());
    rigid_ = std::make_unique<btRigidBody>(info);
  }
  rigid_->setUserPointer(this);
  rigid_->setActivationState(DISABLE_DEACTIVATION);
  set_pose(pose);
  body_.world().solids().add(*this);
}

Part::~Part() {
  World& world = body_.world();
  if (reports_contacts()) world.contact_log().part_reports(false);
  world.contact_log().forget(*this);
  leave();
  world.loads().remove(load_);
  body_.store().remove(id_);
}

void Part::enter() {
  if (rigid_->isInWorld()) return;
  // it may have left while it slept
  rigid_->forceActivationState(DISABLE_DEACTIVATION);
  body_.world().bullet().addRigidBody(rigid_.get());
  body_.world().bullet().sleep().allow(*rigid_, body_.can_sleep());
}

void Part::leave() {
  if (rigid_->isInWorld()) body_.world().bullet().removeRigidBody(rigid_.get());
}

void Part::wake() {
  if (rigid_->isInWorld()) body_.world().bullet().sleep().wake(*rigid_);
}

const std::string& Part::name() const { return body_.store().name(id_); }

Pose Part::pose() const {
  const Store& store = body_.store();
  return {vec3_at(store.values(id_, *live_rows().position)), quat_at(store.values(id_, *live_rows().rotation))};
}

Vec3 Part::center() const { return pose() * geometry_->frame.position; }

double Part::mass() const {
  static const Row& row = table().at("mass");
  return body_.store().values(id_, row)[0];
}

Vec3 Part::linear_velocity() const { return vec3_at(body_.store().values(id_, *live_rows().linear_velocity)); }
Vec3 Part::angular_velocity() const { return vec3_at(body_.store().values(id_, *live_rows().angular_velocity)); }

void Part::set_pose(const Pose& pose) {
  Store& store = body_.store();
  store.keep(id_, *live_rows().position);
  store.keep(id_, *live_rows().rotation);
  put(store.tell(id_, *live_rows().position), pose.position);
  put(store.tell(id_, *live_rows().rotation), pose.rotation);
  store.mark(id_, *live_rows().position);
}

void Part::set_velocity(const Vec3& linear, const Vec3& angular) {
  Store& store = body_.store();
  store.keep(id_, *live_rows().linear_velocity);
  store.keep(id_, *live_rows().angular_velocity);
  put(store.tell(id_, *live_rows().linear_velocity), linear);
  put(store.tell(id_, *live_rows().angular_velocity), angular);
  store.mark(id_, *live_rows().linear_velocity);
}

Part::Stance Part::stance() const {
  return {pose(),
          linear_velocity(),
          angular_velocity(),
          rigid_->getWorldTransform(),
          rigid_->getLinearVelocity(),
          rigid_->getAngularVelocity()};
}

void Part::stand(const Stance& stance) {
  // past the marks: what the store tells of a pose has gone through a quaternion
  double* const live = body_.store().live_block(id_);
  put(live + live_rows().position->offset, stance.pose.position);
  put(live + live_rows().rotation->offset, stance.pose.rotation);
  put(live + live_rows().linear_velocity->offset, stance.linear_velocity);
  put(live + live_rows().angular_velocity->offset, stance.angular_velocity);
  rigid_->setWorldTransform(stance.transform);
  rigid_->setInterpolationWorldTransform(stance.transform);
  rigid_->setLinearVelocity(stance.linear);
  rigid_->setAngularVelocity(stance.angular);
  rigid_->updateInertiaTensor();
}

void Part::keep() {
  WorldUndo& undo = body_.world().undo();
  if (undo.active()) undo.keep(*this);
}

void Part::settle() {
  WorldUndo& undo = body_.world().undo();
  if (!undo.active()) return body_.store().apply_marks();
  undo.keep_motion(*this);
  body_.store().apply_marks(id_);
}

void Part::apply_force(const Vec3& force) {
  keep();
  body_.world().loads().load(load_).force += force;
}

void Part::apply_torque(const Vec3& torque) {
  keep();
  body_.world().loads().load(load_).torque += torque;
}

void Part::apply_impulse(const Vec3& impulse) {
  keep();
  body_.world().loads().kick(load_).impulse += impulse;
}

void Part::apply_force_at(const Vec3& force, const Vec3& at) {
  apply_force(force);
  apply_torque(glm::cross(at - center(), force));
}

void Part::apply_impulse_at(const Vec3& impulse, const Vec3& at) {
  apply_impulse(impulse);
  body_.world().loads().kick(load_).angular_impulse += glm::cross(at - center(), impulse);
}

void Part::clear_forces() {
  keep();
  body_.world().loads().clear(load_);
}

void Part::push(const PartLoads::Load& load, const PartLoads::Kick& kick) {
  if (is_static_ || !rigid_->isInWorld()) return;
  const Vec3 none(0);
  if (load.force == none && load.torque == none && kick.impulse == none && kick.angular_impulse == none) return;
  wake();
  // more than any part stands, but a number still: what is none would spread to all that the part touches
  const Vec3 most(1e15);
  const auto tamed = [&](const Vec3& v) { return to_bt(glm::clamp(v, -most, most)); };
  rigid_->applyCentralForce(tamed(load.force));
  rigid_->applyTorque(tamed(load.torque));
  rigid_->applyCentralImpulse(tamed(kick.impulse));
  rigid_->applyTorqueImpulse(tamed(kick.angular_impulse));
}

void Part::tell() {
  double* const live = body_.store().live_block(id_);
  const LiveRows& rows = live_rows();
  const Pose pose = from_bt(rigid_->getWorldTransform()) * geometry_->frame.inverse();
  put(live + rows.position->offset, pose.position);
  put(live + rows.rotation->offset, pose.rotation);
  put(live + rows.linear_velocity->offset, from_bt(rigid_->getLinearVelocity()));
  put(live + rows.angular_velocity->offset, from_bt(rigid_->getAngularVelocity()));
}

bool Part::reports_contacts() const { return reports_; }

// what Bullet has of a part, all of which its effects look at here and there
void Part::fetch(const void* thing) { prefetch(static_cast<const Part*>(thing)->rigid_.get(), sizeof(btRigidBody)); }

void Part::effect_mass() {
  static const Row& row = table().at("mass");
  if (is_static_) return;
  const double mass = body_.store().values(id_, row)[0];
  const btScalar before = rigid_->getInvMass();
  rigid_->setMassProps(static_cast<btScalar>(mass), to_bt(geometry_->unit_inertia * mass));
  rigid_->updateInertiaTensor();
  // Bullet keeps gravity as a force, which was made with the old mass
  rigid_->setGravity(body_.world().bullet().getGravity());
  if (rigid_->getInvMass() != before) wake();
}

void Part::effect_damping() {
  static const Row& linear = table().at("linear_damping");
  static const Row& angular = table().at("angular_damping");
  const Store& store = body_.store();
  const std::array<btScalar, 2> before{rigid_->getLinearDamping(), rigid_->getAngularDamping()};
  rigid_->setDamping(static_cast<btScalar>(store.values(id_, linear)[0]),
                     static_cast<btScalar>(store.values(id_, angular)[0]));
  if (before != std::array<btScalar, 2>{rigid_->getLinearDamping(), rigid_->getAngularDamping()}) wake();
}

void Part::effect_surface() {
  static const Row& friction = table().at("friction");
  static const Row& rolling = table().at("rolling_friction");
  static const Row& spinning = table().at("spinning_friction");
  static const Row& direction = table().at("friction_direction");
  static const Row& factor = table().at("friction_factor");
  static const Row& bounce = table().at("restitution");
  const Store& store = body_.store();
  const auto surface = [this] {
    return std::array<btScalar, 3>{rigid_->getFriction(), rigid_->getRollingFriction(), rigid_->getRestitution()};
  };
  const std::array<btScalar, 3> before = surface();
  rigid_->setFriction(static_cast<btScalar>(store.values(id_, friction)[0]));
  rigid_->setRollingFriction(static_cast<btScalar>(store.values(id_, rolling)[0]));
  rigid_->setSpinningFriction(static_cast<btScalar>(store.values(id_, spinning)[0]));
  const Vec3 in_link = vec3_at(store.values(id_, direction));
  set_friction_direction(*rigid_, to_bt(glm::inverse(geometry_->frame.rotation) * in_link),
                         static_cast<btScalar>(store.values(id_, factor)[0]));
  const auto restitution = static_cast<btScalar>(store.values(id_, bounce)[0]);
  rigid_->setRestitution(restitution);
  if (surface() != before) wake();
  // what bounces must not be braked before it touches: Bullet's contacts ahead would eat a part of the bounce
  const btScalar ahead = restitution > 0 && !is_static_ ? btScalar(0) : btScalar(BT_LARGE_FLOAT);
  if (rigid_->getContactProcessingThreshold() == ahead) return;
  rigid_->setContactProcessingThreshold(ahead);
  // contacts keep the threshold that they were made with
  IslandWorld& bullet = body_.world().bullet();
  if (!rigid_->isInWorld()) return;
  bullet.getPairCache()->cleanProxyFromPairs(rigid_->getBroadphaseHandle(), bullet.getDispatcher());
}

void Part::effect_pose() {
  const btTransform t = to_bt(pose() * geometry_->frame);
  if (!is_static_ || !(t == rigid_->getWorldTransform())) wake();
  rigid_->setWorldTransform(t);
  rigid_->setInterpolationWorldTransform(t);
  rigid_->updateInertiaTensor();
  body_.note_moved();
}

void Part::effect_velocity() {
  if (is_static_) {
    if (linear_velocity() != Vec3(0) || angular_velocity() != Vec3(0)) {
      body_.report_static_velocity(fmt::format("part '{}' is", name()));
    }
    return;
  }
  const bool changes = to_bt(linear_velocity()) != rigid_->getLinearVelocity() ||
                       to_bt(angular_velocity()) != rigid_->getAngularVelocity();
  if (changes) wake();
  rigid_->setLinearVelocity(to_bt(linear_velocity()));
  rigid_->setAngularVelocity(to_bt(angular_velocity()));
}

void Part::effect_collision() {
  static const Row& group = table().at("collision_group");
  static const Row& mask = table().at("collision_mask");
  static const Row& own = table().at("self_collision");
  const Store& store = body_.store();
  CollisionFilter filter;
  filter.group = static_cast<std::uint16_t>(store.values(id_, group)[0]);
  filter.mask = static_cast<std::uint16_t>(store.values(id_, mask)[0]);
  filter.body = static_cast<std::int32_t>(body_.id().slot);
  filter.self_collision = body_.self_collision() && store.values(id_, own)[0] != 0;
  body_.world().bullet().set_filter(*rigid_, filter);
}

void Part::effect_reports() {
  const bool wanted = body_.store().values(id_, table().at("report_contacts"))[0] != 0;
  if (wanted != reports_) body_.world().contact_log().part_reports(wanted);
  reports_ = wanted;
}

void Part::read_center(double* out) const { put(out, center()); }
void Part::read_inertia(double* out) const {
  put(out, geometry_->unit_inertia * body_.store().values(id_, table().at("mass"))[0]);
}
void Part::read_principal_axes(double* out) const { put(out, principal_axes()); }
void Part::read_rotation_clamped(double* out) const { out[0] = clamped_by(*rigid_); }

Result<void> Part::refuse_mass(const double*) const {
  if (!is_static_) return {};
  return Error{"it was made with mass 0 and never moves; make it with a mass instead"};
}

Result<void> Part::act_force(std::span<const double> a) {
  if (a.size() == 3) {
    apply_force(vec3_at(a.data()));
  } else if (a.size() == 6) {
    apply_force_at(vec3_at(a.data()), vec3_at(a.data() + 3));
  } else {
    return Error{fmt::format("takes 3 numbers, or 6 with a point, not {}", a.size())};
  }
  return {};
}

Result<void> Part::act_impulse(std::span<const double> a) {
  if (a.size() == 3) {
    apply_impulse(vec3_at(a.data()));
  } else if (a.size() == 6) {
    apply_impulse_at(vec3_at(a.data()), vec3_at(a.data() + 3));
  } else {
    return Error{fmt::format("takes 3 numbers, or 6 with a point, not {}", a.size())};
  }
  return {};
}

Result<void> Part::act_torque(std::span<const double> a) {
  apply_torque(vec3_at(a.data()));
  return {};
}

}  // namespace limber
