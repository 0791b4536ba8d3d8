// LockEnergy: the work of locks, and the energy that they may return.
#include "sim/solver/lock_energy.h"

#include <algorithm>

namespace limber::sim::solver {
namespace {

/// Drift corrections are scaled down by a little more than linear interpolation yields.
constexpr double kEnergySafety = 0.95;
/// Fraction of the energy absorbed by locks that they may return, and the maximum of the stored energy, J.
constexpr double kReturnedFraction = 0.75;
constexpr double kMaxStoredEnergy = 1e6;

}  // namespace

void LockEnergy::begin() {
  groups_.clear();
  if (trees_.has_loops()) {
    groups_.push_back({0, trees_.node_count()});
  } else {
    for (const Tree& t : trees_) groups_.push_back(t);
  }
  uncorrected_work_.clear();
  for (const Tree& t : groups_) uncorrected_work_.push_back(is_passive(t) ? work_of_locks(t) : 0);
}

// Work of a tree's locks in the step, J: each impulse times the mean of its rate before and after the step.
double LockEnergy::work_of_locks(const Tree& tree) const {
  double work = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    if (trees_.joint_of(i) < 0) continue;
    const Island::Joint& joint = island_.joints[trees_.joint_of(i)];
    const bullet::JointConstraint& constraint = *joint.constraint;
    const Spatial a = island_.start_velocity(joint.body_a);
    const Spatial b = island_.start_velocity(joint.body_b);
    const Vec3 drift = translated(b, bullet::from_bt(constraint.pose().arm_b())).linear -
                       translated(a, bullet::from_bt(constraint.pose().arm_a())).linear;
    const Vec3 spin = b.angular - a.angular;
    for (const AxisRow& row : trees_.axes.rows(i)) {
      if (row.bounded() || !row.hard()) continue;
      const double rate = row.axis < 3 ? glm::dot(bullet::from_bt(constraint.pose().linear_axis(row.axis)), drift)
                                       : glm::dot(bullet::from_bt(constraint.pose().dual_axis(row.axis - 3)), spin);
      work += row.impulse * (rate + trees_.axes.rate(i, row.axis)) / 2;
    }
  }
  return trees_.has_loops() ? work + work_of_loops() : work;
}

// The same for the locks of joints that close loops.
double LockEnergy::work_of_loops() const {
  double work = 0;
  for (int i = 0; i < island_.joints.size(); ++i) {
    if (trees_.node_of_joint(i) >= 0) continue;
    const Island::Joint& joint = island_.joints[i];
    const bullet::JointRows& rows = joint.constraint->rows();
    for (int r = 0; r < rows.size(); ++r) {
      if (!is_hard_lock(rows[r])) continue;
      const CoupledRow& row = rows_[rows_.first_row_of_loop(i) + r];
      const auto rate = [&](const Spatial& a, const Spatial& b) {
        return dot(row.a.jacobian, a) + dot(row.b.jacobian, b);
      };
      const double before = rate(island_.start_velocity(joint.body_a), island_.start_velocity(joint.body_b));
      const double after = rate(trees_.velocity(joint.body_a), trees_.velocity(joint.body_b));
      work += row.impulse * (before + after) / 2;
    }
  }
  return work;
}

// The first joint of a tree; -1: it has none.
int LockEnergy::first_joint(const Tree& tree) const {
  int node = tree.first;
  while (node < tree.last && trees_.joint_of(node) < 0) ++node;
  return node < tree.last ? trees_.joint_of(node) : -1;
}

// Energy that the locks of a tree may return; stored in its first joint.
double& LockEnergy::stored_energy(const Tree& tree) const {
  return island_.joints[first_joint(tree)].constraint->warm_start().lock_energy();
}

// True if the tree has joints, and no motor drives any of them.
bool LockEnergy::is_passive(const Tree& tree) const {
  if (first_joint(tree) < 0) return false;
  for (int i = tree.first; i < tree.last; ++i) {
    for (const AxisRow& row : trees_.axes.rows(i)) {
      if (row.kind == AxisRow::motor && row.upper > row.lower) return false;
    }
  }
  return true;
}

bool LockEnergy::limit() {
  bool changed = false;
  for (int t = 0; t < groups_.size(); ++t) {
    const Tree& tree = groups_[t];
    if (!is_passive(tree)) continue;
    const double work = work_of_locks(tree);
    const double allowed_work = stored_energy(tree);
    if (!(work > allowed_work)) continue;
    const double uncorrected = uncorrected_work_[t];
    const double fraction =
        uncorrected < allowed_work ? kEnergySafety * (allowed_work - uncorrected) / (work - uncorrected) : 0;
    for (int i = tree.first; i < tree.last; ++i) {
      if (trees_.joint_of(i) >= 0 && drift_.scale(trees_.joint_of(i), fraction)) changed = true;
    }
    for (int i = 0; trees_.has_loops() && i < island_.joints.size(); ++i) {
      if (trees_.node_of_joint(i) < 0 && drift_.scale(i, fraction)) changed = true;
    }
  }
  return changed;
}

void LockEnergy::store() {
  for (const Tree& t : groups_) {
    if (!is_passive(t)) continue;
    double& energy = stored_energy(t);
    const double work = work_of_locks(t);
    energy = std::clamp(energy - (work < 0 ? kReturnedFraction : 1.0) * work, 0.0, kMaxStoredEnergy);
  }
}

}  // namespace limber::sim::solver
