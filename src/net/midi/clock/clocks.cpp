// Clocks: from snapshots to devices, and back.
#include "net/midi/clock/clocks.h"

namespace limber::midi {

void Clocks::accept(const MidiMessage& message, std::int64_t time) { in_.accept(message, seconds(time)); }

void Clocks::update(const engine::Snapshot& snapshot, std::int64_t now) {
  if (snapshot.tick == tick_ && !snapshot.paused) return;
  tick_ = snapshot.tick;
  sim::ClockReading reading = snapshot.clock;
  reading.playing = reading.playing && !snapshot.paused;
  out_.update(reading, seconds(now));
}

ClockOut::Send Clocks::sender(Devices& devices) {
  return [&devices](std::span<const std::uint8_t> bytes) {
    for (const Device& device : devices.list()) {
      if (device.output != nullptr && devices.is_clock_target(device)) device.output->send(bytes);
    }
  };
}

std::optional<std::int64_t> Clocks::send_due(Devices& devices, std::int64_t now) {
  const std::optional<double> next = out_.send_due(seconds(now), sender(devices));
  if (!next) return std::nullopt;
  return now + static_cast<std::int64_t>((*next - seconds(now)) * 1e9);
}

void Clocks::stop(Devices& devices) { out_.stop(sender(devices)); }

}  // namespace limber::midi
