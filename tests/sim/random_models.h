// Random scenes for physical properties: trees and loops of all joint types and shapes, with motors and contacts. A
// scene is reproducible from its number, on every machine.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/hash.h"
#include "model/mesh/hull.h"
#include "model/mesh/mass_properties.h"
#include "sim/bullet/bullet.h"
#include "sim/bullet/joints/joint_constraint.h"
#include "sim/stage.h"

namespace limber::sim::test {

/// Random generator seeded with the number of a scene.
class SceneRandom {
 public:
  explicit SceneRandom(std::uint64_t number) : state_(number * 0x2545f4914f6cdd1du + 1) { splitmix64(state_); }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(splitmix64(state_) >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(splitmix64(state_) % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// Uniform exponent: 10^low .. 10^high.
  double log_uniform(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  Vec3 in_cube(double range) { return {uniform(-range, range), uniform(-range, range), uniform(-range, range)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in_cube(1);
      const double length = glm::length(v);
      if (length > 0.1 && length <= 1) return v / length;
    }
  }
  Quat rotation() { return quat_axis(direction(), uniform(-kPi, kPi)); }

 private:
  std::uint64_t state_;
};

/// Kinetic energy of a part at its present velocity, J.
inline double kinetic_energy(const btRigidBody& r) {
  if (r.getInvMass() == 0) return 0;
  const Vec3 v = bullet::from_bt(r.getLinearVelocity());
  const btVector3 spin = r.getAngularVelocity() * r.getWorldTransform().getBasis();
  const btVector3 local = r.getInvInertiaDiagLocal();
  double sum = glm::dot(v, v) / static_cast<double>(r.getInvMass());
  for (int i = 0; i < 3; i++) {
    const auto s = static_cast<double>(spin[i]);
    if (local[i] > 0) sum += s * s / static_cast<double>(local[i]);
  }
  return sum / 2;
}

/// Energy that neither motors nor gravity explain. A step changes velocities by impulses λ along J. Since K(after) -
/// K(before) = Σ λ·J·v(after) - ½ |v(after) - v(before)|² (in the norm of the mass matrix), a step gains at most the
/// work of motors, springs and gravity at the velocities after it: there locks, limits, contacts and friction do no or
/// negative work. The account sums up the excess over this bound. With restitution it uses the mean of the velocities
/// before and after instead, which makes the sum exact, because a bounce returns energy that the contact absorbed. Call
/// before() and after() around single substeps.
class EnergyAccount {
 public:
  explicit EnergyAccount(WorldFixture& fixture, bool mean = false) : fixture_(fixture), before_share_(mean ? 0.5 : 0) {}

  void before() {
    moving_.clear();
    for (const auto& body : fixture_.world.bodies()) {
      for (const auto& part : body->parts()) {
        const btRigidBody& r = part->rigid();
        moving_.push_back({&r, r.getLinearVelocity(), r.getAngularVelocity(), kinetic_energy(r)});
      }
    }
    axes_.clear();
    for (const auto& body : fixture_.world.bodies()) {
      for (const auto& motor : body->motors()) {
        const Joint& joint = motor->joint();
        const bullet::JointConstraint& c = joint.constraint();
        for (int axis = 0; axis < 6; axis++) {
          if (motor->mode(axis) == MotorMode::off) continue;
          const bullet::AxisJacobian j = c.pose().jacobian(axis);
          axes_.push_back({&c, axis, &joint.parent().rigid(), &joint.child().rigid(), j, 0, false, false});
          set_stops(axes_.back());
          axes_.back().rate = rate(axes_.back());
        }
      }
    }
  }

  void after() {
    const double h = fixture_.h();
    const Vec3 gravity = fixture_.vec(fixture_.world.id(), "gravity");
    double change = 0;
    double kinetic = 0;
    double absorbed = 0;
    for (const Moving& m : moving_) {
      const double now = kinetic_energy(*m.part);
      kinetic += now;
      change += now - m.kinetic;
      if (m.part->getInvMass() == 0) continue;
      const Vec3 v = glm::mix(bullet::from_bt(m.part->getLinearVelocity()), bullet::from_bt(m.linear), before_share_);
      change -= glm::dot(gravity, v) * h / static_cast<double>(m.part->getInvMass());
    }
    for (const Axis& a : axes_) {
      const double load =
          a.axis < 3 ? a.joint->drives().applied_force()[a.axis] : a.joint->drives().applied_torque()[a.axis - 3];
      if (load < 0 ? a.at_lower : a.at_upper) continue;  // the motor presses against its limit: neither does work
      const double work = load * h * (before_share_ * a.rate + (1 - before_share_) * rate(a));
      change -= work;
      absolute_work_ += std::fabs(work);
      absorbed += std::max(-work, 0.0);
    }
    unexplained_ += change;
    net_energy_ += change - absorbed;
    minimum_ = std::min(minimum_, unexplained_);
    if (unexplained_ - minimum_ > created_) {
      created_ = unexplained_ - minimum_;
      created_at_ = fixture_.world.time();
    }
    max_kinetic_ = std::max(max_kinetic_, kinetic);
    excess_ = std::max(excess_, net_energy_);
  }

  /// Largest increase of the unexplained energy above its minimum so far, J; and its time.
  double created() const { return created_; }
  double created_at() const { return created_at_; }
  /// Largest excess of the energy over that of the start plus all positive work of motors and gravity since, J.
  /// Negative work of motors counts as lost: motors that press against each other absorb energy that the repair of
  /// joints adds.
  double excess() const { return excess_; }
  /// Unexplained energy so far, J.
  double unexplained() const { return unexplained_; }
  double max_kinetic() const { return max_kinetic_; }
  /// Sum of the magnitudes of the motors' work, J.
  double absolute_work() const { return absolute_work_; }

 private:
  struct Moving {
    const btRigidBody* part;
    btVector3 linear, angular;
    double kinetic;
  };
  struct Axis {
    const bullet::JointConstraint* joint;
    int axis;
    const btRigidBody* parent;
    const btRigidBody* child;
    bullet::AxisJacobian j;
    double rate;
    bool at_lower, at_upper;
  };
  static void set_stops(Axis& a) {
    constexpr double kNear = 1e-2;
    const bullet::AxisSettings& s = a.joint->axis(a.axis);
    a.at_lower = s.limited() && a.joint->value(a.axis) < static_cast<double>(s.lower) + kNear;
    a.at_upper = s.limited() && a.joint->value(a.axis) > static_cast<double>(s.upper) - kNear;
  }
  static double rate(const Axis& a) {
    return static_cast<double>(a.j.linear.dot(a.child->getLinearVelocity() - a.parent->getLinearVelocity()) +
                               a.j.angular_a.dot(a.parent->getAngularVelocity()) +
                               a.j.angular_b.dot(a.child->getAngularVelocity()));
  }

  WorldFixture& fixture_;
  double before_share_;  // share of the velocities before a step
  std::vector<Moving> moving_;
  std::vector<Axis> axes_;
  double unexplained_ = 0;
  double minimum_ = 0;
  double net_energy_ = 0;
  double excess_ = 0;
  double created_ = 0;
  double created_at_ = 0;
  double max_kinetic_ = 0;
  double absolute_work_ = 0;
};

/// Contents of a random scene. Features can be switched off to reduce a failure.
struct RandomSceneOptions {
  bool contacts = true;
  bool motors = true;
  bool loops = true;
  bool iterative = true;  ///< Some scenes use the iterative solver.
  bool direct = true;     ///< False: all scenes use the iterative solver.
};

/// The scene with a given number: bodies, floor, motors. step() is one substep.
class RandomScene : public WorldFixture {
 public:
  explicit RandomScene(std::uint64_t number, const RandomSceneOptions& options = {})
      : random_(number), options_(options) {
    set(world.id(), "timestep", {1.0 / 240});
    substeps(1);
    if (!random_.chance(0.1)) gravity({0, 0, -9.81});
    iterative_ = (random_.chance(0.08) && options.iterative) || !options.direct;
    if (iterative_) set(world.id(), "solver", {0});
    has_restitution_ = random_.chance(0.15);
    unequal_masses_ = random_.chance(0.3);
    strong_motors_ = random_.chance(0.4);
    const int count = 1 + random_.below(3);
    for (int i = 0; i < count; i++) add_robot(i);
    add_single_bodies();
    if (random_.chance(0.6) && options.contacts) {
      set_surface(part(WorldFixture::body("floor"), plane_model(), 0,
                       {{0, 0, lowest_height_ - random_.uniform(0.25, 0.6)}, quat_identity()}));
    }
    if (!options.contacts) {
      for (const auto& body : world.bodies()) set(body->id(), "self_collision", {0});
    }
  }

  void step() {
    if (world.tick() % 120 == 60 && changes_targets_) randomize_targets();
    world.step();
  }

  bool iterative() const { return iterative_; }
  /// True if contacts and limits have restitution.
  bool has_restitution() const { return has_restitution_; }

  double joint_gap() const {
    double widest = 0;
    for (const auto& body : world.bodies()) widest = std::max(widest, widest_gap(*body));
    return widest;
  }

  bool finite() const {
    for (const double v : store.transient_values()) {
      if (!std::isfinite(v)) return false;
    }
    return true;
  }

 private:
  model::ShapeModel random_hull() {
    std::vector<Vec3> points;
    for (int i = 0; i < 8 + random_.below(12); i++) points.push_back(random_.direction() * random_.uniform(0.06, 0.12));
    for (const double sign : {-1.0, 1.0}) {
      for (int i = 0; i < 3; i++)
        points.push_back(Vec3(i == 0 ? sign : 0, i == 1 ? sign : 0, i == 2 ? sign : 0) * 0.07);
    }
    const model::Hull made = model::convex_hull(points);
    auto mesh = std::make_shared<model::MeshModel>();
    mesh->vertices = mesh->hull = made.vertices;
    mesh->triangles = made.triangles;
    mesh->closed = true;
    mesh->unit_inertial = model::unit_inertial_of(made.vertices, made.triangles);
    model::ShapeModel m;
    m.kind = model::ShapeKind::mesh;
    m.mesh = mesh;
    return m;
  }

  model::ShapeModel random_simple_shape() {
    model::ShapeModel m;
    switch (random_.below(6)) {
      case 0:
        return sphere_model(random_.uniform(0.03, 0.12));
      case 1:
        m.kind = model::ShapeKind::cylinder;
        break;
      case 2:
        m.kind = model::ShapeKind::capsule;
        break;
      case 3:
        m.kind = model::ShapeKind::cone;
        break;
      case 4:
        return random_hull();
      default:
        return box_model({random_.uniform(0.04, 0.2), random_.uniform(0.04, 0.2), random_.uniform(0.04, 0.3)});
    }
    m.radius = random_.uniform(0.03, 0.1);
    m.height = random_.uniform(0.05, 0.2);
    return m;
  }

  Shape& random_shape() {
    if (!random_.chance(0.1)) return shape(random_simple_shape());
    model::ShapeModel m;
    m.kind = model::ShapeKind::compound;
    Shape& whole = shape(m);
    for (int i = 0; i < 2; i++) {
      EXPECT_TRUE(whole.add_child(shape(random_simple_shape()), {random_.in_cube(0.08), random_.rotation()}));
    }
    return whole;
  }

  double mass() { return unequal_masses_ ? random_.log_uniform(-2, 2) : random_.log_uniform(-0.5, 0.5); }

  void set_surface(Part& p) {
    // frictionless if it bounces: several simultaneous impacts must not create energy
    set(p.id(), "friction", {has_restitution_ ? 0 : random_.uniform(0, 1.5)});
    set(p.id(), "restitution", {has_restitution_ ? 0.7 : 0});
    if (!has_restitution_ && random_.chance(0.2)) set(p.id(), "rolling_friction", {0.01});
  }

  Part& add_part(Body& robot, const Pose& pose, double kg) {
    Part& made = *robot.add_part("p" + std::to_string(robot.parts().size()), random_shape(), kg, pose).value();
    set_surface(made);
    lowest_height_ = std::min(lowest_height_, pose.position.z);
    return made;
  }

  void add_robot(int number) {
    Body& robot = WorldFixture::body("robot" + std::to_string(number));
    const Vec3 origin(number * (options_.contacts ? random_.uniform(0.2, 0.9) : 50), random_.uniform(-0.3, 0.3),
                      random_.uniform(0.6, 1.2));
    const bool fixed = random_.chance(0.4);
    add_part(robot, {origin, random_.rotation()}, fixed ? 0 : mass());
    const int count = 1 + random_.below(random_.chance(0.2) ? 20 : 8);
    const bool chain = random_.chance(0.5);
    for (int i = 0; i < count; i++) {
      Part& parent = *robot.parts()[static_cast<std::size_t>(chain ? i : random_.below(i + 1))];
      const Vec3 position = parent.pose().position + random_.direction() * random_.uniform(0.03, 0.3);
      Part& child = add_part(robot, {position, random_.rotation()}, mass());
      add_joint(robot, parent, child);
    }
    const int loops = random_.chance(0.25) ? 1 + random_.below(2) : 0;
    for (int i = 0; i < loops && options_.loops && count > 2; i++) {
      Part& a = *robot.parts()[static_cast<std::size_t>(random_.below(count))];
      Part& b = *robot.parts()[static_cast<std::size_t>(1 + random_.below(count))];
      if (&a != &b) add_joint(robot, a, b);
    }
    if (random_.chance(0.4)) set(robot.id(), "self_collision", {0});
    if (!fixed && random_.chance(0.3)) {
      const Vec3 v = random_.in_cube(3);
      set(robot.id(), "linear_velocity", {v.x, v.y, v.z});
    }
  }

  void add_joint(Body& robot, Part& parent, Part& child) {
    constexpr std::array kTypes{model::JointType::revolute,   model::JointType::revolute,  model::JointType::revolute,
                                model::JointType::continuous, model::JointType::prismatic, model::JointType::planar,
                                model::JointType::floating,   model::JointType::spherical, model::JointType::spherical,
                                model::JointType::fixed};
    const model::JointType type = kTypes[static_cast<std::size_t>(random_.below(static_cast<int>(kTypes.size())))];
    const Vec3 place = (parent.pose().position + child.pose().position) / 2.0 + random_.in_cube(0.05);
    Joint& joint =
        *robot.add_joint("j" + std::to_string(robot.joints().size()), parent, child, type, place, random_.direction())
             .value();
    for (int axis = 0; axis < 6; axis++) {
      const std::string prefix = axis < 3 ? "linear_" : "angular_";
      const auto i = static_cast<std::size_t>(axis % 3);
      const bool locked = get(joint.id(), prefix + "lower_limit")[i] == get(joint.id(), prefix + "upper_limit")[i];
      if (type == model::JointType::continuous || (locked && axis != joint.own_axis())) continue;
      // a free planar slider is soon meters away
      if (!random_.chance(0.5) && !(type == model::JointType::planar && axis < 3)) continue;
      const double range = axis < 3 ? 0.2 : type == model::JointType::spherical ? 0.8 : 1.5;
      set_one(joint.id(), prefix + "lower_limit", axis % 3, -random_.uniform(0.05, range));
      set_one(joint.id(), prefix + "upper_limit", axis % 3, random_.uniform(0.05, range));
    }
    if (type == model::JointType::fixed) return;
    Motor& motor = *robot.add_motor(joint).value();
    const int mode = options_.motors ? random_.below(5) : 0;  // off, spin, servo, servo, spring
    const bool angular = type != model::JointType::prismatic;
    const std::string prefix = angular ? "angular_" : "linear_";
    if (type == model::JointType::revolute || type == model::JointType::continuous ||
        type == model::JointType::prismatic) {
      set(motor.id(), "mode", {static_cast<double>(std::array{0, 1, 2, 2, 3}[static_cast<std::size_t>(mode)])});
    } else {
      // all open axes alike; angular ones only, because a floating child's servo target would have to be its position
      set(motor.id(), "mode", {0});
      const bool on = mode == 1 || mode == 2 || mode == 3;
      set(motor.id(), "angular_active", {on ? 1.0 : 0, on ? 1.0 : 0, on ? 1.0 : 0});
      set(motor.id(), "angular_servo_active",
          {mode > 1 && on ? 1.0 : 0, mode > 1 && on ? 1.0 : 0, mode > 1 && on ? 1.0 : 0});
      set(motor.id(), "angular_spring_active", {mode == 4 ? 1.0 : 0, mode == 4 ? 1.0 : 0, mode == 4 ? 1.0 : 0});
    }
    const double speed = random_.chance(0.3) ? 0 : random_.uniform(0.2, 6) * (angular ? 1 : 0.2);
    const double force = strong_motors_ ? 10000 : random_.log_uniform(-1, 3);
    const double stiffness = random_.log_uniform(-1, 3);
    const double goal = random_.uniform(-1, 1) * (angular ? 1 : 0.1);
    const bool damped = random_.chance(0.3);
    set(motor.id(), prefix + "velocity", {speed, speed, speed});
    set(motor.id(), angular ? "max_angular_force" : "max_linear_force", {force, force, force});
    set(motor.id(), prefix + "servo_position", {goal, damped ? 0 : goal, goal});
    set(motor.id(), prefix + "spring_stiffness", {stiffness, stiffness, stiffness});
    set(motor.id(), prefix + "spring_damping", {damped ? 0.1 : 0, damped ? 0.1 : 0, damped ? 0.1 : 0});
    if (random_.chance(0.2)) set(motor.id(), "damping", {random_.log_uniform(-3, 0)});
    if (has_restitution_) set(motor.id(), "bounce", {0.7});
    motors_.push_back({&motor, prefix + "servo_position", angular ? 1 : 0.1});
  }

  void add_single_bodies() {
    const int count = random_.chance(0.5) && options_.contacts ? random_.below(5) : 0;
    for (int i = 0; i < count; i++) {
      Body& body = WorldFixture::body("loose" + std::to_string(i));
      add_part(
          body,
          {Vec3(random_.uniform(-0.4, 1.2), random_.uniform(-0.4, 0.4), random_.uniform(0.5, 1.8)), random_.rotation()},
          mass());
    }
    changes_targets_ = random_.chance(0.5);
  }

  void randomize_targets() {
    for (const DrivenMotor& m : motors_) {
      const double goal = random_.uniform(-1, 1) * m.range;
      set(m.motor->id(), m.property, {goal, goal, goal});
    }
  }

  struct DrivenMotor {
    Motor* motor;
    std::string property;
    double range;
  };
  SceneRandom random_;
  RandomSceneOptions options_;
  std::vector<DrivenMotor> motors_;
  double lowest_height_ = 10;
  bool iterative_ = false;
  bool has_restitution_ = false;
  bool unequal_masses_ = false;  // masses span four decades
  bool strong_motors_ = false;   // motors with the default force
  bool changes_targets_ = false;
};

/// Results of a played scene.
struct RandomOutcome {
  bool iterative = false;
  bool finite = true;
  double created = 0;  ///< EnergyAccount::created(), J.
  double created_at = 0;
  double excess = 0;  ///< EnergyAccount::excess(), J.
  double max_kinetic = 0;
  double absolute_work = 0;
  double gap = 0;    ///< Largest joint gap, m.
  double speed = 0;  ///< Largest speed, m/s.
  std::uint64_t steps = 0;
  std::uint64_t fallbacks = 0;
  std::uint64_t health_events = 0;
  std::uint64_t hash = 0;
};

/// Overwrites the stack below, so that two runs that read uninitialized variables differ.
[[gnu::noinline]] inline void fill_stack(unsigned char byte) {
  volatile unsigned char buffer[1 << 15];
  for (volatile unsigned char& b : buffer) b = byte;
}

inline RandomOutcome play_random_scene(std::uint64_t number, unsigned char fill, double seconds = 2,
                                       const RandomSceneOptions& options = {}) {
  RandomScene scene(number, options);
  scene.world.flush();
  EnergyAccount energy(scene, scene.has_restitution());
  RandomOutcome out;
  out.iterative = scene.iterative();
  const auto steps = static_cast<std::uint64_t>(std::lround(seconds * 240));
  for (; out.steps < steps && out.finite && out.health_events == 0; out.steps++) {
    fill_stack(fill);
    energy.before();
    scene.step();
    energy.after();
    out.finite = scene.finite();
    out.gap = std::max(out.gap, scene.joint_gap());
    out.health_events = scene.world.stability().events();
    for (const auto& body : scene.world.bodies()) {
      for (const auto& part : body->parts()) out.speed = std::max(out.speed, glm::length(part->linear_velocity()));
    }
  }
  out.created = energy.created();
  out.created_at = energy.created_at();
  out.excess = energy.excess();
  out.max_kinetic = energy.max_kinetic();
  out.absolute_work = energy.absolute_work();
  out.fallbacks = static_cast<std::uint64_t>(scene.number(scene.world.id(), "solver_fallbacks"));
  out.hash = scene.world.state_hash();
  return out;
}

}  // namespace limber::sim::test
