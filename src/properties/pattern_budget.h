// PatternBudget: limits the work of matching OSC address patterns. A pattern that exceeds it is rejected as a whole, so
// that no message can delay a tick.
#pragma once

#include <string_view>

#include "base/text.h"

namespace limber {

/// Counts matching steps, which take a few nanoseconds each.
struct PatternBudget {
  static constexpr int kStepsPerMessage = 1'000'000;  ///< Budget of a message: a few milliseconds.
  static constexpr int kStepsPerName = 6;             ///< Cost of visiting a name.

  int remaining = kStepsPerMessage;

  bool exceeded() const { return remaining < 0; }
  /// Subtracts the steps. Returns false if the budget is exceeded.
  bool charge(int steps) {
    remaining -= steps;
    return remaining >= 0;
  }
  /// Returns pattern_match() and charges its steps; false also if the budget is exceeded.
  bool match(std::string_view pattern, std::string_view name) {
    int steps = kStepsPerName;
    const bool hit = pattern_match(pattern, name, &steps);
    return charge(steps) && hit;
  }
};

}  // namespace limber
