// MidiMap: which controls of MIDI devices set which properties, and the text format of its file. [any]
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "base/result.h"
#include "net/midi/controls.h"

namespace limber::midi {

/// How the values of a control act.
enum class ControlMode : std::uint8_t {
  absolute,         ///< Its position sets the value within the range.
  relative,         ///< An encoder that sends steps in two's complement: 1, 2 … up, 127, 126 … down.
  relative_offset,  ///< An encoder that sends 64 plus the steps.
  relative_sign,    ///< An encoder that sends the number of steps, with bit 6 set: down.
  toggle,           ///< Pressing it switches between the ends of the range.
  momentary,        ///< The upper end of the range while it is pressed, else the lower one.
  trigger,          ///< Pressing it sends the message with `values`.
};
inline constexpr std::array<std::string_view, 7> kControlModeNames = {
    "absolute", "relative", "relative_offset", "relative_sign", "toggle", "momentary", "trigger"};

std::string_view control_mode_name(ControlMode mode);
std::optional<ControlMode> control_mode_of(std::string_view name);
inline bool is_relative(ControlMode mode) {
  return mode >= ControlMode::relative && mode <= ControlMode::relative_sign;
}

/// A control, and the address that it sets.
struct MidiEntry {
  static constexpr std::size_t kMaxText = 1024;     ///< Bytes of a text.
  static constexpr std::size_t kMaxArguments = 64;  ///< Of a message.

  std::string port;  ///< Part of the name of its port; empty: any port.
  int channel = 0;   ///< 1 .. 16; 0: any channel.
  ControlKind kind = ControlKind::cc;
  int number = 0;
  std::string address;
  int component = 0;                           ///< Of a vector, from 1; 0: the whole value.
  std::optional<std::array<double, 2>> range;  ///< Nothing: the property's. May be descending.
  std::optional<ControlMode> mode;             ///< Nothing: by the property and the kind of control.
  std::optional<double> step;                  ///< Of one step of an encoder.
  bool pickup = true;                          ///< False: the value jumps to the control's position.
  std::optional<bool> feedback;                ///< Nothing: the value is sent to the device, except for relative modes.
  std::vector<Arg> values;                     ///< Of `trigger`.
  std::string note;                            ///< For people.
};

/// Returns "cc 7", or "pitch_bend"; with the channel and the port if the entry has them: "cc 7, channel 1,
/// nanoKONTROL".
std::string control_text(const MidiEntry& entry);
/// True if the entry is for this control of this port.
bool matches(const MidiEntry& entry, std::string_view port, const ControlEvent& event);
/// True if `part` is part of a port's name, in any case. An empty one is part of every name.
bool port_matches(std::string_view port, std::string_view part);

using MidiMap = std::vector<MidiEntry>;
inline constexpr std::size_t kMaxEntries = 1000;
inline constexpr std::size_t kMaxMapBytes = std::size_t{4} << 20;  ///< Maximum size of a file.

/// Parses a map file. Errors name the line, the entry and its field.
Result<MidiMap> parse_midi_map(std::string_view text);
/// Returns the text of a map, one entry per line; parse_midi_map() returns an equal map.
std::string midi_map_text(const MidiMap& map);

}  // namespace limber::midi
