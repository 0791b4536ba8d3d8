// `limber play`: plays a scene or a model with OSC, a window or a status line once a second, until it ends or is
// stopped.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/view/display_options.h"

namespace limber::app {

/// Options of log messages.
struct LogOptions {
  std::string file;  ///< Log file; empty: none.
  double megabytes = 10;
  int old_files = 5;  ///< Number of old log files.
  bool quiet = false;
};

/// Options of MIDI.
struct MidiChoices {
  std::string use;         ///< Empty: not given; "all", "off", or part of the names of the ports.
  std::string clock_from;  ///< Part of the name of the port whose clock is followed.
  std::string clock_to;    ///< Part of the name of the port that gets a clock.
};

/// Options of OSC and OSCQuery, lights and MIDI.
struct NetworkOptions {
  std::string osc_in;   ///< Empty: not given.
  std::string osc_tcp;  ///< Empty: not given.
  std::string osc_allow;
  std::vector<std::string> osc_out;
  bool osc_optional = false;
  bool osc_share = false;
  std::string query;  ///< Empty: not given.
  std::vector<std::string> query_names;
  bool lights = false;                  ///< Lighting output is armed from the start.
  std::vector<std::string> lights_out;  ///< Targets of lighting output.
  std::string zeroconf;                 ///< Name to announce; empty: not given.
  bool link = false;                    ///< Take part in an Ableton Link session.
  MidiChoices midi;
};

/// Options of takes.
struct TakeOptions {
  std::string record;            ///< File of the take to record.
  std::string replay;            ///< File of the take to replay.
  bool current_scripts = false;  ///< Replay with the current scripts instead of the recorded ones.
};

/// The scene to write for a model.
struct SaveSceneOptions {
  std::string file;        ///< Empty: play.
  bool overwrite = false;  ///< Replace the file if it exists.
};

/// Values that are set after the scene has run, the file of its output, and its cues.
struct RunOptions {
  std::vector<std::string> params;  ///< NAME=VALUE: parameters of the scene.
  std::vector<std::string> sets;    ///< PATH=VALUE
  std::string out;                  ///< File or folder for recorded columns and results; empty: none.
  std::string cues;                 ///< File of the cues; empty: the one beside the scene.
  std::string presets;              ///< File of the presets; empty: the one beside the scene.
};

/// Options of `play`, as typed.
struct PlayOptions {
  std::string scene = "scripts/arms.lua";
  bool fast = false;
  bool lockstep = false;
  bool hash = false;
  bool strict = false;
  bool watch = false;  ///< Watch the scene's files under `fast` too.
  std::optional<std::uint64_t> ticks;
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;
  int threads = 1;  ///< Number of threads for the physics.
  RunOptions run;
  std::string preset;  ///< Recalled after the scene has run, before the values of `run`.
  std::vector<std::string> package_paths;
  std::string root;  ///< MJCF: see ImportOptions.
  SaveSceneOptions save_scene;
  bool recover = false;  ///< Start with the values that a crashed run has left.
  NetworkOptions network;
  TakeOptions take;
  LogOptions log;
  DisplayOptions display;
};

/// Plays, or writes the scene of a model. Returns the exit code: 0 success, 1 invalid input, 2 usage, 3 the machine.
/// [main]
int play_command(const PlayOptions& options);

}  // namespace limber::app
