// ClockOut: sends a MIDI clock that follows the beat of the simulation. [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "engine/output/snapshot.h"

namespace limber::midi {

class ClockOut {
 public:
  using Send = std::function<void(std::span<const std::uint8_t> bytes)>;
  static constexpr double kJump = 0.5;            ///< Beats: a larger change is a new song position.
  static constexpr double kMaxUnconfirmed = 0.5;  ///< s: without readings, no pulses are sent after this time.

  /// Sets the newest reading. `now`: s.
  void update(const sim::ClockReading& reading, double now);
  /// Sends the next pulse if its time has come, and start, stop and position before it. Returns the time of the pulse
  /// after it, s; nothing while the clock is stopped.
  std::optional<double> send_due(double now, const Send& send);
  /// Sends stop, if it is running: at the end of the show, or before the port is closed.
  void stop(const Send& send);
  /// The port was opened: the position is sent again.
  void restart() { running_ = false; }

 private:
  double beat_at(double now) const;
  void begin(double beat, const Send& send);

  std::optional<sim::ClockReading> reading_;
  double read_at_ = 0;           // s
  double offset_ = 0;            // beats: corrects the reading's jitter, decays
  bool running_ = false;         // start was sent
  std::int64_t next_pulse_ = 0;  // number of the next pulse; pulse 0 is at beat 0
  double last_sent_ = 0;         // s
};

}  // namespace limber::midi
