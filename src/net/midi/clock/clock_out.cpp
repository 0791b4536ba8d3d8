// ClockOut: the beat between two readings, and song positions.
#include "net/midi/clock/clock_out.h"

#include <algorithm>
#include <cmath>

#include "net/midi/clock/clock_in.h"

namespace limber::midi {

namespace {

constexpr std::uint8_t kPulse = 0xf8;
constexpr std::uint8_t kStart = 0xfa;
constexpr std::uint8_t kContinue = 0xfb;
constexpr std::uint8_t kStop = 0xfc;
constexpr std::uint8_t kPosition = 0xf2;
constexpr int kPulsesPerStep = kPulsesPerBeat / 4;  // song positions count sixteenths
constexpr std::int64_t kMaxPosition = 16383;
constexpr double kJitterShare = 0.8;  // of the distance from the extrapolated beat that stays for the next reading

}  // namespace

double ClockOut::beat_at(double now) const {
  return reading_->beat + offset_ + (now - read_at_) * reading_->tempo / 60;
}

// Readings arrive at irregular times: the extrapolated beat approaches them.
void ClockOut::update(const sim::ClockReading& reading, double now) {
  const bool follows = reading_ && reading_->playing && reading.playing;
  const double distance = follows ? beat_at(now) - reading.beat : 0;
  offset_ = std::abs(distance) <= kJump ? kJitterShare * distance : 0;
  reading_ = reading;
  reading_->tempo = std::clamp(reading.tempo, sim::kMinTempo, sim::kMaxTempo);
  read_at_ = now;
}

// Starts at the next sixteenth.
void ClockOut::begin(double beat, const Send& send) {
  const auto steps = static_cast<std::int64_t>(std::ceil(std::max(beat, 0.0) * 4 - 1e-9));
  next_pulse_ = steps * kPulsesPerStep;
  running_ = true;
  if (steps == 0) return send(std::array{kStart});
  const std::int64_t position = std::min(steps, kMaxPosition);
  send(std::array{kPosition, static_cast<std::uint8_t>(position & 0x7f), static_cast<std::uint8_t>(position >> 7)});
  send(std::array{kContinue});
}

void ClockOut::stop(const Send& send) {
  if (running_) send(std::array{kStop});
  running_ = false;
}

std::optional<double> ClockOut::send_due(double now, const Send& send) {
  if (!reading_) return std::nullopt;
  if (!reading_->playing) {
    stop(send);
    return std::nullopt;
  }
  if (now - read_at_ > kMaxUnconfirmed) return std::nullopt;
  const double beat = beat_at(now);
  const double beats_per_second = reading_->tempo / 60;
  // MIDI has no position before beat 0
  if (beat < -kJump) {
    stop(send);
    return now - (beat + kJump) / beats_per_second;
  }
  const double next_beat = static_cast<double>(next_pulse_) / kPulsesPerBeat;
  if (running_ && std::abs(beat - next_beat) > kJump) stop(send);
  if (!running_) begin(beat, send);
  const double period = 1 / (beats_per_second * kPulsesPerBeat);
  const auto due_at = [&] {
    const double due = now + (static_cast<double>(next_pulse_) / kPulsesPerBeat - beat) / beats_per_second;
    // pulses that are late follow at twice the tempo, not at once
    return std::max(due, last_sent_ + period / 2);
  };
  if (due_at() > now + 1e-9) return due_at();
  send(std::array{kPulse});
  next_pulse_++;
  last_sent_ = now;
  return due_at();
}

}  // namespace limber::midi
