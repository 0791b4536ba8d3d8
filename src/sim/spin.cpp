// Which axis a body spins about is read from its joints and its inertia, for fast bodies only.
#include "sim/spin.h"

#include <algorithm>
#include <cmath>

#include "sim/gyroscope.h"
#include "sim/joint_constraint.h"

namespace limber {
namespace {

/// Distance of a pivot from the axis, relative to the radius of gyration, up to which a body counts as balanced.
constexpr double kBalanced = 0.02;
/// Cosine of the angle between two axes that count as parallel.
constexpr double kParallel = 0.9995;
/// Relative difference of two moments of inertia that count as equal.
constexpr double kSameMoment = 0.01;
/// A body without joints is moved by free_motion() from this rotation per step on, rad, and in parts of about this
/// much.
constexpr double kFreeTurn = 0.002;
constexpr double kFreePart = 0.1;
constexpr int kMostFreeParts = 100;

Quat rotation_of(const Vec3& way) {
  const double angle = glm::length(way);
  return angle < 1e-12 ? quat_identity() : quat_axis(way / angle, angle);
}

// Bullet's clamp: beyond kTurnClamp the tangent of half the angle grows in proportion.
double held_turn(double angle) {
  return angle <= kTurnClamp ? angle : 2 * fixed::atan(angle / kTurnClamp * fixed::tan(kTurnClamp / 2));
}

double squared(const Vec3& v) { return glm::dot(v, v); }

// A joint as seen from one of its bodies, in that body's centre-of-mass frame.
struct JointSide {
  const JointConstraint& joint;
  const btTransform& frame;
  const btRigidBody& other;
  bool child;

  Vec3 pivot() const { return from_bt(frame.getOrigin()); }
  // The only angular axis that is not locked; -1: none or several.
  int hinge() const {
    int found = -1;
    for (int axis = 3; axis < 6; ++axis) {
      if (joint.axis(axis).locked()) continue;
      if (found >= 0) return -1;
      found = axis;
    }
    return found;
  }
  bool outermost(int hinge) const { return joint.order()[0] == hinge - 3; }
  // The part that the axis belongs to.
  const btRigidBody& owner(int hinge) const { return outermost(hinge) ? joint.getRigidBodyA() : joint.getRigidBodyB(); }
  // In the body's frame.
  Vec3 own_axis(int hinge) const { return from_bt(frame.getBasis().getColumn(hinge - 3)); }
  // The axis of the relative rotation of the two parts, as it was when the joint was last read.
  Vec3 axis(int hinge, const Mat3& to_world) const {
    if (!outermost(hinge) && child) return own_axis(hinge);
    return from_bt(joint.linear_axis(hinge - 3)) * to_world;
  }
  bool spins(int hinge) const {
    const AxisSettings& s = joint.axis(hinge);
    return s.drive == AxisDrive::spin && s.max_force > 0;
  }
  bool driven(int hinge) const {
    const AxisSettings& s = joint.axis(hinge);
    return (s.drive == AxisDrive::spin || s.drive == AxisDrive::servo) && s.max_force > 0;
  }
};

template <class Visit>
void for_each_joint(const btRigidBody& body, Visit&& visit) {
  auto& refs = const_cast<btRigidBody&>(body);  // Bullet's getter is not const
  for (int i = 0; i < body.getNumConstraintRefs(); ++i) {
    const btTypedConstraint* constraint = refs.getConstraintRef(i);
    if (constraint->getConstraintType() != JointConstraint::kType || !constraint->isEnabled()) continue;
    const auto& joint = static_cast<const JointConstraint&>(*constraint);
    const bool child = &joint.getRigidBodyB() == &body;
    visit(JointSide{joint, child ? joint.frame_in_child() : joint.frame_in_parent(),
                    child ? joint.getRigidBodyA() : joint.getRigidBodyB(), child});
  }
}

int joint_count(const btRigidBody& body) {
  int count = 0;
  if (body.getNumConstraintRefs() == 0) return 0;
  for_each_joint(body, [&](const JointSide&) { count++; });
  return count;
}

// Moments about the principal axes, which are the axes of the centre-of-mass frame; 0: does not turn about it.
Vec3 moments_of(const btRigidBody& body) {
  const Vec3 inverse = from_bt(body.getInvInertiaDiagLocal());
  Vec3 moments(0);
  for (int k = 0; k < 3; ++k) moments[k] = inverse[k] > 0 ? 1 / inverse[k] : 0;
  return moments;
}

double moment_about(const btRigidBody& body, const Vec3& moments, const Vec3& axis) {
  const Vec3 local = axis * glm::mat3_cast(from_bt(body.getWorldTransform().getRotation()));
  return glm::dot(local, moments * local);
}

bool same(double a, double b) { return std::fabs(a - b) <= kSameMoment * std::max(a, b); }

bool principal(const Vec3& moments, const Vec3& axis) {
  const Vec3 momentum = moments * axis;
  return glm::dot(momentum, axis) >= kParallel * glm::length(momentum);
}

// Equal moments about all directions perpendicular to the axis, which is a principal one.
bool symmetric(const Vec3& moments, const Vec3& axis) {
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(axis[k]) >= kParallel) return same(moments[(k + 1) % 3], moments[(k + 2) % 3]);
  }
  return same(moments.x, moments.y) && same(moments.y, moments.z);
}

