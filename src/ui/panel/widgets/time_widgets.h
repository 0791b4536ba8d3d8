// Simulated time in the panel: the clock, and the history as a bar.
#pragma once

#include <string>

namespace limber::panel {

/// Returns minutes and seconds, "01:23.45"; hundredths are truncated, not rounded.
std::string clock_text(double seconds);

struct HistoryRange {
  double length = 0;      ///< Length of the bar, s; 0: history is off.
  double rewindable = 0;  ///< Time that can be rewound, s.
};

/// A bar whose right end is the present, whose length the configured history, and whose filled part the time that can
/// be rewound. The user presses or drags to a time and releases. Returns the seconds to rewind once on release,
/// otherwise 0. `dragged_back` is the dragged time in s; the caller stores it between frames.
double history_bar(const char* id, const HistoryRange& range, float width, double& dragged_back);

}  // namespace limber::panel
