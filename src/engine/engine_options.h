// EngineOptions: options of the program for an engine.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/message.h"
#include "base/system/clock.h"
#include "engine/recovery/recovery_saver.h"
#include "script/scene/scene_options.h"

namespace limber::engine {

struct EngineOptions {
  std::string scene;  ///< Scene file; empty: an empty world.
  /// Text of the scene; `scene` is then its name, a path in the folder where it finds files.
  std::optional<std::string> scene_text;
  /// A program drives the engine (src/lib) and sets values directly, between two passes. These are not recorded, so
  /// there are neither takes nor rewinds.
  bool embedded = false;
  script::SceneOptions scene_options;  ///< Seed, package paths, installed data.
  bool fast = false;                   ///< Computes ticks without waiting for real time. The result is the same.
  /// Time advances only by /transport/step, without waiting for real time; messages behind a step wait for its ticks.
  bool lockstep = false;
  std::optional<std::uint64_t> ticks;  ///< Ends after this number of ticks; else runs until stop().
  std::optional<double> duration;      ///< Ends at this simulated time, s.
  bool strict = false;                 ///< Ends at the first fault.
  bool print = true;                   ///< Scripts print to stdout; false: to stderr, because stdout is the output.
  std::string preset;                  ///< `--preset`: recalled before the first tick.
  std::string record;                  ///< Records a take to this file, from the start on.
  std::string replay;                  ///< Replays this take, which contains the scene and all input.
  bool current_scripts = false;        ///< A replay reads the scene from the disk, in its current state.
  struct Files {
    std::string cues;           ///< `--cues`: file of the cues; empty: the one beside the scene, if it exists.
    std::string presets;        ///< `--presets`: file of the presets; empty: the one beside the scene.
    bool saves_presets = true;  ///< False: presets that scripts store are not written to the disk.
    /// Folder of the lock files that make one program the owner of a scene's presets; empty: no locks.
    std::string locks;
  } files;
  struct Recovery {
    std::string folder;  ///< Folder of the recovery file, written while the show plays; empty: no recovery.
    std::chrono::milliseconds interval = RecoverySaver::kInterval;
    bool restore = false;  ///< `--recover`: restores the values of a run that crashed.
  } recovery;
  int threads = 1;  ///< Threads for each physics step. The result is the same for any number.
  /// `--param`: values of the scene's own parameters, as messages to /scene/NAME; applied before `sets`.
  std::vector<Message> params;
  std::vector<Message> sets;  ///< `--set`: overrides, applied before the first tick and after the preset.
  /// Called in each iteration of the loop of run(), at least 20 times a second, also while paused. Must not block.
  /// [sim]
  std::function<void()> on_iteration = [] {};
  /// Real time in seconds, for time budgets and for the first second of a panic. Tests replace it.
  std::function<double()> clock = system::clock_seconds;

  /// True if ticks wait for real time, and work that lasts too long is left for the next one.
  bool in_real_time() const { return !fast && !lockstep; }
};

}  // namespace limber::engine
