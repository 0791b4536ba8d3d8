// Spin clamp: if a body rotates by more than kMaxTurnPerStep in a step, Bullet rotates it by less than its angular
// velocity implies. In a tree with such a body (spins, see spin.h, excluded) the motion relative to the tree's rigid
// motion is scaled down. Momentum and every homogeneous constraint on the rates are unaffected.
#include <algorithm>

#include "sim/solver/direct_solver.h"

namespace limber {
namespace {

/// Target of the clamp after the solve, as a fraction of kMaxTurnPerStep, since contacts and motors will restore some
/// of the motion.
constexpr double kClampTarget = 0.5;
/// Margin that tolerates rotations that were just clamped to kMaxTurnPerStep.
constexpr double kClampTolerance = 1.01;

Vec3 center_of(const btRigidBody& body) { return from_bt(body.getCenterOfMassPosition()); }

}  // namespace

Vec3 DirectSolver::angular_velocity(int node, const IslandPools& pools, ClampStage stage) const {
  const int body = body_of_[at(node)];
  if (stage == ClampStage::after) return solved_velocity(body, pools).angular;
  return from_bt(pools.bodies[body].m_angularVelocity);
}

// Velocity of a body without its spin.
Spatial DirectSolver::velocity_without_spin(int node, const IslandPools& pools, ClampStage stage, double h) const {
  const int body = body_of_[at(node)];
  const btSolverBody& b = pools.bodies[body];
  Spatial v{from_bt(b.m_linearVelocity), from_bt(b.m_angularVelocity)};
  if (stage == ClampStage::after) v = velocity(body, pools) + tree_rows_.change(node);
  const RotationStep turn = rotation_step(body, v.angular, pools, h);
  return {v.linear - turn.spin * glm::cross(turn.axis, turn.lever), turn.tumble};
}

// Rigid motion of a floating tree with the same momentum and angular momentum; zero for a tree attached to a static
// body.
DirectSolver::RigidMotion DirectSolver::rigid_motion(const Tree& tree, const IslandPools& pools, ClampStage stage,
                                                     double h) const {
  RigidMotion rigid;
  if (link_of_[at(tree.first)] >= 0) return rigid;
  const auto center = [&](int node) { return center_of(*pools.bodies[body_of_[at(node)]].m_originalBody); };
  // without add_geometric_inertia(), which has no momentum
  const auto inertia = [&](int node) { return inertia_of(*pools.bodies[body_of_[at(node)]].m_originalBody); };
  double mass = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    mass += inertia(i).mass.xx;
    rigid.center += center(i) * inertia(i).mass.xx;
  }
  rigid.center /= mass;
  // momentum and inertia of the whole tree about its center
  SpatialInertia tree_inertia;
  Spatial momentum;
  for (int i = tree.first; i < tree.last; ++i) {
    const Vec3 arm = center(i) - rigid.center;
    tree_inertia.add_translated(inertia(i), arm);
    momentum += translated_back(inertia(i) * velocity_without_spin(i, pools, stage, h), arm);
  }
  const Sym3& m = tree_inertia.moment;
  const Mat3 moment(Vec3(m.xx, m.xy, m.xz), Vec3(m.xy, m.yy, m.yz), Vec3(m.xz, m.yz, m.zz));
  rigid.velocity = {momentum.linear / mass, glm::inverse(moment) * momentum.angular};
  return rigid;
}

// Clamps all trees. Returns true if something changed; the forest must then be rebuilt, starting from the changed
// velocities.
bool DirectSolver::clamp_spin(IslandPools& pools, double h, ClampStage stage) {
  bool changed = false;
  for (const Tree& t : trees_) {
    if (t.last - t.first == 1 && link_of_[at(t.first)] < 0) continue;
    double fastest = 0;
    for (int i = t.first; i < t.last; ++i) {
      const Vec3 w = angular_velocity(i, pools, stage);
      if (glm::dot(w, w) * h * h <= kMaxRotationPerStep * kMaxRotationPerStep) continue;
      fastest = std::max(fastest, glm::length(velocity_without_spin(i, pools, stage, h).angular));
    }
    if (!(fastest * h > kClampTolerance * kMaxRotationPerStep)) continue;
    const RigidMotion rigid = rigid_motion(t, pools, stage, h);
    fastest = 0;
    for (int i = t.first; i < t.last; ++i) {
      fastest =
          std::max(fastest, glm::length(velocity_without_spin(i, pools, stage, h).angular - rigid.velocity.angular));
    }
    if (!(fastest * h > kClampTolerance * kMaxRotationPerStep)) continue;
    if (!changed && before_clamp_.empty()) {
      for (int i = 0; i < pools.bodies.size(); ++i)
        before_clamp_.emplace_back(pools.bodies[i].m_deltaLinearVelocity, pools.bodies[i].m_deltaAngularVelocity);
    }
    changed = true;
    const double scale_change =
        (stage == ClampStage::before ? 1 : kClampTarget) * kMaxRotationPerStep / (fastest * h) - 1;
    for (int i = t.first; i < t.last; ++i) {
      btSolverBody& body = pools.bodies[body_of_[at(i)]];
      const Vec3 arm = center_of(*body.m_originalBody) - rigid.center;
      const Spatial relative = velocity_without_spin(i, pools, stage, h) - translated(rigid.velocity, arm);
      if (glm::length(relative.angular) * h > kClampTolerance * kMaxRotationPerStep) {
        record_clamp(*body.m_originalBody, -glm::length(relative.angular) * scale_change);
      }
      body.m_deltaLinearVelocity += to_bt(relative.linear * scale_change);
      body.m_deltaAngularVelocity += to_bt(relative.angular * scale_change);
    }
  }
  return changed;
}

// Restores the velocity changes for the iterative solver.
void DirectSolver::undo_spin_clamp(IslandPools& pools) const {
  for (std::size_t i = 0; i < before_clamp_.size(); ++i) {
    btSolverBody& body = pools.bodies[static_cast<int>(i)];
    body.m_deltaLinearVelocity = before_clamp_[i].first;
    body.m_deltaAngularVelocity = before_clamp_[i].second;
  }
}

}  // namespace limber
