// PositionCorrection: predicts the poses at the step's end and closes the joints there.
#include "sim/solver/position_correction.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Position error of a joint above which it is corrected, m; and the tolerance of the correction.
constexpr double kClosingThreshold = 2e-4;
constexpr double kClosingTolerance = 1e-4;
/// Newton iterations.
constexpr int kMaxClosingIterations = 8;
/// Largest rotation of a body per iteration, rad.
constexpr double kMaxClosingRotation = 0.7;
/// Exchanges of the active set of a tree.
constexpr int kMaxClosingExchanges = 8;

btTransform integrated(const btTransform& from, const btVector3& linear, const btVector3& angular, btScalar h) {
  btTransform to;
  btTransformUtil::integrateTransform(from, linear, angular, h, to);
  return to;
}

double error_of(const bullet::JointConstraint& joint, int axis, double goal) {
  const double error = goal - joint.value(axis);
  return axis < 3 ? error : std::remainder(error, 2 * kPi);
}

// Returns the turn velocity (times the step, rad) with which Bullet, which clamps rotations beyond pi/4, rotates a body
// by `rotation`.
Vec3 bullet_turn_velocity(const Quat& rotation) {
  const Quat q = rotation.w < 0 ? -rotation : rotation;
  const Vec3 axis(q.x, q.y, q.z);
  const double sine = glm::length(axis);
  if (sine < 1e-12) return Vec3(0);
  const double angle = 2 * fixed::atan2(sine, q.w);
  const double clamp = kPi / 4;
  const double magnitude = angle <= clamp ? angle : clamp * fixed::tan(angle / 2) / fixed::tan(clamp / 2);
  return axis / sine * magnitude;
}

}  // namespace

void PositionCorrection::apply() {
  for (int i = 0; i < island_.joints.size(); ++i) {
    if (trees_.node_of_joint(i) < 0) return;
  }
  predict_poses();
  set_goals();
  set_poses();
  const double first_error = position_error();
  double error = first_error;
  for (int pass = 0; pass < kMaxClosingIterations && error > (pass == 0 ? kClosingThreshold : kClosingTolerance);
       ++pass) {
    if (!solve_displacements()) break;
    move_bodies();
    set_poses();
    error = position_error();
  }
  restore_poses();
  if (error < first_error) set_push_velocities();
}

void PositionCorrection::predict_poses() {
  end_poses_.clear();
  for (int i = 0; i < trees_.node_count(); ++i) {
    const btSolverBody& b = trees_.body(i);
    const btVector3 turn_velocity = b.m_turnVelocity * island_.info->m_splitImpulseTurnErp;
    const btTransform pushed =
        integrated(b.m_worldTransform, b.m_pushVelocity, turn_velocity, island_.info->m_timeStep);
    const Spatial v = trees_.velocity(trees_.body_of(i));
    const bullet::RotationStep turn = island_.rotation_step(trees_.body_of(i), v.angular);
    Pose end = bullet::from_bt(pushed);
    end.position += turn.translation(v.linear, island_.h);
    end.rotation = turn.rotation(island_.h) * end.rotation;
    end_poses_.push_back(end);
  }
}

// Sets the positions that the locked axes should have at the step's end.
void PositionCorrection::set_goals() {
  goals_.assign(island_.joints.size(), {});
  for (int i = 0; i < goals_.size(); ++i) {
    const bullet::JointConstraint& joint = *island_.joints[i].constraint;
    for (const bullet::JointRow& row : joint.rows()) {
      if (!is_hard_lock(row)) continue;
      goals_[i][row.axis] = joint.value(row.axis) + static_cast<double>(row.velocity * island_.info->m_timeStep);
    }
  }
}

void PositionCorrection::set_poses() {
  for (int i = 0; i < trees_.node_count(); ++i) trees_.rigid(i).setWorldTransform(bullet::to_bt(end_poses_[i]));
  for (const Island::Joint& joint : island_.joints) joint.constraint->refresh();
}

void PositionCorrection::restore_poses() {
  for (int i = 0; i < trees_.node_count(); ++i) trees_.rigid(i).setWorldTransform(trees_.body(i).m_worldTransform);
}

