// Finds the spin axis of fast bodies from their joints and inertia, and integrates rotations.
#include "sim/bullet/rotation_step.h"

#include <algorithm>
#include <cmath>

#include "sim/bullet/joints/joint_constraint.h"
#include "sim/solver/gyroscope.h"

namespace limber::sim::bullet {
namespace {

/// Distance of a pivot from the axis, relative to the radius of gyration, up to which a body counts as balanced.
constexpr double kBalanced = 0.02;
/// Cosine of the angle between two axes that count as parallel.
constexpr double kParallel = 0.9995;
/// Relative difference of two moments of inertia that count as equal.
constexpr double kSameMoment = 0.01;
/// A body without joints is moved by integrate_free_rotation() above this rotation per step, rad, in substeps of about
/// kFreeSubstep.
constexpr double kMinFreeRotation = 0.002;
constexpr double kFreeSubstep = 0.1;
constexpr int kMaxFreeSubsteps = 100;

Quat rotation_of(const Vec3& rotation_vector) {
  const double angle = glm::length(rotation_vector);
  return angle < 1e-12 ? quat_identity() : quat_axis(rotation_vector / angle, angle);
}

// Bullet's clamp: beyond kMaxTurnPerStep the tangent of half the angle grows linearly.
double clamped_angle(double angle) {
  return angle <= kMaxRotationPerStep
             ? angle
             : 2 * fixed::atan(angle / kMaxRotationPerStep * fixed::tan(kMaxRotationPerStep / 2));
}

double squared(const Vec3& v) { return glm::dot(v, v); }

// A joint as seen from one of its bodies, in that body's center-of-mass frame.
struct JointSide {
  const JointConstraint& joint;
  const btTransform& frame;
  const btRigidBody& other;
  bool child;

  Vec3 pivot() const { return from_bt(frame.getOrigin()); }
  // The only angular axis that is not locked; -1: none or several.
  int hinge_axis() const {
    int found = -1;
    for (int axis = 3; axis < 6; ++axis) {
      if (joint.axis(axis).locked()) continue;
      if (found >= 0) return -1;
      found = axis;
    }
    return found;
  }
  bool is_outermost(int hinge) const { return joint.pose().order()[0] == hinge - 3; }
  // Returns the part that the axis is fixed to.
  const btRigidBody& owner(int hinge) const {
    return is_outermost(hinge) ? joint.getRigidBodyA() : joint.getRigidBodyB();
  }
  // In the body's frame.
  Vec3 own_axis(int hinge) const { return from_bt(frame.getBasis().getColumn(hinge - 3)); }
  // Axis of the relative rotation of the two parts, as of the last read of the joint.
  Vec3 axis(int hinge, const Mat3& to_world) const {
    if (!is_outermost(hinge) && child) return own_axis(hinge);
    return from_bt(joint.pose().linear_axis(hinge - 3)) * to_world;
  }
  bool is_spin_motor(int hinge) const {
    const AxisSettings& s = joint.axis(hinge);
    return s.drive == AxisDrive::spin && s.max_force > 0;
  }
  bool is_driven(int hinge) const {
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
    visit(JointSide{joint, child ? joint.pose().frame_in_child() : joint.pose().frame_in_parent(),
                    child ? joint.getRigidBodyA() : joint.getRigidBodyB(), child});
  }
}

int joint_count(const btRigidBody& body) {
  int count = 0;
  if (body.getNumConstraintRefs() == 0) return 0;
  for_each_joint(body, [&](const JointSide&) { count++; });
  return count;
}

// Principal moments, along the axes of the center-of-mass frame; 0: the body can't rotate about it.
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

bool nearly_equal(double a, double b) { return std::fabs(a - b) <= kSameMoment * std::max(a, b); }

bool is_principal(const Vec3& moments, const Vec3& axis) {
  const Vec3 momentum = moments * axis;
  return glm::dot(momentum, axis) >= kParallel * glm::length(momentum);
}

// True if moments about all directions perpendicular to the axis, which is a principal one, are equal.
bool is_symmetric(const Vec3& moments, const Vec3& axis) {
  for (int k = 0; k < 3; ++k) {
    if (std::fabs(axis[k]) >= kParallel) return nearly_equal(moments[(k + 1) % 3], moments[(k + 2) % 3]);
  }
  return nearly_equal(moments.x, moments.y) && nearly_equal(moments.y, moments.z);
}

Vec3 off_axis(const Vec3& point, const Vec3& axis) { return point - glm::dot(point, axis) * axis; }

// True if all joints of the body are on this axis through its center of mass.
bool is_balanced(const btRigidBody& body, const Vec3& axis, double tolerance) {
  bool all = true;
  for_each_joint(body, [&](const JointSide& side) {
    all = all && squared(off_axis(side.pivot(), axis)) <= tolerance * tolerance;
  });
  return all;
}

// A spin in the body's frame.
struct SpinAxis {
  double spin = 0;  // 0: none
  Vec3 axis{0};
  Vec3 body_axis{0};
  Vec3 lever{0};
  const btRigidBody* owner = nullptr;  // the part that the axis is fixed to