Vec3 off_axis(const Vec3& point, const Vec3& axis) { return point - glm::dot(point, axis) * axis; }

// A spin in the body's frame.
struct Found {
  double spin = 0;  // 0: none
  Vec3 axis{0};
  Vec3 own{0};
  Vec3 lever{0};
  const btRigidBody* owner = nullptr;  // the part of the axis
};

Found find_spin(const btRigidBody& body, const Vec3& moments, const Mat3& to_world, const Vec3& w) {
  const double reach =
      kBalanced * std::sqrt(std::max({moments.x, moments.y, moments.z}) * static_cast<double>(body.getInvMass()));
  const auto balanced = [&](const Vec3& about) {
    bool all = true;
    for_each_joint(
        body, [&](const JointSide& side) { all = all && squared(off_axis(side.pivot(), about)) <= reach * reach; });
    return all;
  };
  Found found;
  const auto consider = [&](const Vec3& about, const Vec3& own, const Vec3& off, const btRigidBody& owner) {
    const double spin = glm::dot(w, about);
    if (std::fabs(spin) > std::fabs(found.spin)) found = {spin, about, own, off, &owner};
  };
  const bool leaf = joint_count(body) == 1;
  for_each_joint(body, [&](const JointSide& side) {
    const int hinge = side.hinge();
    if (hinge < 0) return;
    const Vec3 about = side.axis(hinge, to_world);
    const Vec3 own = side.own_axis(hinge);
    const bool by_motor = side.driven(hinge);
    if (!by_motor && !principal(moments, own)) return;
    if (balanced(own)) {
      consider(about, own, Vec3(0), side.owner(hinge));
    } else if (side.spins(hinge) && leaf && squared(from_bt(side.other.getAngularVelocity())) < squared(w)) {
      consider(about, own, -off_axis(side.pivot(), own), side.owner(hinge));
    }
  });
  if (found.spin != 0) return found;
  Vec3 about(0);
  if (same(moments.x, moments.y) && same(moments.y, moments.z)) {
    // any axis is a principal one: that through a pivot, or of the rotation
    for_each_joint(body, [&](const JointSide& side) {
      if (squared(side.pivot()) > reach * reach) about = normalized(side.pivot());
    });
    if (about == Vec3(0)) about = normalized(w);
  } else {
    int k = std::fabs(w.y) > std::fabs(w.x) ? 1 : 0;
    if (std::fabs(w.z) > std::fabs(w[k])) k = 2;
    about[k] = 1;
  }
  if (balanced(about)) consider(about, about, Vec3(0), body);
  return found;
}

}  // namespace

Quat Turn::rotation(double h) const {
  const double angle = glm::length(rest) * h;
  const Quat slow = rotation_of(rest * (angle > kTurnClamp ? h * held_turn(angle) / angle : h));
  return spin == 0 ? slow : slow * quat_axis(own, spin * h);
}

Vec3 Turn::next_axis(double h) const {
  const Vec3 swing = owner == nullptr ? rest : split_turn(*owner, from_bt(owner->getAngularVelocity()), h).rest;
  return rotation_of(swing * h) * axis;
}

