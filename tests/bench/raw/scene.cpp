// RawScene: two implementations, stock Bullet with its six-axis spring joint, and an IslandWorld with our joints.
#include "bench/raw/scene.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/memory/prefetch.h"
#include "sim/bullet/island_world.h"
#include "sim/bullet/joints/joint_constraint.h"

namespace limber {
namespace {

constexpr int kGround = 1;
constexpr int kPart = 2;

// The common part of both kinds of world: the rigid bodies.
template <class World>
class BasicSimulation : public RawSimulation {
 public:
  explicit BasicSimulation(const RawScene& raw) : scene(raw) {}
  Pose pose(int part) const override {
    return sim::bullet::from_bt(bodies[static_cast<std::size_t>(part)]->getWorldTransform());
  }

  RawEnergy energy() const override {
    RawEnergy sum;
    for (const auto& body : bodies) {
      if (body->isStaticObject()) continue;
      const double mass = 1 / static_cast<double>(body->getInvMass());
      const Vec3 v = sim::bullet::from_bt(body->getLinearVelocity());
      const Vec3 spin =
          sim::bullet::from_bt(body->getWorldTransform().getBasis().transpose() * body->getAngularVelocity());
      const Vec3 inverse = sim::bullet::from_bt(body->getInvInertiaDiagLocal());
      sum.potential -= mass * glm::dot(scene.gravity, sim::bullet::from_bt(body->getWorldTransform().getOrigin()));
      sum.kinetic += mass * glm::dot(v, v) / 2;
      for (int i = 0; i < 3; ++i) sum.kinetic += spin[i] * spin[i] / inverse[i] / 2;
    }
    return sum;
  }

