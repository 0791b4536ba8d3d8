// The history as a bar: its right end is the present, its length the configured history, its filled part the time that
// can be rewound.
#pragma once

namespace limber {

struct HistoryRange {
  double length = 0;      ///< Length of the bar, s; 0: history is off.
  double rewindable = 0;  ///< Time that can be rewound, s.
};

/// The user presses or drags to a time and releases. Returns the seconds to rewind once on release, otherwise 0.
/// `dragged_back` is the dragged time in s; the caller stores it between frames.
double history_bar(const char* id, const HistoryRange& range, float width, double& dragged_back);

}  // namespace limber