Vec3 Turn::shift(const Vec3& velocity, double h) const {
  if (lever == Vec3(0)) return velocity * h;
  return (velocity - spin * glm::cross(axis, lever)) * h + rotation(h) * lever - lever;
}

double Turn::clamped(double h) const {
  const double angle = glm::length(rest) * h;
  return angle <= kTurnClamp ? 0 : angle - held_turn(angle);
}

namespace {

// A cheap test that rules out most bodies. An axis that all pivots lie on goes through the farthest one: a body that
// hardly rotates about the line from its center of mass to that pivot has no spin.
bool may_spin(const btRigidBody& body, const Vec3& w, double h) {
  if (body.getNumConstraintRefs() < 2) return true;  // a motor may spin it about an axis beside its center of mass
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const auto least = static_cast<double>(inverse[inverse.minAxis()]);
  const double reach2 = kBalanced * kBalanced * static_cast<double>(body.getInvMass()) / least;
  Vec3 pivot(0);
  int joints = 0;
  for_each_joint(body, [&](const JointSide& side) {
    joints++;
    if (squared(side.pivot()) > std::max(squared(pivot), reach2)) pivot = side.pivot();
  });
  const double distance2 = squared(pivot);
  if (joints < 2 || !(distance2 > 0)) return true;
  const Vec3 local = from_bt(to_bt(w) * body.getWorldTransform().getBasis());
  const double about = std::fabs(glm::dot(local, pivot)) + std::sqrt(squared(w) * reach2);
  return about * about * h * h > kSlowTurn * kSlowTurn * distance2;
}

}  // namespace

Turn split_turn(const btRigidBody& body, const Vec3& w, double h) {
  Turn turn;
  turn.rest = w;
  if (!(squared(w) * h * h > kSlowTurn * kSlowTurn) || !is_finite(w)) return turn;
  if (!may_spin(body, w, h)) return turn;
  const Vec3 moments = moments_of(body);
  if (moments.x == 0 || moments.y == 0 || moments.z == 0 || joint_count(body) == 0) return turn;
  const Mat3 to_world = glm::mat3_cast(from_bt(body.getWorldTransform().getRotation()));
  const Vec3 local = w * to_world;
  const Found found = find_spin(body, moments, to_world, local);
  // what has no symmetry about the axis moves as its angular velocity says, as long as that is accurate
  const bool exact = symmetric(moments, found.own) && found.lever == Vec3(0);
  if (!(std::fabs(found.spin) * h > (exact ? kSlowTurn : kTurnClamp))) return turn;
  turn.axis = to_world * found.axis;
  turn.own = to_world * found.own;
  turn.spin = found.spin;
  turn.lever = to_world * found.lever;
  turn.rest = w - turn.spin * turn.axis;
  turn.owner = found.owner == &body ? nullptr : found.owner;
  return turn;
}

bool moves_freely(const btRigidBody& body, double h) {
  const double turn = static_cast<double>(body.getAngularVelocity().length2()) * h * h;
  return turn > kFreeTurn * kFreeTurn && joint_count(body) == 0;
}

void free_motion(const Vec3& inertia, Quat& rotation, Vec3& w, double h) {
  const Vec3 momentum = rotation * (inertia * (glm::conjugate(rotation) * w));
  const double wanted = std::ceil(glm::length(w) * h / kFreePart);
  const int parts = wanted < kMostFreeParts ? std::max(static_cast<int>(wanted), 1) : kMostFreeParts;
  const double part = h / parts;
  Vec3 local = glm::conjugate(rotation) * w;
  for (int i = 0; i < parts; ++i) {
    const Vec3 change = gyroscopic_change(inertia, local, part);
    rotation = rotation * rotation_of((local + change / 2.0) * part);
    local += change;
  }
  // the length of the momentum is right: so is its direction, by the shortest rotation
  const Vec3 now = rotation * (inertia * local);
  const Vec3 off = glm::cross(now, momentum);
  const double sine = glm::length(off);
  if (sine > 1e-12 * squared(now)) {
    rotation = quat_axis(off / sine, fixed::atan2(sine, glm::dot(now, momentum))) * rotation;
  }
  rotation = glm::normalize(rotation);
  w = rotation * local;
}

