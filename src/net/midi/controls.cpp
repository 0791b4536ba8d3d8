// ControlReader: pairs of 7-bit values, and parameters.
#include "net/midi/controls.h"

#include <algorithm>

namespace limber::midi {

namespace {

constexpr int kPairs = 32;
constexpr int kDataCoarse = 6;
constexpr int kDataFine = 38;
constexpr int kIncrement = 96;
constexpr int kDecrement = 97;
constexpr int kNrpnFine = 98;
constexpr int kNrpnCoarse = 99;
constexpr int kRpnFine = 100;
constexpr int kRpnCoarse = 101;
constexpr int kMax14 = 16383;

}  // namespace

std::string_view control_kind_name(ControlKind kind) { return kControlKindNames[static_cast<std::size_t>(kind)]; }

std::optional<ControlKind> control_kind_of(std::string_view name) {
  const auto* const found = std::ranges::find(kControlKindNames, name);
  if (found == kControlKindNames.end()) return std::nullopt;
  return static_cast<ControlKind>(found - kControlKindNames.begin());
}

int max_number(ControlKind kind) {
  switch (kind) {
    case ControlKind::cc14:
      return kPairs - 1;
    case ControlKind::nrpn:
    case ControlKind::rpn:
      return kMax14;
    case ControlKind::pressure:
    case ControlKind::pitch_bend:
      return 0;
    default:
      return 127;
  }
}

int max_value(ControlKind kind) {
  const bool fine = kind == ControlKind::cc14 || kind == ControlKind::nrpn || kind == ControlKind::rpn ||
                    kind == ControlKind::pitch_bend;
  return fine ? kMax14 : 127;
}

void ControlReader::accept(const MidiMessage& message, const Sink& sink) {
  const int channel = message.channel + 1;
  switch (message.kind) {
    case MidiKind::note_off:
      return sink({ControlKind::note, channel, message.first, 0});
    case MidiKind::note_on:
      return sink({ControlKind::note, channel, message.first, message.second});
    case MidiKind::key_pressure:
      return sink({ControlKind::key_pressure, channel, message.first, message.second});
    case MidiKind::channel_pressure:
      return sink({ControlKind::pressure, channel, 0, message.first});
    case MidiKind::program_change:
      return sink({ControlKind::program, channel, message.first, 127});
    case MidiKind::pitch_bend:
      return sink({ControlKind::pitch_bend, channel, 0, message.fourteen_bits()});
    case MidiKind::control_change:
      return accept_control(message, sink);
    default:
      return;
  }
}

void ControlReader::accept_control(const MidiMessage& message, const Sink& sink) {
  sink({ControlKind::cc, message.channel + 1, message.first, message.second});
  if (message.first < 2 * kPairs) accept_pair(message, sink);
  select_parameter(message);
  accept_parameter(message, sink);
}

void ControlReader::accept_pair(const MidiMessage& message, const Sink& sink) {
  Channel& channel = channels_[message.channel];
  const int number = message.first % kPairs;
  const auto index = static_cast<std::size_t>(number);
  const bool fine = message.first >= kPairs;
  if (fine) {
    channel.sends_fine.set(index);
  } else {
    channel.coarse[index] = message.second;
    if (channel.sends_fine.test(index)) return;
  }
  sink(
      {ControlKind::cc14, message.channel + 1, number, channel.coarse[index] * 128 + (fine ? int{message.second} : 0)});
}

void ControlReader::select_parameter(const MidiMessage& message) {
  if (message.first < kNrpnFine || message.first > kRpnCoarse) return;
  Channel& channel = channels_[message.channel];
  const bool registered = message.first >= kRpnFine;
  if (channel.registered != registered) channel.selected = {};
  channel.registered = registered;
  const bool coarse = message.first == kNrpnCoarse || message.first == kRpnCoarse;
  channel.parameter[coarse ? 0 : 1] = message.second;
  channel.selected[coarse ? 0 : 1] = true;
  channel.data = 0;
  channel.value = 0;
  // 127 127 selects no parameter
  if (channel.parameter[0] == 127 && channel.parameter[1] == 127) channel.selected = {};
}

void ControlReader::accept_parameter(const MidiMessage& message, const Sink& sink) {
  Channel& channel = channels_[message.channel];
  if (!channel.selected[0] || !channel.selected[1]) return;
  const int number = channel.parameter[0] * 128 + channel.parameter[1];
  const int key = (*channel.registered ? 1 << 18 : 0) + message.channel * (kMax14 + 1) + number;
  if (message.first == kDataCoarse) {
    channel.data = message.second;
    channel.value = channel.data * 128;
    if (fine_parameters_.contains(key)) return;
  } else if (message.first == kDataFine) {
    if (fine_parameters_.size() < kMaxFineParameters) fine_parameters_.insert(key);
    channel.value = channel.data * 128 + message.second;
  } else if (message.first == kIncrement) {
    channel.value = std::min(channel.value + 1, kMax14);
  } else if (message.first == kDecrement) {
    channel.value = std::max(channel.value - 1, 0);
  } else {
    return;
  }
  sink({*channel.registered ? ControlKind::rpn : ControlKind::nrpn, message.channel + 1, number, channel.value});
}

}  // namespace limber::midi
