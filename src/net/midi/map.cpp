// MidiMap: names, and the comparison of controls.
#include "net/midi/map.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::midi {

std::string_view control_mode_name(ControlMode mode) { return kControlModeNames[static_cast<std::size_t>(mode)]; }

std::optional<ControlMode> control_mode_of(std::string_view name) {
  const auto* const found = std::ranges::find(kControlModeNames, name);
  if (found == kControlModeNames.end()) return std::nullopt;
  return static_cast<ControlMode>(found - kControlModeNames.begin());
}

std::string control_text(const MidiEntry& entry) {
  std::string text(control_kind_name(entry.kind));
  if (max_number(entry.kind) > 0) text += fmt::format(" {}", entry.number);
  if (entry.channel > 0) text += fmt::format(", channel {}", entry.channel);
  if (!entry.port.empty()) text += fmt::format(", {}", printable(entry.port));
  return text;
}

bool port_matches(std::string_view port, std::string_view part) {
  for (std::size_t at = 0; at + part.size() <= port.size(); at++) {
    if (same_in_any_case(port.substr(at, part.size()), part)) return true;
  }
  return false;
}

bool matches(const MidiEntry& entry, std::string_view port, const ControlEvent& event) {
  return entry.kind == event.kind && entry.number == event.number &&
         (entry.channel == 0 || entry.channel == event.channel) && port_matches(port, entry.port);
}

}  // namespace limber::midi
