// KinematicBodies: poses within a tick, and the moves that lead to a pose.
#include "sim/bullet/kinematic_bodies.h"

#include "sim/bullet/joints/joint_constraint.h"

namespace limber::sim::bullet {
namespace {

Pose pose_after(const KinematicMove& move, double seconds) {
  Pose pose = move.from;
  pose.position += move.linear * seconds;
  if (move.angular != 0) pose.rotation = quat_axis(move.axis, move.angular * seconds) * pose.rotation;
  return pose;
}

void set_pose(btRigidBody& body, const btTransform& pose) {
  body.setWorldTransform(pose);
  body.setInterpolationWorldTransform(pose);
  body.updateInertiaTensor();
}

}  // namespace

KinematicMove move_to(btRigidBody& body, const btTransform& to, double seconds) {
  KinematicMove move;
  move.body = &body;
  move.from = from_bt(body.getWorldTransform());
  move.to = to;
  const Pose end = from_bt(to);
  move.linear = (end.position - move.from.position) / seconds;
  if (body.getWorldTransform().getBasis() == to.getBasis()) return move;
  Quat turn = end.rotation * glm::conjugate(move.from.rotation);
  if (turn.w < 0) turn = -turn;
  const Vec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return move;
  move.axis = axis / sine;
  move.angular = 2 * fixed::atan2(sine, turn.w) / seconds;
  return move;
}

KinematicMove move_at(btRigidBody& body, const Vec3& linear, const Vec3& angular, double seconds) {
  KinematicMove move;
  move.body = &body;
  move.from = from_bt(body.getWorldTransform());
  move.linear = linear;
  move.angular = glm::length(angular);
  if (move.angular > 0) move.axis = angular / move.angular;
  move.to = to_bt(pose_after(move, seconds));
  // without a rotation the matrix must not change by the conversion to a quaternion
  if (move.angular == 0) move.to.setBasis(body.getWorldTransform().getBasis());
  return move;
}

void KinematicBodies::add(const KinematicMove& move) {
  moves_->push_back(move);
  move.body->setLinearVelocity(to_bt(move.linear));
  move.body->setAngularVelocity(to_bt(move.axis * move.angular));
}

void KinematicBodies::wake(SleepTracker& sleep) const {
  for (const KinematicMove& move : *moves_) sleep.wake(*move.body);
}

void KinematicBodies::advance(double h, bool last) {
  time_ += h;
  for (const KinematicMove& move : *moves_) {
    set_pose(*move.body, last ? move.to : to_bt(pose_after(move, time_)));
    if (!last) continue;
    for (int i = 0; i < move.body->getNumConstraintRefs(); ++i) {
      btTypedConstraint& joint = *move.body->getConstraintRef(i);
      if (joint.getConstraintType() == JointConstraint::kType) static_cast<JointConstraint&>(joint).refresh();
    }
  }
}

void KinematicBodies::end_tick() {
  moves_->clear();
  time_ = 0;
}

}  // namespace limber::sim::bullet