  void replace_if_slower(const SpinAxis& other) {
    if (std::fabs(other.spin) > std::fabs(spin)) *this = other;
  }
};

// The fastest spin about the axis of a hinge.
SpinAxis find_hinge_spin(const btRigidBody& body, const Vec3& moments, const Mat3& to_world, const Vec3& w,
                         double tolerance) {
  SpinAxis found;
  const bool leaf = joint_count(body) == 1;
  for_each_joint(body, [&](const JointSide& side) {
    const int hinge = side.hinge_axis();
    if (hinge < 0) return;
    const Vec3 about = side.axis(hinge, to_world);
    const Vec3 own = side.own_axis(hinge);
    if (!side.is_driven(hinge) && !is_principal(moments, own)) return;
    if (is_balanced(body, own, tolerance)) {
      found.replace_if_slower({glm::dot(w, about), about, own, Vec3(0), &side.owner(hinge)});
    } else if (side.is_spin_motor(hinge) && leaf && squared(from_bt(side.other.getAngularVelocity())) < squared(w)) {
      const Vec3 lever = -off_axis(side.pivot(), own);
      found.replace_if_slower({glm::dot(w, about), about, own, lever, &side.owner(hinge)});
    }
  });
  return found;
}

// The principal axis of inertia nearest to the rotation. If all axes are principal: the one through a pivot, or, if the
// pivots are at the center of mass, that of the rotation.
Vec3 principal_axis(const btRigidBody& body, const Vec3& moments, const Vec3& w, double tolerance) {
  Vec3 axis(0);
  if (nearly_equal(moments.x, moments.y) && nearly_equal(moments.y, moments.z)) {
    for_each_joint(body, [&](const JointSide& side) {
      if (squared(side.pivot()) > tolerance * tolerance) axis = normalized(side.pivot());
    });
    return axis == Vec3(0) ? normalized(w) : axis;
  }
  int k = std::fabs(w.y) > std::fabs(w.x) ? 1 : 0;
  if (std::fabs(w.z) > std::fabs(w[k])) k = 2;
  axis[k] = 1;
  return axis;
}

SpinAxis find_spin(const btRigidBody& body, const Vec3& moments, const Mat3& to_world, const Vec3& w) {
  const double tolerance =
      kBalanced * std::sqrt(std::max({moments.x, moments.y, moments.z}) * static_cast<double>(body.getInvMass()));
  SpinAxis found = find_hinge_spin(body, moments, to_world, w, tolerance);
  if (found.spin != 0) return found;
  const Vec3 axis = principal_axis(body, moments, w, tolerance);
  if (is_balanced(body, axis, tolerance)) found.replace_if_slower({glm::dot(w, axis), axis, axis, Vec3(0), &body});
  return found;
}

}  // namespace

Quat RotationStep::rotation(double h) const {
  const double angle = glm::length(tumble) * h;
  const Quat tumbling = rotation_of(tumble * (angle > kMaxRotationPerStep ? h * clamped_angle(angle) / angle : h));
  return spin == 0 ? tumbling : tumbling * quat_axis(body_axis, spin * h);
}

Vec3 RotationStep::next_axis(double h) const {
  const Vec3 swing = owner == nullptr ? tumble : split_rotation(*owner, from_bt(owner->getAngularVelocity()), h).tumble;
  return rotation_of(swing * h) * axis;
}

Vec3 RotationStep::translation(const Vec3& velocity, double h) const {
  if (lever == Vec3(0)) return velocity * h;
  return (velocity - spin * glm::cross(axis, lever)) * h + rotation(h) * lever - lever;
}

double RotationStep::clamped(double h) const {
  const double angle = glm::length(tumble) * h;
  return angle <= kMaxRotationPerStep ? 0 : angle - clamped_angle(angle);
}

namespace {

// A cheap test that excludes most bodies. An axis that all pivots lie on passes through the farthest one: a body that
// hardly rotates about the line from its center of mass to that pivot has no spin.
bool can_spin(const btRigidBody& body, const Vec3& w, double h) {
  if (body.getNumConstraintRefs() < 2)
    return true;  // a motor may spin it about an axis that is not through its center of mass
  const btVector3& inverse = body.getInvInertiaDiagLocal();
  const auto min_inverse = static_cast<double>(inverse[inverse.minAxis()]);
  const double tolerance2 = kBalanced * kBalanced * static_cast<double>(body.getInvMass()) / min_inverse;
  Vec3 pivot(0);
  int joints = 0;
  for_each_joint(body, [&](const JointSide& side) {
    joints++;
    if (squared(side.pivot()) > std::max(squared(pivot), tolerance2)) pivot = side.pivot();
  });
  const double distance2 = squared(pivot);
  if (joints < 2 || !(distance2 > 0)) return true;
  const Vec3 local = from_bt(to_bt(w) * body.getWorldTransform().getBasis());
  const double about = std::fabs(glm::dot(local, pivot)) + std::sqrt(squared(w) * tolerance2);
  return about * about * h * h > kSlowRotation * kSlowRotation * distance2;
}

}  // namespace

RotationStep split_rotation(const btRigidBody& body, const Vec3& w, double h) {
  RotationStep step;
  step.tumble = w;
  if (!(squared(w) * h * h > kSlowRotation * kSlowRotation) || !is_finite(w)) return step;
  if (!can_spin(body, w, h)) return step;
  const Vec3 moments = moments_of(body);
  if (moments.x == 0 || moments.y == 0 || moments.z == 0 || joint_count(body) == 0) return step;
  const Mat3 to_world = glm::mat3_cast(from_bt(body.getWorldTransform().getRotation()));
  const Vec3 local = w * to_world;
  const SpinAxis found = find_spin(body, moments, to_world, local);
  // without symmetry about the axis a constant angular velocity is used as long as it is accurate
  const bool exact = is_symmetric(moments, found.body_axis) && found.lever == Vec3(0);
  if (!(std::fabs(found.spin) * h > (exact ? kSlowRotation : kMaxRotationPerStep))) return step;
  step.axis = to_world * found.axis;
  step.body_axis = to_world * found.body_axis;
  step.spin = found.spin;
  step.lever = to_world * found.lever;
  step.tumble = w - step.spin * step.axis;
  step.owner = found.owner == &body ? nullptr : found.owner;
  return step;
}

bool moves_freely(const btRigidBody& body, double h) {
  const double squared_angle = static_cast<double>(body.getAngularVelocity().length2()) * h * h;
  return squared_angle > kMinFreeRotation * kMinFreeRotation && joint_count(body) == 0;
}

void integrate_free_rotation(const Vec3& inertia, Quat& rotation, Vec3& w, double h) {
  const Vec3 momentum = rotation * (inertia * (glm::conjugate(rotation) * w));
  const double required = std::ceil(glm::length(w) * h / kFreeSubstep);
  const int substeps = required < kMaxFreeSubsteps ? std::max(static_cast<int>(required), 1) : kMaxFreeSubsteps;
  const double substep = h / substeps;
  Vec3 local = glm::conjugate(rotation) * w;
  for (int i = 0; i < substeps; ++i) {
    const Vec3 change = solver::gyroscopic_change(inertia, local, substep);
    rotation = rotation * rotation_of((local + change / 2.0) * substep);
    local += change;
  }
  // the length of the momentum is exact; restore its direction by the shortest rotation
  const Vec3 current_momentum = rotation * (inertia * local);
  const Vec3 correction_axis = glm::cross(current_momentum, momentum);
  const double sine = glm::length(correction_axis);
  if (sine > 1e-12 * squared(current_momentum)) {
    rotation = quat_axis(correction_axis / sine, fixed::atan2(sine, glm::dot(current_momentum, momentum))) * rotation;
  }
  rotation = glm::normalize(rotation);
  w = rotation * local;
}

Vec3 gyroscopic_change(const btRigidBody& body, double h) {
  const Vec3 moments = moments_of(body);
  if (moments.x == 0 || moments.y == 0 || moments.z == 0 || moves_freely(body, h)) return Vec3(0);
  const Vec3 w = from_bt(body.getAngularVelocity());
  const RotationStep step = split_rotation(body, w, h);
  if (step.spin != 0) {
    const double along = moment_about(body, moments, step.axis);
    const double across = (moments.x + moments.y + moments.z - along) / 2;
    return solver::gyroscopic_change(along, across, step.axis, step.spin, step.tumble, h);
  }
  const btMatrix3x3& axes = body.getWorldTransform().getBasis();
  return from_bt(axes * to_bt(solver::gyroscopic_change(moments, from_bt(body.getAngularVelocity() * axes), h)));
}

Vec3 gyroscopic_torque(const btRigidBody& body, const Vec3& w, double h) {
  const Vec3 moments = moments_of(body);
  const RotationStep step = split_rotation(body, w, h);
  if (step.spin != 0) return moment_about(body, moments, step.axis) * step.spin * glm::cross(step.axis, step.tumble);
  const Quat rotation = from_bt(body.getWorldTransform().getRotation());
  return glm::cross(rotation * (moments * (glm::conjugate(rotation) * w)), w);
}

double move_body(btRigidBody& body, double h) {
  const Vec3 w = from_bt(body.getAngularVelocity());
  const auto move_by_bullet = [&] {
    btTransform moved;
    body.predictIntegratedTransform(to_scalar(h), moved);
    body.proceedToTransform(moved);
  };
  const bool jointed = joint_count(body) > 0;
  const double threshold = jointed ? kSlowRotation : kMinFreeRotation;
  if (!(squared(w) * h * h > threshold * threshold) || !is_finite(w)) {
    move_by_bullet();
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
      integrate_free_rotation(moments, pose.rotation, after, h);
    }
    pose.position += velocity * h;
  } else {
    const RotationStep step = split_rotation(body, w, h);
    clamped = step.clamped(h);
    if (step.spin == 0) {
      move_by_bullet();
      return clamped;
    }
    const Quat rotation = step.rotation(h);
    const Vec3 axis = step.next_axis(h);
    after = step.tumble + step.spin * axis;
    pose.position += step.translation(velocity, h);
    pose.rotation = glm::normalize(rotation * pose.rotation);
    if (step.lever != Vec3(0)) {
      const Vec3 at_axis = velocity - step.spin * glm::cross(step.axis, step.lever);
      body.setLinearVelocity(to_bt(at_axis + step.spin * glm::cross(axis, rotation * step.lever)));
    }
  }
  body.setAngularVelocity(to_bt(after));
  body.proceedToTransform(to_bt(pose));
  return clamped;
}

Vec3 tumbling_velocity(const btRigidBody& body, double h) {
  const Vec3 w = from_bt(body.getAngularVelocity());
  if (joint_count(body) > 0) return split_rotation(body, w, h).tumble;
  const Vec3 moments = moments_of(body);
  const Vec3 local = w * glm::mat3_cast(from_bt(body.getWorldTransform().getRotation()));
  return is_principal(moments, normalized(local)) ? Vec3(0) : w;
}

// Stored in a field for continuous collision detection, which is off.
void reset_clamp(btRigidBody& body) { body.setCcdSweptSphereRadius(0); }

void record_clamp(btRigidBody& body, double amount) {
  if (amount > clamped_speed(body)) body.setCcdSweptSphereRadius(to_scalar(amount));
}

double clamped_speed(const btRigidBody& body) { return static_cast<double>(body.getCcdSweptSphereRadius()); }

}  // namespace limber::sim::bullet
