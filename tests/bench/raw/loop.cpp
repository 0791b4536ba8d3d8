// RawLoop: building, driving and stepping the scene.
#include "bench/raw/loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limber {

Vec3 ArmScene::center(int arm, int part) const {
  const int side = static_cast<int>(std::ceil(std::sqrt(arms)));
  const int row = arm / side;
  const double along = size.z * (part + 1.5);
  return {spacing * (arm % side), spacing * row, hanging ? size.z * (parts + 3) - along : along};
}

double ArmScene::target(int joint, double time) {
  return std::min(1.0, 2 * time) * 0.3 * fixed::sin(kPi * time + 0.4 * joint);
}

RawLoop::RawLoop(const ArmScene& scene) : scene_(scene), box_(sim::bullet::to_bt(scene.size * 0.5)) {
  world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
  // the settings of our worlds: two friction directions, split impulses for penetration
  world_.getSolverInfo().m_numIterations = scene.solver_iterations;
  world_.getSolverInfo().m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
  world_.getSolverInfo().m_splitImpulse = 1;
  world_.getSolverInfo().m_splitImpulsePenetrationThreshold = 0;
  add_floor();
  for (int arm = 0; arm < scene.arms; arm++) add_arm(arm);
}

RawLoop::~RawLoop() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

btRigidBody& RawLoop::add_box(const Vec3& center, double mass) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) box_.calculateLocalInertia(sim::bullet::to_scalar(mass), inertia);
  bodies_.push_back(std::make_unique<btRigidBody>(
      btRigidBody::btRigidBodyConstructionInfo(sim::bullet::to_scalar(mass), nullptr, &box_, inertia)));
  btRigidBody& body = *bodies_.back();
  body.setWorldTransform(btTransform(btQuaternion::getIdentity(), sim::bullet::to_bt(center)));
  body.setInterpolationWorldTransform(body.getWorldTransform());
  body.setActivationState(DISABLE_DEACTIVATION);
  world_.addRigidBody(&body);
  return body;
}

void RawLoop::add_floor() {
  bodies_.push_back(std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane_)));
  bodies_.back()->setFriction(1);
  world_.addRigidBody(bodies_.back().get());
}

void RawLoop::add_arm(int arm) {
  const btVector3 to_joint = sim::bullet::to_bt(scene_.to_joint());
  btRigidBody* below = &add_box(scene_.center(arm, -1), 0);
  for (int part = 0; part < scene_.parts; part++) {
    btRigidBody* above = &add_box(scene_.center(arm, part), scene_.mass);
    const btTransform in_below(btQuaternion::getIdentity(), -to_joint);
    const btTransform in_above(btQuaternion::getIdentity(), to_joint);
    auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(*below, *above, in_below, in_above);
    for (int axis = 0; axis < 6; axis++) joint->setLimit(axis, 0, 0);
    const int driven_axis = 3 + ArmScene::axis(part);
    joint->setLimit(driven_axis, sim::bullet::to_scalar(-scene_.limit), sim::bullet::to_scalar(scene_.limit));
    joint->enableMotor(driven_axis, true);
    joint->setServo(driven_axis, true);
    joint->setTargetVelocity(driven_axis, sim::bullet::to_scalar(scene_.speed));
    joint->setMaxMotorForce(driven_axis, sim::bullet::to_scalar(scene_.force));
    world_.addConstraint(joint.get(), true);
    joints_.push_back(std::move(joint));
    below = above;
  }
}

void RawLoop::drive(double time) {
  for (std::size_t i = 0; i < joints_.size(); i++) {
    const int joint = static_cast<int>(i) % scene_.parts;
    joints_[i]->setServoTarget(3 + ArmScene::axis(joint), sim::bullet::to_scalar(ArmScene::target(joint, time)));
  }
}

void RawLoop::tick() {
  for (int i = 0; i < scene_.substeps; i++) world_.stepSimulation(sim::bullet::to_scalar(scene_.step), 0);
}

double RawLoop::joint_gap() const {
  double gap = 0;
  for (const auto& joint : joints_) {
    const btVector3 a = joint->getRigidBodyA().getWorldTransform() * joint->getFrameOffsetA().getOrigin();
    const btVector3 b = joint->getRigidBodyB().getWorldTransform() * joint->getFrameOffsetB().getOrigin();
    gap = std::max(gap, static_cast<double>((a - b).length()));
  }
  return gap;
}

double RawLoop::servo_error(double time) const {
  double error = 0;
  for (std::size_t i = 0; i < joints_.size(); i++) {
    const int number = static_cast<int>(i) % scene_.parts;
    joints_[i]->calculateTransforms();
    const double angle = static_cast<double>(joints_[i]->getAngle(ArmScene::axis(number)));
    error = std::max(error, std::fabs(angle - ArmScene::target(number, time)));
  }
  return error;
}

int RawLoop::contact_pairs() const {
  int touching = 0;
  for (int i = 0; i < dispatcher_.getNumManifolds(); i++) {
    if (dispatcher_.getManifoldByIndexInternal(i)->getNumContacts() > 0) touching++;
  }
  return touching;
}

}  // namespace limber
