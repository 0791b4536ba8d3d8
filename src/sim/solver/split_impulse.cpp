// Position correction: where joints would have a position error at the step's end (a rotation is clamped, or the drift
// correction has not converged), bodies are moved by the least displacement in the norm of the mass matrix, without a
// change of velocity.
#include <algorithm>
#include <cmath>

#include "sim/solver/direct_solver.h"

namespace limber {
namespace {

/// Position error of a joint above which it is corrected, m; and the tolerance of the correction.
constexpr double kClosingThreshold = 2e-4;
constexpr double kClosingTolerance = 1e-4;
/// Newton iterations.
constexpr int kMaxClosingIterations = 8;
/// Largest rotation of a body per iteration, rad.
constexpr double kMaxClosingRotation = 0.7;

bool is_hard_lock(const JointConstraint::Row& row) {
  return row.softness == 0 && static_cast<double>(row.lower) <= -kTreeInfinity &&
         static_cast<double>(row.upper) >= kTreeInfinity;
}

btTransform integrated(const btTransform& from, const btVector3& linear, const btVector3& angular, btScalar h) {
  btTransform to;
  btTransformUtil::integrateTransform(from, linear, angular, h, to);
  return to;
}

double error_of(const JointConstraint& joint, int axis, double goal) {
  const double error = goal - joint.value(axis);
  return axis < 3 ? error : std::remainder(error, 2 * kPi);
}

// Returns the turn velocity (times the step, rad) with which Bullet, which clamps rotations beyond pi/4, rotates a body
// by `turn`.
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

// Predicts the pose of every body at the step's end, and sets the goals of locked axes.
void DirectSolver::predict_poses(const IslandPools& pools, const btContactSolverInfo& info) {
  const btScalar h = info.m_timeStep;
  end_poses_.clear();
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const btSolverBody& b = pools.bodies[body_of_[i]];
    const btTransform pushed =
        integrated(b.m_worldTransform, b.m_pushVelocity, b.m_turnVelocity * info.m_splitImpulseTurnErp, h);
    const Spatial v = velocity(body_of_[i], pools) + tree_rows_.change(static_cast<int>(i));
    const RotationStep turn = rotation_step(body_of_[i], v.angular, pools, static_cast<double>(h));
    Pose end = from_bt(pushed);
    end.position += turn.translation(v.linear, static_cast<double>(h));
    end.rotation = turn.rotation(static_cast<double>(h)) * end.rotation;
    end_poses_.push_back(end);
  }
  lock_goals_.assign(links_.size(), {});
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const JointConstraint& joint = *links_[l].joint;
    for (const JointConstraint::Row& row : joint.planned()) {
      if (is_hard_lock(row)) lock_goals_[l][row.axis] = joint.value(row.axis) + static_cast<double>(row.velocity * h);
    }
  }
}

void DirectSolver::set_poses(const IslandPools& pools) {
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    pools.bodies[body_of_[i]].m_originalBody->setWorldTransform(to_bt(end_poses_[i]));
  }
  for (Link& link : links_) link.joint->refresh();
}

// Largest position error of a joint's linear locks, m.
double DirectSolver::position_error() {
  double largest = 0;
  for (std::size_t l = 0; l < links_.size(); ++l) {
    if (links_[l].node < 0) continue;
    const JointConstraint& joint = *links_[l].joint;
    for (const JointConstraint::Row& row : joint.planned()) {
      if (row.axis < 3 && is_hard_lock(row))
        largest = std::max(largest, std::fabs(error_of(joint, row.axis, lock_goals_[l][row.axis])));
    }
  }
  return largest;
}

