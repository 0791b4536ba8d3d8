// Clocks: the readouts of /clock.
#include "net/midi/clock/clocks.h"

#include <cmath>

namespace limber::midi {

namespace {

std::optional<double> clock_value(const engine::ValueSnapshot& snapshot, std::string_view path) {
  const Result<TreePropertyRef> found = snapshot.tree->find(path);
  if (!found || found->property == nullptr) return std::nullopt;
  const engine::PropertyValue value = snapshot.value(snapshot.tree->location(*found));
  if (value.numbers == nullptr || !std::isfinite(value.numbers[0])) return std::nullopt;
  return value.numbers[0];
}

}  // namespace

void Clocks::accept(const MidiMessage& message, std::int64_t time) { in_.accept(message, seconds(time)); }

std::optional<BeatReading> Clocks::reading_of(const engine::ValueSnapshot& snapshot) {
  const std::optional<double> beat = clock_value(snapshot, "/clock/beat");
  const std::optional<double> tempo = clock_value(snapshot, "/clock/tempo");
  const std::optional<double> playing = clock_value(snapshot, "/clock/playing");
  if (!beat || !tempo || !playing) return std::nullopt;
  const bool paused = snapshot.snapshot != nullptr && snapshot.snapshot->paused;
  return BeatReading{*beat, *tempo, *playing != 0 && !paused};
}

void Clocks::update(const engine::ValueSnapshot& snapshot, std::int64_t now) {
  if (snapshot.number == snapshot_) return;
  snapshot_ = snapshot.number;
  if (const std::optional<BeatReading> reading = reading_of(snapshot)) out_.update(*reading, seconds(now));
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
