// Looks for the device of ALSA's sequencer, and for files of a JACK server.
#include "base/system/net/midi_system.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace limber::system {

MidiSystem find_midi_system() {
#ifdef __linux__
  if (access("/dev/snd/seq", R_OK | W_OK) == 0) return MidiSystem::alsa;
  std::error_code error;
  for (std::filesystem::directory_iterator at("/dev/shm", error), end; !error && at != end; at.increment(error)) {
    if (at->path().filename().string().starts_with("jack")) return MidiSystem::jack;
  }
  return MidiSystem::none;
#else
  return MidiSystem::other;
#endif
}

}  // namespace limber::system
