// GyroscopicCorrection: residuals of the fixed point, and the least-squares weights of the last two passes.
#include "sim/solver/gyroscopic_correction.h"

#include <algorithm>

namespace limber::sim::solver {
namespace {

constexpr int kMaxGyroPasses = 10;
/// Tolerances, relative to the angular velocity perpendicular to the spin, and to the whole angular velocity.
constexpr double kGyroTolerance = 1e-5;
constexpr double kGyroSpinTolerance = 1e-7;

}  // namespace

void GyroscopicCorrection::begin() {
  impulses_.clear();
  passes_ = 0;
  for (const Tree& t : trees_) {
    if (trees_.is_single_body(t)) continue;
    for (int i = t.first; i < t.last; ++i) {
      const btSolverBody& b = trees_.body(i);
      const double before = static_cast<double>(b.m_angularVelocity.length());
      const double after = glm::length(trees_.velocity(trees_.body_of(i)).angular);
      if (!(std::max(before, after) * island_.h > bullet::kSlowRotation)) continue;
      const Sym3& moment = trees_.axes.forest.node(i).inertia.moment;
      const Vec3 applied = moment * bullet::gyroscopic_change(*b.m_originalBody, island_.h);
      impulses_.push_back({i, (moment.xx + moment.yy + moment.zz) / 3, applied, Vec3(0), {}, {}});
    }
  }
}

// Returns true if a residual exceeds its tolerance.
bool GyroscopicCorrection::update_residuals() {
  bool pending = false;
  for (Impulse& g : impulses_) {
    const int body = trees_.body_of(g.node);
    const Vec3 before = island_.start_velocity(body).angular;
    const Vec3 middle = (before + trees_.velocity(body).angular) / 2.0;
    const btRigidBody& rigid = island_.rigid(body);
    const Vec3 residual = island_.h * bullet::gyroscopic_torque(rigid, middle, island_.h) - g.applied;
    g.residual_changes[1] = g.residual_changes[0];
    g.residual_changes[0] = residual - g.residual;
    g.residual = residual;
    const double tumble_speed = glm::length(bullet::split_rotation(rigid, middle, island_.h).tumble);
    const double tolerance = kGyroTolerance * tumble_speed + kGyroSpinTolerance * glm::length(middle);
    pending = pending || glm::length(residual) > tolerance * g.scale;
  }
  return pending;
}

// Weights that minimize |residual - sum of weight·change| over the last passes.
FixedArray<double, 2> GyroscopicCorrection::mixing_weights(int history) const {
  double normal[2][2] = {};
  double rhs[2] = {};
  for (const Impulse& g : impulses_) {
    const double scale = 1 / (g.scale * g.scale);
    for (int i = 0; i < history; ++i) {
      rhs[i] += scale * glm::dot(g.residual_changes[i], g.residual);
      for (int j = 0; j < history; ++j) normal[i][j] += scale * glm::dot(g.residual_changes[i], g.residual_changes[j]);
    }
  }
  FixedArray<double, 2> weights{};
  const double determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
  if (history == 2 && determinant > 1e-9 * normal[0][0] * normal[1][1]) {
    weights[0] = (rhs[0] * normal[1][1] - rhs[1] * normal[0][1]) / determinant;
    weights[1] = (rhs[1] * normal[0][0] - rhs[0] * normal[1][0]) / determinant;
  } else if (history > 0 && normal[0][0] > 0) {
    weights[0] = rhs[0] / normal[0][0];
  }
  return weights;
}

bool GyroscopicCorrection::correct() {
  if (empty() || passes_ >= kMaxGyroPasses || !update_residuals()) return false;
  const int history = std::min(passes_++, 2);
  const FixedArray<double, 2> weights = mixing_weights(history);
  for (Impulse& g : impulses_) {
    Vec3 change = g.residual;
    for (int i = 0; i < history; ++i) change -= weights[i] * (g.applied_changes[i] + g.residual_changes[i]);
    g.applied_changes[1] = g.applied_changes[0];
    g.applied_changes[0] = change;
    g.applied += change;
    trees_.axes.forest.node(g.node).load.angular += change;
  }
  return true;
}

}  // namespace limber::sim::solver
