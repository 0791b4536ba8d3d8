// Clocks: MIDI clock from and to devices. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/output/snapshot.h"
#include "net/midi/clock/clock_in.h"
#include "net/midi/clock/clock_out.h"
#include "net/midi/devices.h"

namespace limber::midi {

class Clocks {
 public:
  /// Accepts a message of the device whose clock is followed. `time`: ns.
  void accept(const MidiMessage& message, std::int64_t time);
  /// Returns the messages for the simulation.
  std::vector<Message> drain(std::int64_t now) { return in_.drain(seconds(now)); }
  /// Reads the beat of a snapshot. `now`: ns.
  void update(const engine::Snapshot& snapshot, std::int64_t now);
  /// Sends the next pulse to the devices that get a clock, if its time has come. Returns the time of the next call, ns.
  std::optional<std::int64_t> send_due(Devices& devices, std::int64_t now);
  /// Sends stop to them.
  void stop(Devices& devices);
  /// The devices have changed: the position is sent again.
  void restart() { out_.restart(); }

 private:
  static double seconds(std::int64_t nanoseconds) { return static_cast<double>(nanoseconds) * 1e-9; }
  static ClockOut::Send sender(Devices& devices);

  ClockIn in_;
  ClockOut out_;
  std::uint64_t tick_ = 0;  // of the last snapshot
};

}  // namespace limber::midi
