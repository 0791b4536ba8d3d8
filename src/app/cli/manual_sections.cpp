// Tables of terms and their texts.
#include "app/cli/manual_sections.h"

namespace limber::app {

std::span<const ManualEntry> manual_exit_codes() {
  static constexpr ManualEntry kEntries[] = {
      {"0", "Success."},
      {"1", "Invalid input: a scene, a robot or a take. The error names the place and the fix."},
      {"2", "Wrong usage."},
      {"3", "A problem of the machine: a port is in use, for example, or there is no reply."},
  };
  return kEntries;
}

std::span<const ManualEntry> manual_files() {
  static constexpr ManualEntry kEntries[] = {
      {"/usr/share/limber",
       "Scenes, robots, behaviors and shaders of an installed program. A scene that is not found in the current folder "
       "is searched there."},
      {"/usr/share/doc/limber", "The documentation, which limber docs shows in a browser."},
      {"$XDG_CONFIG_HOME/limber/panel.json", "Settings of the panel; by default in ~/.config/limber."},
      {"$XDG_STATE_HOME/limber",
       "History of the console, values for --recover, and in models/ the scenes, presets and takes of models; by "
       "default ~/.local/state/limber."},
      {"$XDG_RUNTIME_DIR/limber-PID.sock",
       "Socket of a running program, for limber console and limber monitor. Without that folder it is in $TMPDIR or "
       "/tmp."},
  };
  return kEntries;
}

std::span<const ManualEntry> manual_environment() {
  static constexpr ManualEntry kEntries[] = {
      {"DISPLAY, WAYLAND_DISPLAY", "Without both, limber plays without a window, and limber docs opens no browser."},
      {"XDG_CONFIG_HOME, XDG_STATE_HOME, XDG_RUNTIME_DIR, HOME, TMPDIR", "Locations of the files above."},
      {"LIMBER_GL", "The kind of OpenGL: auto, core, es or 3.1, as --gl of play and doctor."},
      {"PATH", "limber docs searches xdg-open in it, films search ffmpeg."},
  };
  return kEntries;
}

}  // namespace limber::app
