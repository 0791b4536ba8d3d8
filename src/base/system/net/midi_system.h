// Finds the MIDI system of this machine, before a library that prints errors opens it. [any]
#pragma once

#include <cstdint>

namespace limber::system {

enum class MidiSystem : std::uint8_t {
  none,
  alsa,   ///< The ALSA sequencer, which this user may open.
  jack,   ///< A JACK server may be running.
  other,  ///< A system other than Linux.
};

MidiSystem find_midi_system();

}  // namespace limber::system
