// Feedback: which control gets which value.
#include "net/midi/feedback.h"

#include <algorithm>

namespace limber::midi {

namespace {

bool wants_feedback(const Binding& binding) {
  return binding.entry().feedback.value_or(!is_relative(binding.mode()) && binding.mode() != ControlMode::trigger);
}

}  // namespace

std::vector<std::uint8_t> feedback_bytes(ControlKind kind, int channel, int number, int value) {
  const auto byte = [](int v) { return static_cast<std::uint8_t>(v & 0x7f); };
  const auto status = [channel](int type) { return static_cast<std::uint8_t>(type | ((channel - 1) & 0xf)); };
  const std::uint8_t control = status(0xb0);
  switch (kind) {
    case ControlKind::cc:
      return {control, byte(number), byte(value)};
    case ControlKind::cc14:
      return {control, byte(number), byte(value >> 7), control, byte(number + 32), byte(value)};
    case ControlKind::nrpn:
    case ControlKind::rpn: {
      const int coarse = kind == ControlKind::nrpn ? 99 : 101;
      return {control, byte(coarse),     byte(number >> 7), control, byte(coarse - 1), byte(number), control,
              6,       byte(value >> 7), control,           38,      byte(value)};
    }
    case ControlKind::note:
      return {status(0x90), byte(number), byte(value)};
    case ControlKind::pitch_bend:
      return {status(0xe0), byte(value), byte(value >> 7)};
    default:
      return {};
  }
}

int& Feedback::known(std::size_t binding, std::string_view port) {
  const auto found =
      std::ranges::find_if(known_, [&](const Known& each) { return each.binding == binding && each.port == port; });
  if (found != known_.end()) return found->value;
  return known_.emplace_back(Known{binding, std::string(port), -1}).value;
}

void Feedback::note_movement(const Bindings& bindings, std::string_view port, const ControlEvent& event) {
  for (std::size_t i = 0; i < bindings.list().size(); i++) {
    if (matches(bindings.list()[i].entry(), port, event)) known(i, port) = event.value;
  }
}

void Feedback::update(const Bindings& bindings, const std::vector<std::string>& ports, std::int64_t now,
                      const Send& send) {
  const std::vector<Binding>& list = bindings.list();
  std::size_t sent = 0;
  for (std::size_t n = 0; n < list.size() && sent < kMaxMessages; n++) {
    const std::size_t index = (next_ + n) % list.size();
    const Binding& binding = list[index];
    const bool moving =
        binding.mode() == ControlMode::absolute && binding.moved_at() != 0 && now - binding.moved_at() < kRestTime;
    if (moving || !wants_feedback(binding)) continue;
    const std::optional<int> value = binding.control_value();
    if (!value) continue;
    const MidiEntry& entry = binding.entry();
    const int channel = entry.channel > 0 ? entry.channel : std::max(binding.last_channel(), 1);
    const std::vector<std::uint8_t> bytes = feedback_bytes(entry.kind, channel, entry.number, *value);
    for (const std::string& port : ports) {
      if (bytes.empty() || !port_matches(port, entry.port)) continue;
      int& shown = known(index, port);
      if (shown == *value) continue;
      shown = *value;
      send(port, bytes);
      sent++;
    }
    if (sent >= kMaxMessages) next_ = index + 1;
  }
}

}  // namespace limber::midi