 protected:
  void build(World& world) {
    world.setGravity(sim::bullet::to_bt(scene.gravity));
    world.getSolverInfo().m_numIterations = scene.iterations;
    world.getSolverInfo().m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
    world.getSolverInfo().m_splitImpulse = 1;
    world.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
    for (const RawPart& part : scene.parts) add_part(world, part);
    if (!scene.floor) return;
    floor = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
    floor->setFriction(1);
    world.addRigidBody(floor.get(), kGround, -1);
  }
  void add_part(World& world, const RawPart& part) {
    if (part.size.y > 0) {
      shapes.push_back(std::make_unique<btBoxShape>(sim::bullet::to_bt(part.size * 0.5)));
    } else {
      shapes.push_back(std::make_unique<btSphereShape>(sim::bullet::to_scalar(part.size.x)));
    }
    btVector3 inertia(0, 0, 0);
    if (part.mass > 0) shapes.back()->calculateLocalInertia(sim::bullet::to_scalar(part.mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(sim::bullet::to_scalar(part.mass), nullptr, shapes.back().get(),
                                                  inertia);
    info.m_startWorldTransform = sim::bullet::to_bt(part.pose);
    info.m_friction = btScalar(0.8);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get(), part.size.y > 0 ? kPart : kGround,
                       scene.self_collision || part.size.y == 0 ? -1 : kGround);
  }
  void apply_attraction() {
    if (scene.attraction <= 0) return;
    for (const auto& body : bodies) {
      if (body->isStaticObject()) continue;
      const Vec3 offset = Vec3(0, 0, 1) - sim::bullet::from_bt(body->getWorldTransform().getOrigin());
      body->applyCentralForce(sim::bullet::to_bt(offset * scene.attraction) -
                              body->getLinearVelocity() * btScalar(0.3));
    }
  }
  btRigidBody& body(int part) { return *bodies[static_cast<std::size_t>(part)]; }
  // Frame of a joint in a part, with `column` of its basis along the axis.
  btTransform frame(const RawJoint& joint, int part, int column) const {
    const Vec3 a = normalized(joint.axis);
    const Vec3 b = normalized(glm::cross(a, std::fabs(a.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    const Vec3 c = glm::cross(a, b);
    btMatrix3x3 m;
    for (int r = 0; r < 3; ++r) {
      m[r][column] = sim::bullet::to_scalar(a[r]);
      m[r][(column + 1) % 3] = sim::bullet::to_scalar(b[r]);
      m[r][(column + 2) % 3] = sim::bullet::to_scalar(c[r]);
    }
    const RawPart& p = scene.parts[static_cast<std::size_t>(part)];
    return sim::bullet::to_bt(p.pose).inverse() * btTransform(m, sim::bullet::to_bt(joint.position));
  }
  void measure_joint(RawMeasurements& m, const RawJoint& joint, const btTransform& a, const btTransform& b,
                     double angle) const {
    m.gap = std::max(m.gap, glm::length(sim::bullet::from_bt(a.getOrigin() - b.getOrigin())));
    if (joint.force > 0) m.servo_error = std::max(m.servo_error, std::fabs(angle - joint.target(time)));
    if (joint.lower <= joint.upper) {
      m.limit_violation = std::max({m.limit_violation, angle - joint.upper, joint.lower - angle});
    }
  }
  void measure_parts(RawMeasurements& m) const {
    for (const auto& body : bodies) {
      const double speed = glm::length(sim::bullet::from_bt(body->getLinearVelocity()));
      m.finite = m.finite && speed < 1e5 && is_finite(sim::bullet::from_bt(body->getWorldTransform().getOrigin()));
      m.speed = std::max(m.speed, speed);
    }
  }

  RawScene scene;
  double time = 0;
  std::deque<std::unique_ptr<btCollisionShape>> shapes;
  std::deque<std::unique_ptr<btRigidBody>> bodies;
  std::unique_ptr<btRigidBody> floor;
  btStaticPlaneShape plane{btVector3(0, 0, 1), 0};
};

class StockSimulation : public BasicSimulation<btDiscreteDynamicsWorld> {
 public:
  // null: Bullet's default solver
  StockSimulation(const RawScene& raw, btConstraintSolver* solver)
      : BasicSimulation(raw),
        world_(&dispatcher_, &broadphase_, solver != nullptr ? solver : &solver_, &configuration_) {
    build(world_);
    for (const RawJoint& joint : scene.joints) add_joint(joint);
  }
  ~StockSimulation() override {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies) world_.removeRigidBody(body.get());
    if (floor) world_.removeRigidBody(floor.get());
  }
  void step() override {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (scene.joints[i].force > 0)
        joints_[i]->setServoTarget(3, sim::bullet::to_scalar(-scene.joints[i].target(time)));
    }
    apply_attraction();
    world_.stepSimulation(sim::bullet::to_scalar(scene.step), 0);
    time += scene.step;
  }
  RawMeasurements measurements() const override {
    RawMeasurements m;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      btGeneric6DofSpring2Constraint& j = *joints_[i];
      j.calculateTransforms();
      measure_joint(m, scene.joints[i], j.getRigidBodyA().getWorldTransform() * j.getFrameOffsetA(),
                    j.getRigidBodyB().getWorldTransform() * j.getFrameOffsetB(), -static_cast<double>(j.getAngle(0)));
    }
    measure_parts(m);
    return m;
  }

 private:
  // rotates about x, the outermost axis in Bullet's order: its angles are the negative of ours
  void add_joint(const RawJoint& joint) {
    auto made = std::make_unique<btGeneric6DofSpring2Constraint>(
        body(joint.parent), body(joint.child), frame(joint, joint.parent, 0), frame(joint, joint.child, 0));
    for (int axis = 0; axis < 6; ++axis) made->setLimit(axis, 0, 0);
    const bool free = joint.lower > joint.upper;
    if (!joint.fixed)
      made->setLimit(3, free ? 1 : sim::bullet::to_scalar(-joint.upper),
                     free ? -1 : sim::bullet::to_scalar(-joint.lower));
    if (joint.force > 0) {
      made->enableMotor(3, true);
      made->setServo(3, true);
      made->setTargetVelocity(3, sim::bullet::to_scalar(joint.speed));
      made->setMaxMotorForce(3, sim::bullet::to_scalar(joint.force));
      if (scene.servo_erp > 0) made->setParam(BT_CONSTRAINT_ERP, sim::bullet::to_scalar(scene.servo_erp), 3);
    }
    if (joint.stiffness > 0) {
      made->enableSpring(3, true);
      made->setStiffness(3, sim::bullet::to_scalar(joint.stiffness));
      made->setDamping(3, sim::bullet::to_scalar(joint.damping));
      made->setEquilibriumPoint(3, 0);
    }
    world_.addConstraint(made.get(), true);
    joints_.push_back(std::move(made));
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btGeneric6DofSpring2Constraint>> joints_;
};

// Allocated as in World; a base class, so that it outlives the parts.
struct IslandMemory {
  sim::bullet::BulletMemory memory;
};

class IslandSimulation : private IslandMemory, public BasicSimulation<sim::bullet::IslandWorld> {
 public:
  IslandSimulation(const RawScene& raw, bool direct) : BasicSimulation(raw) {
    const sim::bullet::BulletMemory::Scope scope(&memory);
    world_ = std::make_unique<sim::bullet::IslandWorld>(sim::WorldSetup{});
    world_->set_direct(direct);
    world_->direct().measure(scene.measure);
    build(*world_);
    for (const RawJoint& joint : scene.joints) add_joint(joint);
  }
  ~IslandSimulation() override {
    for (const auto& joint : joints_) world_->removeConstraint(joint.get());
    for (const auto& body : bodies) world_->removeRigidBody(body.get());
    if (floor) world_->removeRigidBody(floor.get());
  }
  void step() override {
    constexpr std::size_t kAhead = 8;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      // as the motors do
      if (i + kAhead < joints_.size()) prefetch(&joints_[i + kAhead]->axis(5), sizeof(sim::bullet::AxisSettings));
      const RawJoint& j = scene.joints[i];
      if (j.force > 0) joints_[i]->set_target(5, j.target(time), 0, j.speed);
    }
    apply_attraction();
    world_->step(scene.step, 1);
    time += scene.step;
    const sim::solver::DirectResiduals& r = world_->direct().residuals();
    max_residuals_ = {0,
                      0,
                      0,
                      std::max(max_residuals_.unbounded, r.unbounded),
                      std::max(max_residuals_.bounded, r.bounded),
                      std::max(max_residuals_.coupled, r.coupled)};
  }
  RawMeasurements measurements() const override {
    RawMeasurements m;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const sim::bullet::JointConstraint& j = *joints_[i];
      measure_joint(m, scene.joints[i], sim::bullet::to_bt(j.pose().parent_frame()),
                    sim::bullet::to_bt(j.pose().child_frame()), j.value(5));
    }
    measure_parts(m);
    return m;
  }
  Direct direct() const override {
    Direct d = max_residuals_;
    const sim::solver::DirectCounts c = world_->direct_counts();
    d.direct = static_cast<double>(c.direct);
    d.plain = static_cast<double>(c.too_large);
    d.fallbacks = static_cast<double>(c.fallbacks);
    return d;
  }

