// Options of MIDI, as typed. [any]
#pragma once

#include <cstdint>
#include <string>

namespace limber::midi {

struct MidiOptions {
  enum class Use : std::uint8_t {
    on_demand,  ///< Devices are opened when there is a map, or a control is to be learned.
    on,
    off,
  };
  Use use = Use::on_demand;
  std::string ports;       ///< Part of the names of the ports; empty: all.
  std::string clock_from;  ///< Part of the name of the port whose clock is followed; empty: none.
  std::string clock_to;    ///< The same of the port that gets a clock.

  bool has_clock() const { return !clock_from.empty() || !clock_to.empty(); }
};

}  // namespace limber::midi