// Builds the step's trees at the predicted poses: locked axes move to their goals, limited ones stay within their
// limits, others are free.
bool DirectSolver::build_pose_rows(const IslandPools& pools) {
  pose_rows_.clear();
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    TreeNode& n = pose_rows_.forest.add(tree_rows_.forest.node(static_cast<int>(i)).parent);
    n.inertia = inertia_of(*pools.bodies[body_of_[i]].m_originalBody);
    if (link_of_[i] < 0) {
      make_floating(n);
    } else {
      const Link& link = links_[at(link_of_[i])];
      const JointConstraint& joint = *link.joint;
      if (!attach(n, joint, link.body_b == body_of_[i])) return false;
      for (const JointConstraint::Row& row : joint.planned()) {
        if (row.kind != JointConstraint::RowKind::lock) continue;
        const double distance =
            is_hard_lock(row) ? error_of(joint, row.axis, lock_goals_[at(link_of_[i])][row.axis]) : 0;
        pose_rows_.add(row.axis, distance, 0, -2 * kTreeInfinity, 2 * kTreeInfinity, TreeRow::other);
      }
      for (int axis = 0; axis < 6; ++axis) {
        const AxisSettings& s = joint.axis(axis);
        if (!s.limited()) continue;
        const double down = static_cast<double>(s.lower) - joint.value(axis);
        const double up = static_cast<double>(s.upper) - joint.value(axis);
        pose_rows_.add(axis, std::min(down, 0.0), 0, 0, 2 * kTreeInfinity, TreeRow::lower_limit);
        pose_rows_.add(axis, std::max(up, 0.0), 0, -2 * kTreeInfinity, 0, TreeRow::upper_limit);
      }
    }
    pose_rows_.end_node({}, {});
  }
  return std::all_of(trees_.begin(), trees_.end(), [&](const Tree& t) { return pose_rows_.pivot(t.first, t.last, 8); });
}

// Converts the displacements to push velocities, which Bullet applies before it moves the bodies.
void DirectSolver::set_push_velocities(IslandPools& pools, const btContactSolverInfo& info) const {
  const double h = static_cast<double>(info.m_timeStep);
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    btSolverBody& b = pools.bodies[body_of_[i]];
    const Spatial v = velocity(body_of_[i], pools) + tree_rows_.change(static_cast<int>(i));
    const RotationStep turn = rotation_step(body_of_[i], v.angular, pools, h);
    const Pose start = from_bt(b.m_worldTransform);
    const Quat push = glm::conjugate(turn.rotation(h)) * end_poses_[i].rotation * glm::conjugate(start.rotation);
    b.m_pushVelocity = to_bt((end_poses_[i].position - start.position - turn.translation(v.linear, h)) / h);
    b.m_turnVelocity = to_bt(bullet_turn_velocity(push) / (h * static_cast<double>(info.m_splitImpulseTurnErp)));
  }
}

void DirectSolver::close_joints(IslandPools& pools, const btContactSolverInfo& info) {
  if (!info.m_splitImpulse || info.m_splitImpulseTurnErp <= 0) return;
  if (std::any_of(links_.begin(), links_.end(), [](const Link& link) { return link.node < 0; })) return;
  predict_poses(pools, info);
  set_poses(pools);
  const double first_error = position_error();
  double error = first_error;
  for (int pass = 0; pass < kMaxClosingIterations && error > (pass == 0 ? kClosingThreshold : kClosingTolerance);
       ++pass) {
    if (!build_pose_rows(pools)) break;
    double largest = kMaxClosingRotation;
    for (std::size_t i = 0; i < end_poses_.size(); ++i) {
      largest = std::max(largest, glm::length(pose_rows_.change(static_cast<int>(i)).angular));
    }
    const double fraction = kMaxClosingRotation / largest;
    for (std::size_t i = 0; i < end_poses_.size(); ++i) {
      const Spatial displacement = pose_rows_.change(static_cast<int>(i)) * fraction;
      const double angle = glm::length(displacement.angular);
      end_poses_[i].position += displacement.linear;
      if (angle > 1e-12)
        end_poses_[i].rotation = quat_axis(displacement.angular / angle, angle) * end_poses_[i].rotation;
    }
    set_poses(pools);
    error = position_error();
  }
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const btSolverBody& b = pools.bodies[body_of_[i]];
    b.m_originalBody->setWorldTransform(b.m_worldTransform);
  }
  if (error < first_error) set_push_velocities(pools, info);
}

}  // namespace limber
