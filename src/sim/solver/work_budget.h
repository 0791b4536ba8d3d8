// WorkBudget: counts the work of a solver step on an island. Beyond its limit, rows are solved with a larger tolerance,
// which bounds the time of a step. docs/understand/solver.md. Doesn't depend on Bullet.
#pragma once

#include <algorithm>

namespace limber::sim::solver {

/// Work is counted in multiply-adds instead of time, so that results are the same on every machine. [sim]
class WorkBudget {
 public:
  static constexpr double kUnlimited = 1e300;

  /// Starts a step.
  void reset() { spent_ = 0; }
  /// Sets the limit of the step, in multiply-adds.
  void set_limit(double limit) { limit_ = limit; }
  /// Counts `count` vector operations of `elements` elements each.
  void charge(double count, double elements) { spent_ += count * (kVectorOverhead + elements); }
  double spent() const { return spent_; }
  /// Tolerance of a row, m/s and rad/s: `requested`, or more if the limit is exceeded.
  double tolerance(double requested) const { return exceeded() ? std::max(requested, kRelaxedTolerance) : requested; }
  /// True if the work, plus `more`, exceeds the limit.
  bool exceeded(double more = 0) const { return spent_ + more > limit_; }

 private:
  /// Fixed overhead per vector operation, in multiply-adds.
  static constexpr double kVectorOverhead = 8;
  static constexpr double kRelaxedTolerance = 1e-2;

  double limit_ = kUnlimited;
  double spent_ = 0;
};

}  // namespace limber::sim::solver
