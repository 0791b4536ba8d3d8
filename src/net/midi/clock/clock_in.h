// ClockIn: follows a MIDI clock: estimates tempo and beat from the times of its pulses. [one thread]
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "base/message.h"
#include "net/midi/decoder.h"

namespace limber::midi {

inline constexpr int kPulsesPerBeat = 24;

/// A line through the times of pulses: pulse i is expected at `begin` + `period` · i.
struct PulseLine {
  double begin = 0;   ///< s
  double period = 0;  ///< s
  double at(double pulse) const { return begin + period * pulse; }
};

/// Fits a line to the times of numbered pulses. Pulses may be late, be lost, or arrive together. [one thread]
class PulseTracker {
 public:
  static constexpr std::size_t kWindow = 48;    ///< Pulses of the fit: two beats.
  static constexpr std::size_t kMinPulses = 7;  ///< Before the first estimate.
  static constexpr double kTimeout = 1;         ///< s without pulses after which the estimate starts again.

  /// A pulse has arrived. `time`: s.
  void accept(double time);
  /// The number of the next pulse becomes `number`; the tempo stays.
  void restart(std::int64_t number);
  /// The estimate; nothing before enough pulses have arrived, or after the timeout.
  const std::optional<PulseLine>& line() const { return line_; }
  /// Number of the last pulse.
  std::int64_t number() const { return next_ - 1; }

 private:
  struct Pulse {
    double number = 0;
    double time = 0;
  };
  void correct_lost();
  void follow_tempo();
  void fit();

  std::deque<Pulse> pulses_;
  std::int64_t next_ = 0;
  std::optional<PulseLine> line_;
  bool restarted_ = false;
};

class ClockIn {
 public:
  /// Accepts a message of the clock. `time`: s, of its arrival.
  void accept(const MidiMessage& message, double time);
  /// Returns the messages for the simulation since the last call: /clock/playing when it changes, /clock/sync once per
  /// beat. `now`: s.
  std::vector<Message> drain(double now);

 private:
  void accept_pulse(double time);
  void set_playing(bool playing);

  PulseTracker tracker_;
  std::optional<bool> playing_;  // nothing: neither start nor stop has arrived
  bool playing_changed_ = false;
  bool begins_ = false;        // the next pulse is the first after a start
  std::int64_t position_ = 0;  // number of the first pulse after a start
  std::optional<std::int64_t> synced_beat_;
  bool due_ = false;
};

}  // namespace limber::midi
