// SpinClamp: clamps velocities relative to the tree's rigid motion, and limits the target rates of motors.
#include "sim/solver/spin_clamp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace limber::sim::solver {
namespace {

/// Target of the clamp after the solve, as a fraction of kMaxRotationPerStep, since contacts and motors will restore
/// some of the motion.
constexpr double kClampTarget = 0.5;
/// Margin that tolerates rotations that were just clamped to kMaxRotationPerStep.
constexpr double kClampTolerance = 1.01;
/// Motors and limits must not rotate a body by more than this in one step, rad; otherwise their rates are scaled down
/// to a rotation of kRotationGoal, which is less, since the other causes of the rotation don't scale with them.
constexpr double kMaxRotation = 0.5;
constexpr double kRotationGoal = 0.44;

Vec3 center_of(const btRigidBody& body) { return bullet::from_bt(body.getCenterOfMassPosition()); }

}  // namespace

Spatial SpinClamp::velocity(int node, Stage stage) const {
  const int body = trees_.body_of(node);
  return stage == Stage::after ? trees_.velocity(body) : island_.start_velocity(body);
}

Spatial SpinClamp::velocity_without_spin(int node, Stage stage) const {
  const Spatial v = velocity(node, stage);
  const bullet::RotationStep turn = island_.rotation_step(trees_.body_of(node), v.angular);
  return {v.linear - turn.spin * glm::cross(turn.axis, turn.lever), turn.tumble};
}

// Rigid motion of a floating tree with the same momentum and angular momentum; zero for a tree attached to a static
// body.
SpinClamp::RigidMotion SpinClamp::rigid_motion(const Tree& tree, Stage stage) const {
  RigidMotion rigid;
  if (trees_.joint_of(tree.first) >= 0) return rigid;
  const auto center = [&](int node) { return center_of(trees_.rigid(node)); };
  // without geometric stiffness, which has no momentum
  const auto inertia = [&](int node) { return inertia_of(trees_.rigid(node)); };
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
    momentum += translated_back(inertia(i) * velocity_without_spin(i, stage), arm);
  }
  const Sym3& m = tree_inertia.moment;
  const Mat3 moment(Vec3(m.xx, m.xy, m.xz), Vec3(m.xy, m.yy, m.yz), Vec3(m.xz, m.yz, m.zz));
  rigid.velocity = {momentum.linear / mass, glm::inverse(moment) * momentum.angular};
  return rigid;
}

double SpinClamp::fastest_rotation(const Tree& tree, Stage stage) const {
  double fastest = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    const Vec3 w = velocity(i, stage).angular;
    if (glm::dot(w, w) * island_.h * island_.h <= bullet::kMaxRotationPerStep * bullet::kMaxRotationPerStep) continue;
    fastest = std::max(fastest, glm::length(velocity_without_spin(i, stage).angular));
  }
  return fastest;
}

double SpinClamp::fastest_relative_rotation(const Tree& tree, Stage stage, const RigidMotion& rigid) const {
  double fastest = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    fastest = std::max(fastest, glm::length(velocity_without_spin(i, stage).angular - rigid.velocity.angular));
  }
  return fastest;
}

// Scales the motion of a body relative to the rigid motion.
void SpinClamp::scale_motion(int node, Stage stage, const RigidMotion& rigid, double scale_change) {
  btSolverBody& body = trees_.body(node);
  const Vec3 arm = center_of(*body.m_originalBody) - rigid.center;
  const Spatial relative = velocity_without_spin(node, stage) - translated(rigid.velocity, arm);
  if (glm::length(relative.angular) * island_.h > kClampTolerance * bullet::kMaxRotationPerStep) {
    bullet::record_clamp(*body.m_originalBody, -glm::length(relative.angular) * scale_change);
  }
  body.m_deltaLinearVelocity += bullet::to_bt(relative.linear * scale_change);
  body.m_deltaAngularVelocity += bullet::to_bt(relative.angular * scale_change);
}

bool SpinClamp::clamp(Stage stage) {
  const double h = island_.h;
  bool changed = false;
  for (const Tree& t : trees_) {
    if (trees_.is_single_body(t)) continue;
    if (!(fastest_rotation(t, stage) * h > kClampTolerance * bullet::kMaxRotationPerStep)) continue;
    const RigidMotion rigid = rigid_motion(t, stage);
    const double fastest = fastest_relative_rotation(t, stage, rigid);
    if (!(fastest * h > kClampTolerance * bullet::kMaxRotationPerStep)) continue;
    if (before_.empty()) {
      for (int i = 0; i < island_.pools->bodies.size(); ++i)
        before_.emplace_back(island_.body(i).m_deltaLinearVelocity, island_.body(i).m_deltaAngularVelocity);
    }
    changed = true;
    const double scale_change =
        (stage == Stage::before ? 1 : kClampTarget) * bullet::kMaxRotationPerStep / (fastest * h) - 1;
    for (int i = t.first; i < t.last; ++i) scale_motion(i, stage, rigid, scale_change);
  }
  return changed;
}

void SpinClamp::undo() const {
  for (int i = 0; i < before_.size(); ++i) {
    island_.body(i).m_deltaLinearVelocity = before_[i].first;
    island_.body(i).m_deltaAngularVelocity = before_[i].second;
  }
}

// True if a motor on this axis of a joint drives a spin of one of its bodies.
bool SpinClamp::drives_spin(int index, int axis) const {
  if (index < 0 || axis < 3) return false;
  const Island::Joint& joint = island_.joints[index];
  const Vec3 axis_direction = bullet::from_bt(joint.constraint->pose().linear_axis(axis - 3));
  return std::ranges::any_of(std::array{joint.body_a, joint.body_b}, [&](int body) {
    const bullet::RotationStep turn = island_.rotation_step(body, trees_.velocity(body).angular);
    return turn.spin != 0 && std::fabs(glm::dot(turn.axis, axis_direction)) > 0.99;
  });
}

// Fastest rotation without spin in a tree with joints; 0: none of its bodies rotates too far. Records those that do.
double SpinClamp::fastest_tumbling(const Tree& tree) const {
  const double h = island_.h;
  double fastest = 0;
  for (int i = tree.first; i < tree.last; ++i) {
    const Spatial v = trees_.velocity(trees_.body_of(i));
    if (glm::dot(v.angular, v.angular) * h * h <= kMaxRotation * kMaxRotation) continue;
    const double tumble_speed = glm::length(island_.rotation_step(trees_.body_of(i), v.angular).tumble);
    if (!trees_.is_single_body(tree)) fastest = std::max(fastest, tumble_speed);
    if (tumble_speed * h > kMaxRotation) bullet::record_clamp(trees_.rigid(i), tumble_speed - kRotationGoal / h);
  }
  return fastest;
}

bool SpinClamp::limit_target_rates() {
  bool changed = false;
  for (const Tree& t : trees_) {
    const double rotation = fastest_tumbling(t) * island_.h;
    if (!(rotation > kMaxRotation)) continue;
    for (int i = t.first; i < t.last; ++i) {
      for (AxisRow& row : trees_.axes.rows(i)) {
        if (!row.bounded() || row.constant() || drives_spin(trees_.joint_of(i), row.axis)) continue;
        row.velocity *= kRotationGoal / rotation;
        changed = true;
      }
    }
  }
  return changed;
}

}  // namespace limber::sim::solver
