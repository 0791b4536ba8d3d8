// SplitImpulse: an LCP of the normals that penetrate, and of loops, which must not open.
#include "sim/solver/split_impulse.h"

#include <algorithm>

namespace limber::sim::solver {
namespace {

/// Softness of rows, relative to the response of their bodies alone: penetration is not corrected if joints reduce the
/// response to less than about this fraction.
constexpr double kMinSplitSoftness = 1e-3;
/// Largest speed of penetration correction, m/s.
constexpr double kMaxSplitSpeed = 2;
/// Largest rotation of a body by the penetration correction of one step, rad. The correction of the whole island is
/// scaled down to it, because rotating a body without changing its velocity changes its energy.
constexpr double kMaxSplitRotation = 0.05;

double target_speed(const CoupledRow& row) {
  const double step = static_cast<double>(row.contact->m_jacDiagABInv);
  return step > 0 ? std::min(static_cast<double>(row.contact->m_rhsPenetration) / step, kMaxSplitSpeed) : 0;
}

}  // namespace

void SplitImpulse::apply() {
  if (!gather_rows()) return;
  solve();
  respond();
  write();
}

// Returns false if nothing penetrates.
bool SplitImpulse::gather_rows() {
  if (std::none_of(rows_.begin(), rows_.end(),
                   [](const CoupledRow& r) { return r.is_normal() && target_speed(r) > 0; }))
    return false;
  lcp_rows_.clear();
  for (int i = 0; i < rows_.fixed_count(); ++i) {
    const CoupledRow& row = rows_[i];
    if (row.is_normal() || (row.loop && row.lower < -AxisRow::kInfinity && row.upper > AxisRow::kInfinity))
      lcp_rows_.push_back(i);
  }
  return true;
}

void SplitImpulse::solve() {
  delassus_.build(lcp_, lcp_rows_);
  for (int i = 0; i < lcp_.size(); ++i) {
    const CoupledRow& row = rows_[lcp_rows_[i]];
    BoxedLcp::Row& lcp_row = lcp_.row(i);
    lcp_row.residual = row.loop ? 0 : target_speed(row);
    lcp_row.lower = row.loop ? row.lower : 0;
    lcp_row.upper = row.upper;
    lcp_.response(i, i) += row.softness + kMinSplitSoftness * row.mobility;
  }
  lcp_.solve(CoupledRows::kTolerance);
}

// Computes the velocities that the impulses give the bodies.
void SplitImpulse::respond() {
  Forest& forest = trees_.axes.forest;
  for (int i = 0; i < forest.size(); ++i) {
    forest.node(i).input.fill(0);
    forest.node(i).load = {};
  }
  for (int i = 0; i < lcp_.size(); ++i) rows_.apply_load(rows_[lcp_rows_[i]], lcp_.row(i).impulse);
  for (const Tree& t : trees_) forest.respond(t.first, t.last);
}

void SplitImpulse::write() const {
  const Forest& forest = trees_.axes.forest;
  const double max_angular = kMaxSplitRotation / island_.h;
  double fastest = max_angular;
  for (int i = 0; i < forest.size(); ++i) {
    fastest = std::max(fastest, glm::length(forest.node(i).velocity_change.angular));
  }
  const double turn_erp = static_cast<double>(island_.info->m_splitImpulseTurnErp);  // Bullet multiplies by it
  for (int i = 0; i < forest.size(); ++i) {
    const Spatial change = forest.node(i).velocity_change * (max_angular / fastest);
    trees_.body(i).m_pushVelocity = bullet::to_bt(change.linear);
    trees_.body(i).m_turnVelocity = bullet::to_bt(change.angular / turn_erp);
  }
}

}  // namespace limber::sim::solver