 private:
  void add_joint(const RawJoint& joint) {
    auto made = std::make_unique<sim::bullet::JointConstraint>(
        body(joint.parent), body(joint.child), frame(joint, joint.parent, 2), frame(joint, joint.child, 2));
    sim::bullet::AxisSettings s;
    s.lower = static_cast<float>(joint.fixed ? 0 : joint.lower);
    s.upper = static_cast<float>(joint.fixed ? 0 : joint.upper);
    s.velocity = static_cast<float>(joint.speed);
    s.max_force = static_cast<float>(joint.force);
    s.stiffness = static_cast<float>(joint.stiffness);
    s.spring_damping = static_cast<float>(joint.damping);
    if (joint.force > 0) s.drive = sim::bullet::AxisDrive::servo;
    if (joint.stiffness > 0) s.drive = sim::bullet::AxisDrive::spring;
    made->set_axis(5, s);
    world_->addConstraint(made.get());
    joints_.push_back(std::move(made));
  }

  std::unique_ptr<sim::bullet::IslandWorld> world_;
  Direct max_residuals_;
  std::vector<std::unique_ptr<sim::bullet::JointConstraint>> joints_;
};

}  // namespace

double RawJoint::target(double time) const {
  if (square) return offset + ((static_cast<int>(time) & 1) != 0 ? amplitude : -amplitude);
  return offset + std::min(1.0, 2 * time) * amplitude * fixed::sin(2 * kPi * frequency * time + phase);
}

void RawMeasurements::accumulate_max(const RawMeasurements& other) {
  gap = std::max(gap, other.gap);
  servo_error = std::max(servo_error, other.servo_error);
  limit_violation = std::max(limit_violation, other.limit_violation);
  speed = std::max(speed, other.speed);
  finite = finite && other.finite;
}

double RawEnergyMeter::measure() {
  const RawEnergy previous = std::exchange(last_energy_, simulation_.energy());
  return previous.potential + (previous.kinetic + last_energy_.kinetic) / 2;
}

std::unique_ptr<RawSimulation> RawSimulation::make(const RawScene& scene, RawSolver solver) {
  if (solver == RawSolver::stock) return std::make_unique<StockSimulation>(scene, nullptr);
  return std::make_unique<IslandSimulation>(scene, solver == RawSolver::direct);
}

std::unique_ptr<RawSimulation> RawSimulation::make_stock(const RawScene& scene, btConstraintSolver& solver) {
  return std::make_unique<StockSimulation>(scene, &solver);
}

}  // namespace limber
