// ClockReading: the state of musical time, for snapshots, and the limits of its tempo. [any]
#pragma once

namespace limber::sim {

inline constexpr double kMinTempo = 20, kMaxTempo = 999;  ///< Beats per minute.

struct ClockReading {
  double beat = 0;
  double tempo = 120;      ///< Beats per minute at which they pass.
  double set_tempo = 120;  ///< The setting.
  double beats_per_bar = 4;
  bool playing = true;
};

}  // namespace limber::sim
