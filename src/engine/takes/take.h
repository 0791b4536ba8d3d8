// Take: a recording of all inputs of a simulation, each with the tick in which it took effect, for a bit-exact replay.
// A take file is a sequence of frames with checksums and is only appended to: a truncated file can be replayed up to
// its last complete frame. This file declares the parts of the format; encoding.h encodes them. [any]
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/message.h"
#include "engine/edits/overrides.h"
#include "script/scene/sources.h"
#include "script/vm/call_log.h"

namespace limber::engine {

/// Version of the format. 3: the hashes skip values that are at their defaults; takes of version 1 and 2 can be
/// replayed, but not compared. 4: a reload keeps timers (SceneOptions::keep_timers). 5: the default view
/// frames the bodies of a scene (ShowRules::frames_scenes).
inline constexpr int kTakeVersion = 5;
inline constexpr int kFirstComparableTakeVersion = 3;
inline constexpr int kFirstTakeVersionKeepingTimers = 4;
inline constexpr int kFirstTakeVersionFramingScenes = 5;
/// Revision of the engine's behavior that a replay must reproduce. 1: a handler that failed is disabled, repeated panic
/// requests are ignored for a second, handlers have a time budget. 2: a static part moves at the velocity that is set,
/// and between poses that are set in consecutive ticks. 0: older takes, without these rules.
inline constexpr int kTakeRules = 2;
/// Start of the first line, before the version. The second line is readable JSON (TakeHeader); frames follow.
inline constexpr const char* kTakeMagic = "limber take ";

enum class TakeFrame : std::uint8_t {
  content = 'c',  ///< Content of a file; numbered from 1 in order of appearance.
  files = 'f',    ///< The files that a run of the scene has read; numbered from 1.
  begin = 'b',    ///< TakeInitialState.
  tick = 't',     ///< RecordedPass.
  end = 'e',      ///< TakeEnd: the recording was stopped, not interrupted.
};

/// An override that was in force when the recording began; see Override.
struct TakeOverride {
  enum class Kind : std::uint8_t { message, released, blend };
  Kind kind = Kind::message;
  Message message;     ///< `released`: only the address.
  PresetList presets;  ///< Of a blend: one or two presets.
  double amount = 0;
};

/// Returns the name of a take: its file name without folder and extension.
inline std::string title_of_take(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// Initial state of a take. Recording begins directly before a run of the scene from its start, so the state consists
/// of options, seeds, presets and overrides.
struct TakeInitialState {
  bool reset = false;  ///< Began with a reset of a running session; false: began with the program.
  std::string scene;
  std::optional<std::uint64_t> seed;  ///< --seed.
  std::vector<std::string> package_paths;
  std::string preset;         ///< --preset.
  std::vector<Message> sets;  ///< --set.
  PresetList recovered;       ///< --recover: one, or none.

  // Only if `reset`:
  std::uint64_t world_seed = 1;  ///< Seed of the world.
  std::uint64_t scene_seed = 1;  ///< Seed that the last run of the scene had left.
  bool paused = false;
  double speed = 1;
  std::string preset_file;
  PresetList presets;
  std::vector<TakeOverride> overrides;
};

/// The files that a run of the scene has read.
struct TakeFiles {
  std::shared_ptr<const script::Sources> sources;
  std::optional<PresetList> presets;  ///< Presets from the file next to the scene, if they were read as well.
  std::string preset_file;
};

/// A run of the scene's script, or the application of its result.
struct TakeSceneRun {
  enum class Kind : std::uint8_t {
    start,             ///< First run: at program start, or when a window waited for a corrected scene.
    reset,             ///< Reset of the running session.
    rerun,             ///< Immediate run because a parameter with `rerun` changed.
    reload,            ///< Immediate reload between two ticks.
    reload_requested,  ///< Background reload was requested: its inputs were copied.
    reload_finished,   ///< The background reload finished: applied, or failed.
    scene,             ///< Change to another scene.
  };
  Kind kind = Kind::start;
  bool succeeded = false;     ///< The run succeeded.
  bool reuses_files = false;  ///< Uses the files that the last successful run has read.
  std::uint32_t files = 0;    ///< Number of the `files` frame; 0: none.
  std::string scene;          ///< Path, for `scene`.

  /// True if the run was requested from outside the simulation, so that a replay has to start it. The others follow
  /// from the events of the tick.
  bool is_external() const { return kind >= Kind::reload; }
};

/// A message as the tick received it, or Lua code that was entered in a console.
struct InputRecord {
  Message message;
  CommandOrigin origin;
  bool evaluate = false;  ///< `message.address` is the Lua code.
};

/// An input that the engine derives from real time. It is stored among the messages of a tick (with an empty address)
/// so that a replay reproduces it.
struct TakeEvent {
  enum class Kind : std::uint8_t {
    panic_settled = 1,     ///< The first second of a panic has passed.
    messages_handled = 2,  ///< Handlers processed `value` of the queued messages in this tick; without this event: all.
  };
  Kind kind = Kind::messages_handled;
  std::uint64_t value = 0;
};
/// Encodes an event as a message with an empty address.
Message message_of(const TakeEvent& event);
/// Decodes an event. Returns nothing if `message` is an ordinary message.
std::optional<TakeEvent> event_of(const Message& message);

/// All inputs of one pass of the engine (a tick, or a pass while paused), for takes and for the history. In a take also
/// hashes of the resulting state.
struct RecordedPass {
  bool running = false;  ///< Simulated time advanced.
  std::vector<TakeSceneRun> runs;
  std::vector<InputRecord> messages;
  std::vector<script::StoppedCall> stopped_calls;
  std::uint64_t tick = 0;                   ///< Tick of the world after the pass.
  std::uint64_t motion_hash = 0;            ///< MotionHash::now().
  std::optional<std::uint64_t> state_hash;  ///< Engine::state_hash(); not in every tick, to bound the cost.
  std::uint32_t first_body = 0;  ///< Index of the first body in `bodies`; the range rotates through all bodies.
  std::vector<std::uint16_t> body_hashes;  ///< Low 16 bits of the motion hash of each body.
};

/// Final state of a take.
struct TakeEnd {
  std::uint64_t tick = 0;
  std::uint64_t state_hash = 0;
};

/// Header of the file: origin of the take, for people and for `limber take info`.
struct TakeHeader {
  int version = kTakeVersion;
  std::string limber;  ///< Version and commit.
  std::string scene;
  std::string recorded;  ///< Date and time.
  int rules = kTakeRules;
};

}  // namespace limber::engine
