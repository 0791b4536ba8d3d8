// StaggeredFriction: freezes friction's bounds, and starts pivoting from each round.
#include "sim/solver/lcp/staggered_friction.h"

#include <algorithm>

namespace limber::sim::solver {
namespace {

constexpr int kMaxTiedExchanges = 4;
constexpr int kMaxFrictionRounds = 12;
constexpr int kUndampedRounds = 3;  // later rounds move friction's bounds only halfway

}  // namespace

// Moves friction's bounds by `fraction` of the way to those of the present normals, freezes them, and clamps the
// impulses.
void StaggeredFriction::freeze_friction(double fraction) {
  friction_bounds_.resize(lcp_.size());
  lcp_.friction_frozen = false;
  for (int i = 0; i < lcp_.size(); ++i) {
    LcpState::Row& r = lcp_.row(i);
    if (r.normal < 0) continue;
    const double before = friction_bounds_[i];
    lcp_.update_bounds(r);
    const double max_friction = fraction == 1 ? r.upper : before + fraction * (r.upper - before);
    friction_bounds_[i] = r.upper = max_friction;
    r.lower = -max_friction;
  }
  lcp_.friction_frozen = true;
  for (int i = 0; i < lcp_.size(); ++i) {
    const LcpState::Row& r = lcp_.row(i);
    lcp_.queue_impulse(i, std::clamp(r.impulse, r.lower, r.upper));
  }
  lcp_.flush_changes();
}

// Pivots with tied friction from the present solution; returns to it if that doesn't converge.
bool StaggeredFriction::pivot() {
  lcp_.save_impulses(saved_impulses_);
  saved_status_ = lcp_.status;
  const double saved_violation = lcp_.violation;
  lcp_.violation = 1e300;
  if (pivoting_.solve(kMaxTiedExchanges)) return true;
  lcp_.violation = saved_violation;
  lcp_.restore_impulses(saved_impulses_);
  lcp_.recenter();
  lcp_.status = saved_status_;
  return false;
}

bool StaggeredFriction::solve() {
  descent_.reset();
  for (int round = 0; round < kMaxFrictionRounds; ++round) {
    freeze_friction(round < kUndampedRounds ? 1 : 0.5);
    if (round == 0) lcp_.classify_rows();
    if (!descent_.solve()) return false;
    if (round + 1 == kMaxFrictionRounds || lcp_.budget.exceeded()) break;
    lcp_.friction_frozen = false;
    lcp_.violation = lcp_.max_violation();
    if (lcp_.violation <= lcp_.tolerance() || pivot()) return true;
  }
  return true;
}

}  // namespace limber::sim::solver
