// The past as a bar: its right end is now, its length what is kept of the past, filled as far as time can go back.
#pragma once

namespace limber {

struct PastRange {
  double kept = 0;        ///< s that the whole bar stands for; 0: history is off.
  double rewindable = 0;  ///< s that there are.
};

/// A hand presses or drags to a moment and lets go: the seconds to go back, once; else 0. `held` is what the hand
/// holds meanwhile, s; the caller keeps it from frame to frame.
double history_bar(const char* id, const PastRange& past, float width, double& held);

}  // namespace limber
