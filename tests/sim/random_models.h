// Random scenes for physical properties: trees and loops of all joint types and shapes, with motors and contacts. A
// scene is reproducible from its number, on every machine.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/hash.h"
#include "model/hull.h"
#include "model/mass_properties.h"
#include "sim/stage.h"

namespace limber::test {

/// Uniform numbers from a scene's number.
class SceneRandom {
 public:
  explicit SceneRandom(std::uint64_t number) : state_(number * 0x2545f4914f6cdd1du + 1) { splitmix64(state_); }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(splitmix64(state_) >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(splitmix64(state_) % static_cast<std::uint64_t>(count)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// Uniform exponent: 10^low .. 10^high.
  double decades(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  Vec3 within(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = within(1);
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
  const Vec3 v = from_bt(r.getLinearVelocity());
  const btVector3 spin = r.getAngularVelocity() * r.getWorldTransform().getBasis();
  const btVector3 local = r.getInvInertiaDiagLocal();
  double sum = glm::dot(v, v) / static_cast<double>(r.getInvMass());
  for (int i = 0; i < 3; i++) {
    const auto s = static_cast<double>(spin[i]);
    if (local[i] > 0) sum += s * s / static_cast<double>(local[i]);
  }
  return sum / 2;
}

/// Energy that neither a motor nor weight explains. A step changes velocities by impulses λ along J. Since
/// K(after) - K(before) = Σ λ·J·v(after) - ½ |v(after) - v(before)|² (weighed by mass), a step gains at most the work
/// that motors, springs and weight do at the velocities after it: locks, limits, contacts and friction do none there,
/// or take some. The account sums up what exceeds this bound. With restitution it takes the mean of the velocities
/// before and after instead, which makes the sum exact: a bounce gives back what the contact took. Call before() and
/// after() around single internal steps.
class EnergyAccount {
 public:
  explicit EnergyAccount(Stage& stage, bool mean = false) : stage_(stage), before_(mean ? 0.5 : 0) {}

  void before() {
    moving_.clear();
    for (const auto& body : stage_.world.bodies()) {
      for (const auto& part : body->parts()) {
        const btRigidBody& r = part->rigid();
        moving_.push_back({&r, r.getLinearVelocity(), r.getAngularVelocity(), kinetic_energy(r)});
      }
    }
    axes_.clear();
    for (const auto& body : stage_.world.bodies()) {
      for (const auto& motor : body->motors()) {
        const Joint& joint = motor->joint();
        const JointConstraint& c = joint.constraint();
        for (int axis = 0; axis < 6; axis++) {
          if (motor->mode(axis) == MotorMode::off) continue;
          const JointConstraint::Jacobian j = c.jacobian(axis);
          axes_.push_back({&c, axis, &joint.parent().rigid(), &joint.child().rigid(), j, 0, false, false});
          set_stops(axes_.back());
          axes_.back().rate = rate(axes_.back());
        }
      }
    }
  }

  void after() {
    const double h = stage_.h();
    const Vec3 gravity = stage_.vec(stage_.world.id(), "gravity");
    double change = 0;
    double kinetic = 0;
    double taken = 0;
    for (const Moving& m : moving_) {
      const double now = kinetic_energy(*m.part);
      kinetic += now;
      change += now - m.kinetic;
      if (m.part->getInvMass() == 0) continue;
      const Vec3 v = glm::mix(from_bt(m.part->getLinearVelocity()), from_bt(m.linear), before_);
      change -= glm::dot(gravity, v) * h / static_cast<double>(m.part->getInvMass());
    }
    for (const Axis& a : axes_) {
      const double load = a.axis < 3 ? a.joint->applied_force()[a.axis] : a.joint->applied_torque()[a.axis - 3];
      if (load < 0 ? a.at_lower : a.at_upper) continue;  // motor and stop hold each other: neither does work
      const double work = load * h * (before_ * a.rate + (1 - before_) * rate(a));
      change -= work;
      worked_ += std::fabs(work);
      taken += std::max(-work, 0.0);
    }
    rest_ += change;
    above_ += change - taken;
    least_ = std::min(least_, rest_);
    if (rest_ - least_ > created_) {
      created_ = rest_ - least_;
      created_at_ = stage_.world.time();
    }
    most_kinetic_ = std::max(most_kinetic_, kinetic);
    excess_ = std::max(excess_, above_);
  }

  /// The most that the unexplained energy grew above its least value so far, J; and when.
  double created() const { return created_; }
  double created_at() const { return created_at_; }
  /// The most that the energy ever was above that of the start and all that motors and weight have given since, J. What
  /// motors take counts as lost: where they strain against each other, they take what the repair of joints gives.
  double excess() const { return excess_; }
  /// Unexplained energy so far, J.
  double rest() const { return rest_; }
  double most_kinetic() const { return most_kinetic_; }
  /// Sum of the magnitudes of the motors' work, J.
  double worked() const { return worked_; }

 private:
  struct Moving {
    const btRigidBody* part;
    btVector3 linear, angular;
    double kinetic;
  };
  struct Axis {
    const JointConstraint* joint;
    int axis;
    const btRigidBody* parent;
    const btRigidBody* child;
    JointConstraint::Jacobian j;
    double rate;
    bool at_lower, at_upper;
  };
  static void set_stops(Axis& a) {
    constexpr double kNear = 1e-2;
    const AxisSettings& s = a.joint->axis(a.axis);
    a.at_lower = s.limited() && a.joint->value(a.axis) < static_cast<double>(s.lower) + kNear;
    a.at_upper = s.limited() && a.joint->value(a.axis) > static_cast<double>(s.upper) - kNear;
  }
  static double rate(const Axis& a) {
    return static_cast<double>(a.j.linear.dot(a.child->getLinearVelocity() - a.parent->getLinearVelocity()) +
                               a.j.angular_a.dot(a.parent->getAngularVelocity()) +
                               a.j.angular_b.dot(a.child->getAngularVelocity()));
  }

  Stage& stage_;
  double before_;  // share of the velocities before a step
  std::vector<Moving> moving_;
  std::vector<Axis> axes_;
  double rest_ = 0;
  double least_ = 0;
  double above_ = 0;
  double excess_ = 0;
  double created_ = 0;
  double created_at_ = 0;
  double most_kinetic_ = 0;
  double worked_ = 0;
};

/// What a random scene contains. Parts of it can be switched off to reduce a failure.
struct RandomPlan {
  bool contacts = true;
  bool motors = true;
  bool loops = true;
  bool iterative = true;  ///< Some scenes use the iterative solver.
  bool direct = true;     ///< False: all of them do.
};

/// A scene from its number: bodies, floor, motors. step() is one internal step.
class RandomScene : public Stage {
 public:
  explicit RandomScene(std::uint64_t number, const RandomPlan& plan = {}) : random_(number), plan_(plan) {
    set(world.id(), "timestep", {1.0 / 240});
    substeps(1);
    if (!random_.chance(0.1)) gravity({0, 0, -9.81});
    iterative_ = (random_.chance(0.08) && plan.iterative) || !plan.direct;
    if (iterative_) set(world.id(), "solver", {0});
    bouncing_ = random_.chance(0.15);
    wide_ = random_.chance(0.3);
    strong_ = random_.chance(0.4);
    const int count = 1 + random_.below(3);
    for (int i = 0; i < count; i++) add_robot(i);
    add_loose();
    if (random_.chance(0.6) && plan.contacts) {
      surface(part(Stage::body("floor"), plane_model(), 0,
                   {{0, 0, lowest_ - random_.uniform(0.25, 0.6)}, quat_identity()}));
    }
    if (!plan.contacts) {
      for (const auto& body : world.bodies()) set(body->id(), "self_collision", {0});
    }
  }

  void step() {
    if (world.tick() % 120 == 60 && renews_) aim();
    world.step();
  }

  bool iterative() const { return iterative_; }
  /// Whether contacts and limits give back a part of the speed.
  bool bounces() const { return bouncing_; }

  double joint_gap() const {
    double most = 0;
    for (const auto& body : world.bodies()) most = std::max(most, widest_gap(*body));
    return most;
  }

  bool finite() const {
    for (const double v : store.live()) {
      if (!std::isfinite(v)) return false;
    }
    return true;
  }

 private:
  ShapeModel hull() {
    std::vector<Vec3> points;
    for (int i = 0; i < 8 + random_.below(12); i++) points.push_back(random_.direction() * random_.uniform(0.06, 0.12));
    for (const double sign : {-1.0, 1.0}) {
      for (int i = 0; i < 3; i++)
        points.push_back(Vec3(i == 0 ? sign : 0, i == 1 ? sign : 0, i == 2 ? sign : 0) * 0.07);
    }
    const Hull made = convex_hull(points);
    auto mesh = std::make_shared<MeshModel>();
    mesh->vertices = mesh->hull = made.vertices;
    mesh->triangles = made.triangles;
    mesh->closed = true;
    mesh->solid = solid_of(made.vertices, made.triangles);
    ShapeModel m;
    m.kind = ShapeKind::mesh;
    m.mesh = mesh;
    return m;
  }

  ShapeModel simple() {
    ShapeModel m;
    switch (random_.below(6)) {
      case 0:
        return sphere_model(random_.uniform(0.03, 0.12));
      case 1:
        m.kind = ShapeKind::cylinder;
        break;
      case 2:
        m.kind = ShapeKind::capsule;
        break;
      case 3:
        m.kind = ShapeKind::cone;
        break;
      case 4:
        return hull();
      default:
        return box_model({random_.uniform(0.04, 0.2), random_.uniform(0.04, 0.2), random_.uniform(0.04, 0.3)});
    }
    m.radius = random_.uniform(0.03, 0.1);
    m.height = random_.uniform(0.05, 0.2);
    return m;
  }

  Shape& random_shape() {
    if (!random_.chance(0.1)) return shape(simple());
    ShapeModel m;
    m.kind = ShapeKind::compound;
    Shape& whole = shape(m);
    for (int i = 0; i < 2; i++) {
      EXPECT_TRUE(whole.add_child(shape(simple()), {random_.within(0.08), random_.rotation()}));
    }
    return whole;
  }

  double mass() { return wide_ ? random_.decades(-2, 2) : random_.decades(-0.5, 0.5); }

  void surface(Part& p) {
    // frictionless where it bounces: several impacts at once may not create energy
    set(p.id(), "friction", {bouncing_ ? 0 : random_.uniform(0, 1.5)});
    set(p.id(), "restitution", {bouncing_ ? 0.7 : 0});
    if (!bouncing_ && random_.chance(0.2)) set(p.id(), "rolling_friction", {0.01});
  }

  Part& add_part(Body& robot, const Pose& pose, double kg) {
    Part& made = *robot.add_part("p" + std::to_string(robot.parts().size()), random_shape(), kg, pose).value();
    surface(made);
    lowest_ = std::min(lowest_, pose.position.z);
    return made;
  }

  void add_robot(int number) {
    Body& robot = Stage::body("robot" + std::to_string(number));
    const Vec3 home(number * (plan_.contacts ? random_.uniform(0.2, 0.9) : 50), random_.uniform(-0.3, 0.3),
                    random_.uniform(0.6, 1.2));
    const bool fixed = random_.chance(0.4);
    add_part(robot, {home, random_.rotation()}, fixed ? 0 : mass());
    const int count = 1 + random_.below(random_.chance(0.2) ? 20 : 8);
    const bool chain = random_.chance(0.5);
    for (int i = 0; i < count; i++) {
      Part& parent = *robot.parts()[static_cast<std::size_t>(chain ? i : random_.below(i + 1))];
      const Vec3 to = parent.pose().position + random_.direction() * random_.uniform(0.03, 0.3);
      Part& child = add_part(robot, {to, random_.rotation()}, mass());
      add_joint(robot, parent, child);
    }
    const int loops = random_.chance(0.25) ? 1 + random_.below(2) : 0;
    for (int i = 0; i < loops && plan_.loops && count > 2; i++) {
      Part& a = *robot.parts()[static_cast<std::size_t>(random_.below(count))];
      Part& b = *robot.parts()[static_cast<std::size_t>(1 + random_.below(count))];
      if (&a != &b) add_joint(robot, a, b);
    }
    if (random_.chance(0.4)) set(robot.id(), "self_collision", {0});
    if (!fixed && random_.chance(0.3)) {
      const Vec3 v = random_.within(3);
      set(robot.id(), "linear_velocity", {v.x, v.y, v.z});
    }
  }

  void add_joint(Body& robot, Part& parent, Part& child) {
    constexpr std::array kTypes{JointType::revolute,  JointType::revolute, JointType::revolute, JointType::continuous,
                                JointType::prismatic, JointType::planar,   JointType::floating, JointType::spherical,
                                JointType::spherical, JointType::fixed};
    const JointType type = kTypes[static_cast<std::size_t>(random_.below(static_cast<int>(kTypes.size())))];
    const Vec3 place = (parent.pose().position + child.pose().position) / 2.0 + random_.within(0.05);
    Joint& joint =
        *robot.add_joint("j" + std::to_string(robot.joints().size()), parent, child, type, place, random_.direction())
             .value();
    for (int axis = 0; axis < 6; axis++) {
      const std::string half = axis < 3 ? "linear_" : "angular_";
      const auto i = static_cast<std::size_t>(axis % 3);
      const bool locked = get(joint.id(), half + "lower_limit")[i] == get(joint.id(), half + "upper_limit")[i];
      if (type == JointType::continuous || (locked && axis != joint.own_axis())) continue;
      // what slides freely in a plane is soon metres away
      if (!random_.chance(0.5) && !(type == JointType::planar && axis < 3)) continue;
      const double reach = axis < 3 ? 0.2 : type == JointType::spherical ? 0.8 : 1.5;
      set_one(joint.id(), half + "lower_limit", axis % 3, -random_.uniform(0.05, reach));
      set_one(joint.id(), half + "upper_limit", axis % 3, random_.uniform(0.05, reach));
    }
    if (type == JointType::fixed) return;
    Motor& motor = *robot.add_motor(joint).value();
    const int mode = plan_.motors ? random_.below(5) : 0;  // off, spin, servo, servo, spring
    const bool angular = type != JointType::prismatic;
    const std::string half = angular ? "angular_" : "linear_";
    if (type == JointType::revolute || type == JointType::continuous || type == JointType::prismatic) {
      set(motor.id(), "mode", {static_cast<double>(std::array{0, 1, 2, 2, 3}[static_cast<std::size_t>(mode)])});
    } else {
      // all open axes alike; only angular ones, or a servo would have to be told where a floating child is
      set(motor.id(), "mode", {0});
      const bool on = mode == 1 || mode == 2 || mode == 3;
      set(motor.id(), "angular_active", {on ? 1.0 : 0, on ? 1.0 : 0, on ? 1.0 : 0});
      set(motor.id(), "angular_servo_active",
          {mode > 1 && on ? 1.0 : 0, mode > 1 && on ? 1.0 : 0, mode > 1 && on ? 1.0 : 0});
      set(motor.id(), "angular_spring_active", {mode == 4 ? 1.0 : 0, mode == 4 ? 1.0 : 0, mode == 4 ? 1.0 : 0});
    }
    const double speed = random_.chance(0.3) ? 0 : random_.uniform(0.2, 6) * (angular ? 1 : 0.2);
    const double force = strong_ ? 10000 : random_.decades(-1, 3);
    const double stiffness = random_.decades(-1, 3);
    const double goal = random_.uniform(-1, 1) * (angular ? 1 : 0.1);
    const bool brief = random_.chance(0.3);
    set(motor.id(), half + "velocity", {speed, speed, speed});
    set(motor.id(), angular ? "max_angular_force" : "max_linear_force", {force, force, force});
    set(motor.id(), half + "servo_position", {goal, brief ? 0 : goal, goal});
    set(motor.id(), half + "spring_stiffness", {stiffness, stiffness, stiffness});
    set(motor.id(), half + "spring_damping", {brief ? 0.1 : 0, brief ? 0.1 : 0, brief ? 0.1 : 0});
    if (random_.chance(0.2)) set(motor.id(), "damping", {random_.decades(-3, 0)});
    if (bouncing_) set(motor.id(), "bounce", {0.7});
    motors_.push_back({&motor, half + "servo_position", angular ? 1 : 0.1});
  }

  void add_loose() {
    const int count = random_.chance(0.5) && plan_.contacts ? random_.below(5) : 0;
    for (int i = 0; i < count; i++) {
      Body& body = Stage::body("loose" + std::to_string(i));
      add_part(
          body,
          {Vec3(random_.uniform(-0.4, 1.2), random_.uniform(-0.4, 0.4), random_.uniform(0.5, 1.8)), random_.rotation()},
          mass());
    }
    renews_ = random_.chance(0.5);
  }

  void aim() {
    for (const Aimed& m : motors_) {
      const double goal = random_.uniform(-1, 1) * m.reach;
      set(m.motor->id(), m.row, {goal, goal, goal});
    }
  }

  struct Aimed {
    Motor* motor;
    std::string row;
    double reach;
  };
  SceneRandom random_;
  RandomPlan plan_;
  std::vector<Aimed> motors_;
  double lowest_ = 10;
  bool iterative_ = false;
  bool bouncing_ = false;
  bool wide_ = false;    // masses over four decades
  bool strong_ = false;  // motors with the default force
  bool renews_ = false;
};

/// What a played scene showed.
struct RandomOutcome {
  bool iterative = false;
  bool finite = true;
  double created = 0;  ///< EnergyAccount::created(), J.
  double created_at = 0;
  double excess = 0;  ///< EnergyAccount::excess(), J.
  double most_kinetic = 0;
  double worked = 0;
  double gap = 0;    ///< Largest joint gap, m.
  double speed = 0;  ///< Largest speed, m/s.
  std::uint64_t steps = 0;
  std::uint64_t fallbacks = 0;
  std::uint64_t health_events = 0;
  std::uint64_t hash = 0;
};

/// Overwrites the stack below, so that two runs that read uninitialized variables differ.
[[gnu::noinline]] inline void fill_stack(unsigned char byte) {
  volatile unsigned char room[1 << 15];
  for (volatile unsigned char& b : room) b = byte;
}

inline RandomOutcome play_random_scene(std::uint64_t number, unsigned char fill, double seconds = 2,
                                       const RandomPlan& plan = {}) {
  RandomScene scene(number, plan);
  scene.world.settle();
  EnergyAccount energy(scene, scene.bounces());
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
    out.health_events = scene.world.health_events();
    for (const auto& body : scene.world.bodies()) {
      for (const auto& part : body->parts()) out.speed = std::max(out.speed, glm::length(part->linear_velocity()));
    }
  }
  out.created = energy.created();
  out.created_at = energy.created_at();
  out.excess = energy.excess();
  out.most_kinetic = energy.most_kinetic();
  out.worked = energy.worked();
  out.fallbacks = static_cast<std::uint64_t>(scene.number(scene.world.id(), "solver_fallbacks"));
  out.hash = scene.world.state_hash();
  return out;
}

}  // namespace limber::test
