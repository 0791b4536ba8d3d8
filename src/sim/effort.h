// Effort: what a step of an island has cost so far, and whether that is enough: then laws have to be met less exactly,
// so that no step takes long. docs/solver.md. No Bullet.
#pragma once

#include <algorithm>

namespace limber {

/// Counted in multiply-adds, not in time: the same on every machine. [sim]
class Effort {
 public:
  void begin() { spent_ = 0; }
  /// About so much should do for the step.
  void allow(double enough) { enough_ = enough; }
  /// Lines of so many numbers each, multiplied and added to others.
  void lines(double count, double numbers) { spent_ += count * (kLine + numbers); }
  double spent() const { return spent_; }
  /// What a law may be missed by, m/s and rad/s, where `least` is asked for.
  double tolerance(double least) const { return over() ? std::max(least, kMissed) : least; }
  /// Whether it has cost enough, or would have after so much more work: from here on what is near has to do.
  bool over(double more = 0) const { return spent_ + more > enough_; }

 private:
  /// What a line costs besides its numbers.
  static constexpr double kLine = 8;
  static constexpr double kMissed = 1e-2;

  double enough_ = 1e300;
  double spent_ = 0;
};

}  // namespace limber