Vec3 gyroscopic_change(const btRigidBody& body, double h) {
  const Vec3 moments = moments_of(body);
  if (moments.x == 0 || moments.y == 0 || moments.z == 0 || moves_freely(body, h)) return Vec3(0);
  const Vec3 w = from_bt(body.getAngularVelocity());
  const Turn turn = split_turn(body, w, h);
  if (turn.spin != 0) {
    const double along = moment_about(body, moments, turn.axis);
    const double across = (moments.x + moments.y + moments.z - along) / 2;
    return gyroscopic_change(along, across, turn.axis, turn.spin, turn.rest, h);
  }
  const btMatrix3x3& axes = body.getWorldTransform().getBasis();
  return from_bt(axes * to_bt(gyroscopic_change(moments, from_bt(body.getAngularVelocity() * axes), h)));
}

Vec3 gyroscopic_torque(const btRigidBody& body, const Vec3& w, double h) {
  const Vec3 moments = moments_of(body);
  const Turn turn = split_turn(body, w, h);
  if (turn.spin != 0) return moment_about(body, moments, turn.axis) * turn.spin * glm::cross(turn.axis, turn.rest);
  const Quat rotation = from_bt(body.getWorldTransform().getRotation());
  return glm::cross(rotation * (moments * (glm::conjugate(rotation) * w)), w);
}

double move_body(btRigidBody& body, double h) {
  const Vec3 w = from_bt(body.getAngularVelocity());
  const auto bullets_way = [&] {
    btTransform moved;
    body.predictIntegratedTransform(to_scalar(h), moved);
    body.proceedToTransform(moved);
  };
  const bool jointed = joint_count(body) > 0;
  const double least = jointed ? kSlowTurn : kFreeTurn;
  if (!(squared(w) * h * h > least * least) || !is_finite(w)) {
    bullets_way();
    return 0;
  }
  Pose pose = from_bt(body.getWorldTransform());
  const Vec3 velocity = from_bt(body.getLinearVelocity());
  Vec3 after = w;
  double clamped = 0;
  if (!jointed) {
    const Vec3 moments = moments_of(body);
    if (moments.x == 0 || moments.y == 0 || moments.z == 0) {
      pose.rotation = rotation_of(w * h) * pose.rotation;
    } else {
      free_motion(moments, pose.rotation, after, h);
    }
    pose.position += velocity * h;
  } else {
    const Turn turn = split_turn(body, w, h);
    clamped = turn.clamped(h);
    if (turn.spin == 0) {
      bullets_way();
      return clamped;
    }
    const Quat rotation = turn.rotation(h);
    const Vec3 axis = turn.next_axis(h);
    after = turn.rest + turn.spin * axis;
    pose.position += turn.shift(velocity, h);
    pose.rotation = glm::normalize(rotation * pose.rotation);
    if (turn.lever != Vec3(0)) {
      const Vec3 at_axis = velocity - turn.spin * glm::cross(turn.axis, turn.lever);
      body.setLinearVelocity(to_bt(at_axis + turn.spin * glm::cross(axis, rotation * turn.lever)));
    }
  }
  body.setAngularVelocity(to_bt(after));
  body.proceedToTransform(to_bt(pose));
  return clamped;
}

Vec3 tumbling(const btRigidBody& body, double h) {
  const Vec3 w = from_bt(body.getAngularVelocity());
  if (joint_count(body) > 0) return split_turn(body, w, h).rest;
  const Vec3 moments = moments_of(body);
  const Vec3 local = w * glm::mat3_cast(from_bt(body.getWorldTransform().getRotation()));
  return principal(moments, normalized(local)) ? Vec3(0) : w;
}

// In a field for continuous collision detection, which is off.
void begin_clamps(btRigidBody& body) { body.setCcdSweptSphereRadius(0); }

void note_clamp(btRigidBody& body, double by) {
  if (by > clamped_by(body)) body.setCcdSweptSphereRadius(to_scalar(by));
}

double clamped_by(const btRigidBody& body) { return static_cast<double>(body.getCcdSweptSphereRadius()); }

}  // namespace limber
