// Joint drift: the position error that a step would cause in locks because bodies rotate is predicted and subtracted
// from the locks' target rates. The idea of SHAKE (Ryckaert, Ciccotti and Berendsen 1977), in velocities.
#include <algorithm>
#include <cmath>

#include "sim/solver/direct_solver.h"

namespace limber {
namespace {

/// Largest correction, m/s, so that joints torn apart are not closed in one step.
constexpr double kMaxDriftSpeed = 20;
/// Drift below this is ignored, m.
constexpr double kMinDrift = 1e-4;
/// The same for bodies that rotate fast: a top would lose energy.
constexpr double kMinFastDrift = 1e-6;

// True for a hard lock of a linear axis.
bool is_hard_linear_lock(const JointConstraint::Row& row) {
  return row.axis < 3 && row.softness == 0 && static_cast<double>(row.lower) <= -kTreeInfinity &&
         static_cast<double>(row.upper) >= kTreeInfinity;
}

}  // namespace

// Updates the drift correction of all joints: locks prescribe rates at the start of the step, but pivots move along
// arcs. Returns the largest change, m; 0: nothing was changed.
double DirectSolver::update_drift_correction(const IslandPools& pools, double h) {
  double largest = 0;
  predict_motions(pools, h);
  for (Link& link : links_) {
    link.predicted_drift = predict_drift(link, pools, h);
    for (const JointConstraint::Row& row : link.joint->planned()) {
      if (is_hard_linear_lock(row))
        largest = std::max(largest, std::fabs(link.predicted_drift[row.axis] - link.applied_drift[row.axis]));
    }
  }
  if (largest <= (gyroscopic_.empty() ? kMinDrift : kMinFastDrift)) return 0;
  for (Link& link : links_) apply_drift_correction(link, h);
  return largest;
}

// Removes all drift corrections.
void DirectSolver::remove_drift_correction(double h) {
  for (Link& link : links_) {
    link.predicted_drift = Vec3(0);
    apply_drift_correction(link, h);
  }
}

// Applies the correction to the link's rows in a tree, or to its coupled rows if it closes a loop.
void DirectSolver::apply_drift_correction(Link& link, double h) {
  const std::span<const JointConstraint::Row> rows = link.joint->planned();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!is_hard_linear_lock(rows[r])) continue;
    const double change = (link.predicted_drift[rows[r].axis] - link.applied_drift[rows[r].axis]) / h;
    if (link.node >= 0) {
      tree_rows_.rows(link.node)[r].velocity -= change;
    } else {
      coupled_[at(link.coupled_row) + r].target -= change;
    }
  }
  link.applied_drift = link.predicted_drift;
}

// Predicts the motion of each body once, since most bodies have two joints.
void DirectSolver::predict_motions(const IslandPools& pools, double h) {
  motions_.resize(body_of_.size());
  for (std::size_t i = 0; i < body_of_.size(); ++i) motions_[i] = predict_motion(body_of_[i], pools, h);
}

DirectSolver::BodyMotion DirectSolver::predict_motion(int body, const IslandPools& pools, double h) const {
  const Spatial v = solved_velocity(body, pools);
  const RotationStep turn = rotation_step(body, v.angular, pools, h);
  return {v, turn.translation(v.linear, h), turn.rotation(h), turn.clamped(h) > 0};
}

// Predicts the position error that a joint gets in this step in addition to its rates, along the parent's axes, m.
Vec3 DirectSolver::predict_drift(const Link& link, const IslandPools& pools, double h) {
  const JointConstraint& joint = *link.joint;
  const auto motion_of = [&](int body) {
    const int node = node_of_[at(body)];
    return node < 0 ? predict_motion(body, pools, h) : motions_[at(node)];
  };
  const BodyMotion a = motion_of(link.body_a);
  const BodyMotion b = motion_of(link.body_b);
  if (a.clamped || b.clamped) {
    needs_closing_ = true;
    return link.applied_drift;
  }
  const Vec3 arm_a = from_bt(joint.arm_a());
  const Vec3 arm_b = from_bt(joint.arm_b());
  Vec3 gap(0);
  for (int k = 0; k < 3; ++k) gap += from_bt(joint.linear_axis(k)) * joint.value(k);
  const Vec3 pivot_arm = arm_a - gap;
  const Vec3 end_gap =
      gap + b.translation - a.translation + (b.rotation * arm_b - arm_b) - (a.rotation * pivot_arm - pivot_arm);
  const Vec3 pivot_velocity = translated(b.velocity, arm_b).linear - translated(a.velocity, arm_a).linear;
  Vec3 drift(0);
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = from_bt(joint.linear_axis(k));
    drift[k] = std::clamp(glm::dot(a.rotation * axis, end_gap) - glm::dot(axis, gap + pivot_velocity * h),
                          -kMaxDriftSpeed * h, kMaxDriftSpeed * h);
  }
  return drift;
}

}  // namespace limber
