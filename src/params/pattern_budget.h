// PatternBudget: how much work patterns may be. One that asks for more is refused whole, so that no message, whatever
// stands in it, holds up a tick.
#pragma once

#include <string_view>

#include "base/text.h"

namespace limber {

/// Counted in steps of matching, some nanoseconds each.
struct PatternBudget {
  static constexpr int kMessage = 1'000'000;  ///< A few milliseconds.
  static constexpr int kName = 6;             ///< A name that is looked at.

  int left = kMessage;

  bool over() const { return left < 0; }
  /// False: it is used up.
  bool spend(int steps) {
    left -= steps;
    return left >= 0;
  }
  /// pattern_match, at this budget's cost.
  bool match(std::string_view pattern, std::string_view name) {
    int steps = kName;
    const bool hit = pattern_match(pattern, name, &steps);
    return spend(steps) && hit;
  }
};

}  // namespace limber
