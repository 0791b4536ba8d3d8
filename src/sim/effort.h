// Effort: what a step of an island has cost so far, and how exactly its laws still have to be met: less, the more it
// has cost, so that no step takes long. docs/solver.md. No Bullet.
#pragma once

#include <algorithm>

namespace limber {

/// Counted in multiply-adds, not in time: the same on every machine. [sim]
class Effort {
 public:
  /// A step for which about `enough` should do.
  void begin(double enough) {
    enough_ = enough;
    spent_ = kept_ = 0;
  }
  /// What is kept for the step's end, from now on.
  void keep(double work) { kept_ = work; }
  /// Lines of so many numbers each, multiplied and added to others.
  void lines(double count, double numbers) { spent_ += cost(count, numbers); }
  double spent() const { return spent_; }
  /// What a law may be missed by, m/s and rad/s, where `least` is asked for: that while the step is cheap, 0.01 when it
  /// has cost enough.
  double tolerance(double least) const {
    const double part = spent_ / enough_;
    const double square = part * part;
    return std::max(least, kMissed * square * square * square);
  }
  /// Whether it is time for the step's end, or would be after so much more work.
  bool over(double more = 0) const { return spent_ + kept_ + more > kMost * enough_; }
  /// What so many lines cost.
  static double cost(double count, double numbers) { return count * (kLine + numbers); }

 private:
  /// What a line costs besides its numbers.
  static constexpr double kLine = 8;
  static constexpr double kMissed = 1e-2;
  static constexpr double kMost = 1.5;

  double enough_ = 1e300;
  double spent_ = 0;
  double kept_ = 0;
};

}  // namespace limber
