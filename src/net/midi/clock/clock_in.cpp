// PulseTracker: least squares, with pulses that are far off left out; ClockIn: its messages.
#include "net/midi/clock/clock_in.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/output/snapshot.h"

namespace limber::midi {

namespace {

using sim::kMaxTempo;
using sim::kMinTempo;

constexpr double kMinPeriod = 60 / (kMaxTempo * kPulsesPerBeat);
constexpr double kMaxPeriod = 60 / (kMinTempo * kPulsesPerBeat);
constexpr std::size_t kRecent = 8;  // pulses that show a loss or a new tempo

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Least squares of the points that `use` accepts. Nothing if there are fewer than two.
template <class Pulses, class Use>
std::optional<PulseLine> fit_line(const Pulses& pulses, Use use) {
  double count = 0;
  double mean_number = 0;
  double mean_time = 0;
  for (const auto& pulse : pulses) {
    if (!use(pulse)) continue;
    count++;
    mean_number += pulse.number;
    mean_time += pulse.time;
  }
  if (count < 2) return std::nullopt;
  mean_number /= count;
  mean_time /= count;
  double product = 0;
  double square = 0;
  for (const auto& pulse : pulses) {
    if (!use(pulse)) continue;
    product += (pulse.number - mean_number) * (pulse.time - mean_time);
    square += (pulse.number - mean_number) * (pulse.number - mean_number);
  }
  if (square == 0) return std::nullopt;
  const double period = product / square;
  return PulseLine{mean_time - period * mean_number, period};
}

}  // namespace

void PulseTracker::restart(std::int64_t number) {
  pulses_.clear();
  next_ = number;
  restarted_ = true;
}

void PulseTracker::accept(double time) {
  if (!pulses_.empty() && (time - pulses_.back().time > kTimeout || time < pulses_.back().time)) {
    pulses_.clear();
    line_.reset();
  }
  // the tempo from before
  if (std::exchange(restarted_, false) && line_) line_->begin = time - line_->period * static_cast<double>(next_);
  pulses_.push_back({static_cast<double>(next_++), time});
  if (pulses_.size() > kWindow) pulses_.pop_front();
  correct_lost();
  follow_tempo();
  fit();
}

// A lost pulse makes all later ones late by a whole number of periods, and there is a gap before the first of them.
// Late pulses that arrive together are late by different numbers.
void PulseTracker::correct_lost() {
  if (!line_ || pulses_.size() < kRecent) return;
  const auto late = [&](std::size_t i) { return (pulses_[i].time - line_->at(pulses_[i].number)) / line_->period; };
  std::size_t first = pulses_.size() - kRecent / 2;
  const double lost = std::round(late(first));
  if (lost < 1) return;
  for (std::size_t i = first; i < pulses_.size(); i++) {
    if (std::abs(late(i) - lost) > 0.4) return;
  }
  while (first > 0 && late(first - 1) > 0.5) first--;
  if (first == 0 || pulses_[first].time - pulses_[first - 1].time < (lost + 0.5) * line_->period) return;
  for (std::size_t i = first; i < pulses_.size(); i++) pulses_[i].number += lost;
  next_ += static_cast<std::int64_t>(lost);
}

// After a change of tempo, the older pulses are forgotten: the recent ones are on a line of their own, and most of them
// are far from the old one.
void PulseTracker::follow_tempo() {
  if (!line_ || pulses_.size() <= kRecent) return;
  const double first_recent = pulses_[pulses_.size() - kRecent].number;
  const std::optional<PulseLine> recent =
      fit_line(pulses_, [&](const Pulse& pulse) { return pulse.number >= first_recent; });
  if (!recent || recent->period < kMinPeriod || recent->period > kMaxPeriod) return;
  double largest = 0;  // distance from the own line
  std::vector<double> distances;
  for (std::size_t i = pulses_.size() - kRecent; i < pulses_.size(); i++) {
    largest = std::max(largest, std::abs(pulses_[i].time - recent->at(pulses_[i].number)));
    distances.push_back(std::abs(pulses_[i].time - line_->at(pulses_[i].number)));
  }
  const bool changed = std::abs(recent->period / line_->period - 1) > 0.005;
  if (!changed || median(distances) < 0.25 * line_->period || largest > 0.2 * recent->period) return;
  pulses_.erase(pulses_.begin(), pulses_.end() - kRecent);
}

void PulseTracker::fit() {
  if (pulses_.size() < kMinPulses) return;
  std::optional<PulseLine> line = fit_line(pulses_, [](const Pulse&) { return true; });
  for (int pass = 0; pass < 3 && line; pass++) {
    std::vector<double> distances;
    for (const Pulse& pulse : pulses_) distances.push_back(std::abs(pulse.time - line->at(pulse.number)));
    const double limit = std::max(3 * median(distances), 1e-4);
    line =
        fit_line(pulses_, [&](const Pulse& pulse) { return std::abs(pulse.time - line->at(pulse.number)) <= limit; });
  }
  if (line && line->period >= kMinPeriod && line->period <= kMaxPeriod) line_ = line;
}

void ClockIn::set_playing(bool playing) {
  playing_changed_ = playing_changed_ || playing_ != playing;
  playing_ = playing;
}

void ClockIn::accept(const MidiMessage& message, double time) {
  switch (message.kind) {
    case MidiKind::clock:
      return accept_pulse(time);
    case MidiKind::start:
      position_ = 0;
      [[fallthrough]];
    case MidiKind::resume:
      set_playing(true);
      begins_ = true;
      return;
    case MidiKind::stop:
      if (playing_.value_or(true)) position_ = tracker_.number() + 1;
      set_playing(false);
      begins_ = false;
      return;
    case MidiKind::song_position:
      position_ = std::int64_t{message.fourteen_bits()} * kPulsesPerBeat / 4;
      return;
    default:
      return;
  }
}

void ClockIn::accept_pulse(double time) {
  if (begins_) {
    tracker_.restart(position_);
    synced_beat_.reset();
    begins_ = false;
  }
  tracker_.accept(time);
  if (!playing_.value_or(true)) return;
  const auto beat = static_cast<std::int64_t>(std::floor(static_cast<double>(tracker_.number()) / kPulsesPerBeat));
  due_ = due_ || synced_beat_ != beat;
}

std::vector<Message> ClockIn::drain(double now) {
  std::vector<Message> messages;
  if (playing_changed_) messages.push_back({"/clock/playing", {Arg::of(*playing_)}});
  playing_changed_ = false;
  const std::optional<PulseLine>& line = tracker_.line();
  if (!due_ || !line || !playing_.value_or(true)) return messages;
  due_ = false;
  synced_beat_ = static_cast<std::int64_t>(std::floor(static_cast<double>(tracker_.number()) / kPulsesPerBeat));
  const double beat = (now - line->begin) / line->period / kPulsesPerBeat;
  const double tempo = std::clamp(60 / (line->period * kPulsesPerBeat), kMinTempo, kMaxTempo);
  messages.push_back({"/clock/sync", {Arg::of(std::max(beat, 0.0)), Arg::of(tempo), Arg::of(now)}});
  return messages;
}

}  // namespace limber::midi