// Largest position error of a joint's linear locks, m.
double PositionCorrection::position_error() const {
  double largest = 0;
  for (int i = 0; i < island_.joints.size(); ++i) {
    const bullet::JointConstraint& joint = *island_.joints[i].constraint;
    for (const bullet::JointRow& row : joint.rows()) {
      if (row.axis < 3 && is_hard_lock(row))
        largest = std::max(largest, std::fabs(error_of(joint, row.axis, goals_[i][row.axis])));
    }
  }
  return largest;
}

// Solves the step's trees at the predicted poses, with displacements instead of rates: locked axes move to their goals,
// limited ones stay within their limits, others are free.
bool PositionCorrection::solve_displacements() {
  axes_.clear();
  for (int i = 0; i < trees_.node_count(); ++i) {
    if (!add_node(i)) return false;
  }
  return std::all_of(trees_.begin(), trees_.end(),
                     [&](const Tree& t) { return axes_.solve_from_scratch(t.first, t.last, kMaxClosingExchanges); });
}

bool PositionCorrection::add_node(int node) {
  TreeNode& n = axes_.forest.add(trees_.axes.forest.node(node).parent);
  n.inertia = inertia_of(trees_.rigid(node));
  const int index = trees_.joint_of(node);
  if (index < 0) {
    make_floating(n);
  } else {
    const Island::Joint& joint = island_.joints[index];
    if (!attach(n, *joint.constraint, joint.body_b == trees_.body_of(node))) return false;
    add_rows(index);
  }
  axes_.end_node({}, {});
  return true;
}

void PositionCorrection::add_rows(int index) {
  const bullet::JointConstraint& joint = *island_.joints[index].constraint;
  for (const bullet::JointRow& row : joint.rows()) {
    if (row.kind != bullet::JointRow::Kind::lock) continue;
    const double distance = is_hard_lock(row) ? error_of(joint, row.axis, goals_[index][row.axis]) : 0;
    axes_.add(row.axis, distance, 0, -2 * AxisRow::kInfinity, 2 * AxisRow::kInfinity, AxisRow::other);
  }
  for (int axis = 0; axis < 6; ++axis) {
    const bullet::AxisSettings& s = joint.axis(axis);
    if (!s.limited()) continue;
    const double down = static_cast<double>(s.lower) - joint.value(axis);
    const double up = static_cast<double>(s.upper) - joint.value(axis);
    axes_.add(axis, std::min(down, 0.0), 0, 0, 2 * AxisRow::kInfinity, AxisRow::lower_limit);
    axes_.add(axis, std::max(up, 0.0), 0, -2 * AxisRow::kInfinity, 0, AxisRow::upper_limit);
  }
}

// Moves the poses by the displacements, by at most kMaxClosingRotation.
void PositionCorrection::move_bodies() {
  double largest = kMaxClosingRotation;
  for (int i = 0; i < end_poses_.size(); ++i) largest = std::max(largest, glm::length(axes_.change(i).angular));
  const double fraction = kMaxClosingRotation / largest;
  for (int i = 0; i < end_poses_.size(); ++i) {
    const Spatial displacement = axes_.change(i) * fraction;
    const double angle = glm::length(displacement.angular);
    end_poses_[i].position += displacement.linear;
    if (angle > 1e-12) end_poses_[i].rotation = quat_axis(displacement.angular / angle, angle) * end_poses_[i].rotation;
  }
}

// Converts the displacements to push velocities, which Bullet applies before it moves the bodies.
void PositionCorrection::set_push_velocities() const {
  const double h = island_.h;
  for (int i = 0; i < trees_.node_count(); ++i) {
    btSolverBody& b = trees_.body(i);
    const Spatial v = trees_.velocity(trees_.body_of(i));
    const bullet::RotationStep turn = island_.rotation_step(trees_.body_of(i), v.angular);
    const Pose start = bullet::from_bt(b.m_worldTransform);
    const Quat push = glm::conjugate(turn.rotation(h)) * end_poses_[i].rotation * glm::conjugate(start.rotation);
    b.m_pushVelocity = bullet::to_bt((end_poses_[i].position - start.position - turn.translation(v.linear, h)) / h);
    b.m_turnVelocity =
        bullet::to_bt(bullet_turn_velocity(push) / (h * static_cast<double>(island_.info->m_splitImpulseTurnErp)));
  }
}

}  // namespace limber::sim::solver
