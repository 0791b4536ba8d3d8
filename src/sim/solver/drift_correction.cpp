// DriftCorrection: predicts the motion of the bodies along arcs, and the drift of their joints.
#include "sim/solver/drift_correction.h"

#include <algorithm>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Largest correction, m/s, so that joints torn apart are not closed in one step.
constexpr double kMaxDriftSpeed = 20;
/// The correction diverges if an update changes it by more than this, m, and by more than twice an earlier change.
constexpr double kDivergingDrift = 1e-3;

bool is_hard_linear_lock(const bullet::JointRow& row) { return row.axis < 3 && is_hard_lock(row); }

}  // namespace

void DriftCorrection::begin() {
  applied_.assign(island_.joints.size(), Vec3(0));
  smallest_change_ = 1e5;
  pending_ = true;
  diverged_ = skipped_clamped_ = false;
}

void DriftCorrection::update(double min_drift) {
  double largest = 0;
  predict_motions();
  predicted_.resize(island_.joints.size());
  for (int i = 0; i < island_.joints.size(); ++i) {
    predicted_[i] = predict_drift(i);
    for (const bullet::JointRow& row : island_.joints[i].constraint->rows()) {
      if (is_hard_linear_lock(row))
        largest = std::max(largest, std::fabs(predicted_[i][row.axis] - applied_[i][row.axis]));
    }
  }
  pending_ = !(largest <= min_drift);
  if (!pending_) return;
  diverged_ = largest > kDivergingDrift && largest > 2 * smallest_change_;
  smallest_change_ = std::min(smallest_change_, largest);
  for (int i = 0; i < island_.joints.size(); ++i) apply(i, predicted_[i]);
  for (int i = 0; i < island_.joints.size() && diverged_; ++i) apply(i, Vec3(0));
}

bool DriftCorrection::scale(int index, double fraction) {
  const Vec3 before = applied_[index];
  apply(index, before * fraction);
  return before != Vec3(0);
}

// Applies the correction to the joint's rows in a tree, or to its coupled rows if it closes a loop.
void DriftCorrection::apply(int index, const Vec3& drift) {
  const int node = trees_.node_of_joint(index);
  const bullet::JointRows& rows = island_.joints[index].constraint->rows();
  for (int r = 0; r < rows.size(); ++r) {
    if (!is_hard_linear_lock(rows[r])) continue;
    const double change = (drift[rows[r].axis] - applied_[index][rows[r].axis]) / island_.h;
    if (node >= 0) {
      trees_.axes.rows(node)[r].velocity -= change;
    } else {
      rows_[rows_.first_row_of_loop(index) + r].target -= change;
    }
  }
  applied_[index] = drift;
}

// Predicts the motion of each body once, since most bodies have two joints.
void DriftCorrection::predict_motions() {
  motions_.resize(trees_.node_count());
  for (int i = 0; i < motions_.size(); ++i) motions_[i] = predict_motion(trees_.body_of(i));
}

DriftCorrection::BodyMotion DriftCorrection::predict_motion(int body) const {
  const Spatial v = trees_.velocity(body);
  const bullet::RotationStep turn = island_.rotation_step(body, v.angular);
  return {v, turn.translation(v.linear, island_.h), turn.rotation(island_.h), turn.clamped(island_.h) > 0};
}

// Predicts the change of a joint's position error in this step that its rates at the start don't predict, along the
// parent's axes, m.
Vec3 DriftCorrection::predict_drift(int index) {
  const double h = island_.h;
  const Island::Joint& joint = island_.joints[index];
  const bullet::JointConstraint& constraint = *joint.constraint;
  const auto motion_of = [&](int body) {
    const int node = trees_.node_of(body);
    return node < 0 ? predict_motion(body) : motions_[node];
  };
  const BodyMotion a = motion_of(joint.body_a);
  const BodyMotion b = motion_of(joint.body_b);
  if (a.clamped || b.clamped) {
    skipped_clamped_ = true;
    return applied_[index];
  }
  const Vec3 arm_a = bullet::from_bt(constraint.pose().arm_a());
  const Vec3 arm_b = bullet::from_bt(constraint.pose().arm_b());
  Vec3 gap(0);
  for (int k = 0; k < 3; ++k) gap += bullet::from_bt(constraint.pose().linear_axis(k)) * constraint.value(k);
  const Vec3 pivot_arm = arm_a - gap;
  const Vec3 end_gap =
      gap + b.translation - a.translation + (b.rotation * arm_b - arm_b) - (a.rotation * pivot_arm - pivot_arm);
  const Vec3 pivot_velocity = translated(b.velocity, arm_b).linear - translated(a.velocity, arm_a).linear;
  Vec3 drift(0);
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = bullet::from_bt(constraint.pose().linear_axis(k));
    drift[k] = std::clamp(glm::dot(a.rotation * axis, end_gap) - glm::dot(axis, gap + pivot_velocity * h),
                          -kMaxDriftSpeed * h, kMaxDriftSpeed * h);
  }
  return drift;
}

}  // namespace limber::sim::solver
