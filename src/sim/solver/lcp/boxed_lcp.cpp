// BoxedLcp: the order of the algorithms.
#include "sim/solver/lcp/boxed_lcp.h"

namespace limber::sim::solver {
namespace {

constexpr int kMaxFirstExchanges = 5;  // from the initial statuses
constexpr int kSweeps = 8;
constexpr int kFinalSweeps = 48;
constexpr int kBriefSweeps = 16;  // once the work budget is exceeded

}  // namespace

double BoxedLcp::solve(double tolerance) {
  requested_tolerance = tolerance;
  begin();
  if (budget.exceeded()) {
    solve_approximately();
  } else {
    solve_fully();
  }
  end();
  return violation;
}

void BoxedLcp::initialize_statuses() {
  classify_rows();
  for (int i = 0; i < size(); ++i) {
    const Row& r = row(i);
    if (r.initial_status != unknown) {
      status[i] = r.initial_status;
    } else if (r.normal >= 0 && r.lower < r.upper) {
      // friction: status that the row would have if it were solved alone
      const double uncoupled_impulse = r.impulse + residuals[i] * inverse_diagonal[i];
      status[i] = uncoupled_impulse < r.lower ? at_lower : uncoupled_impulse > r.upper ? at_upper : free;
    }
  }
}

void BoxedLcp::solve_fully() {
  initialize_statuses();
  if (pivoting_.solve(kMaxFirstExchanges)) return;
  restart_from_guess();
  for (int i = 0; i < kSweeps; ++i) sweep();
  record_violation();
  if (violation <= tolerance()) return;
  if (!staggered_.solve()) {
    final_sweeps();
  } else if (friction_frozen && !budget.exceeded()) {
    path_.solve();
  }
}

// Budget exceeded: sweeps from the initial guess, then one convex problem with frozen friction bounds.
void BoxedLcp::solve_approximately() {
  restart_from_guess();
  sweep(kBriefSweeps);
  classify_rows();
  record_violation();
  if (violation > tolerance() && !staggered_.solve()) final_sweeps();
}

void BoxedLcp::final_sweeps() {
  for (int i = 0; i < kFinalSweeps; ++i) sweep();
  recenter();
  violation = max_violation();
}

double BoxedLcp::refine_friction() {
  begin();
  const double initial_violation = max_violation();
  if (initial_violation > tolerance()) sweep(kBriefSweeps);
  record_violation();
  if (!(violation < initial_violation)) {
    restart();
    violation = initial_violation;
  }
  classify_rows();
  end();
  return violation;
}

}  // namespace limber::sim::solver
