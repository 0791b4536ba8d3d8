// ControlReader: turns the MIDI messages of one device into the movements of its controls. [one thread]
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string_view>

#include "net/midi/decoder.h"

namespace limber::midi {

enum class ControlKind : std::uint8_t {
  cc,            ///< Control change, 7 bits.
  cc14,          ///< Control changes 0 .. 31 with their fine values 32 .. 63, 14 bits.
  nrpn,          ///< Non-registered parameter, 14 bits.
  rpn,           ///< Registered parameter, 14 bits.
  note,          ///< Key or pad; the value is the velocity, 0 if released.
  key_pressure,  ///< Pressure of one key.
  pressure,      ///< Pressure of a channel; it has no number.
  pitch_bend,    ///< 14 bits; it has no number.
  program,       ///< Program change: the number is the program; it is never released.
};
inline constexpr std::array<std::string_view, 9> kControlKindNames = {
    "cc", "cc14", "nrpn", "rpn", "note", "key_pressure", "pressure", "pitch_bend", "program"};

std::string_view control_kind_name(ControlKind kind);
std::optional<ControlKind> control_kind_of(std::string_view name);
/// Largest number of a control of this kind: 127, 31, 16383; 0 if it has no number.
int max_number(ControlKind kind);
/// Largest value: 127 or 16383.
int max_value(ControlKind kind);

/// A control, and its new value.
struct ControlEvent {
  ControlKind kind = ControlKind::cc;
  int channel = 1;  ///< 1 .. 16
  int number = 0;
  int value = 0;  ///< 0 .. max_value(kind)

  /// Position of the control, 0 .. 1.
  double position() const { return static_cast<double>(value) / max_value(kind); }
  bool is_same_control(const ControlEvent& other) const {
    return kind == other.kind && channel == other.channel && number == other.number;
  }
};

/// A control change may belong to a pair or to a parameter as well: each interpretation is reported, and the map
/// decides. A 14-bit value is reported once both of its halves have arrived, if the device has sent the finer one
/// before; else with the coarse half alone.
class ControlReader {
 public:
  using Sink = std::function<void(const ControlEvent&)>;
  void accept(const MidiMessage& message, const Sink& sink);

 private:
  struct Channel {
    std::array<std::uint8_t, 32> coarse{};
    std::bitset<32> sends_fine;
    // the selected parameter
    std::optional<bool> registered;
    std::array<std::uint8_t, 2> parameter{};  // coarse, fine
    std::array<bool, 2> selected{};           // which of them have arrived
    std::uint8_t data = 0;
    int value = 0;
  };
  void accept_control(const MidiMessage& message, const Sink& sink);
  void accept_pair(const MidiMessage& message, const Sink& sink);
  void select_parameter(const MidiMessage& message);
  void accept_parameter(const MidiMessage& message, const Sink& sink);

  static constexpr std::size_t kMaxFineParameters = 1024;
  std::array<Channel, 16> channels_;
  std::set<int> fine_parameters_;  // parameters with data of 14 bits
};

}  // namespace limber::midi
