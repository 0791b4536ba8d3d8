// Take: everything that came into a simulation, with the tick in which it took effect, so that it can be played again
// to the bit. A file of frames, each with a checksum, that only grows: one that was cut off is good up to its last
// whole frame. This page is the format's parts; take_text.h has the bytes. [any]
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
#include "engine/hand.h"
#include "script/call_ledger.h"
#include "script/sources.h"

namespace limber {

/// 3: the hashes leave out what is at its default; takes of 1 and 2 can be played, not compared.
/// 4: a save keeps timers (SceneOptions::keep_timers).
inline constexpr int kTakeVersion = 4;
inline constexpr int kTakeComparable = 3;
inline constexpr int kTakeKeepsTimers = 4;
/// Rules of the engine that a replay follows. 1: a handler that failed is disabled, a panic has a first second,
/// handlers have a budget; 0: takes of before.
inline constexpr int kTakeRules = 1;
/// The file's first line; the second is JSON that people can read. Frames follow.
inline constexpr const char* kTakeHead = "limber take ";

enum class TakeFrame : std::uint8_t {
  content = 'c',  ///< Bytes of a file; numbered from 1 in their order.
  files = 'f',    ///< What a run of the scene has read; numbered from 1.
  begin = 'b',    ///< TakeBegin.
  tick = 't',     ///< TakeTick.
  end = 'e',      ///< The take was ended, not cut off.
};

/// A step of the performer's hand before the take began; as HandStep.
struct TakeHand {
  enum class Kind : std::uint8_t { message, given_back, blend };
  Kind kind = Kind::message;
  Message message;     ///< `given_back`: the address alone.
  PresetList presets;  ///< Of a blend: one or two.
  double amount = 0;
};

/// What a take is called by its file: no folder, no ending.
inline std::string take_title(const std::string& file) { return std::filesystem::path(file).stem().string(); }

/// How the show stood when the take began: right before a scene's run from its start.
struct TakeBegin {
  bool reset = false;  ///< In the middle of a show, with a reset; else with the program.
  std::string scene;
  std::optional<std::uint64_t> seed;  ///< --seed.
  std::vector<std::string> package_paths;
  std::string preset;         ///< --preset.
  std::vector<Message> sets;  ///< --set.
  PresetList recovered;       ///< --recover: one, or none.
  // of a reset
  std::uint64_t world_seed = 1;  ///< In force.
  std::uint64_t scene_seed = 1;  ///< As the scene's run had left it.
  bool paused = false;
  double speed = 1;
  std::string preset_file;
  PresetList presets;
  std::vector<TakeHand> hand;
};

/// What a run of a scene has read.
struct TakeFiles {
  std::shared_ptr<const Sources> sources;
  std::optional<PresetList> presets;  ///< Read with it: of the file beside the scene.
  std::string preset_file;
};

/// A run of the scene, or what was done with one.
struct TakeRun {
  enum class Kind : std::uint8_t {
    start,   ///< The program's, or the first of a window that waited for a mended scene.
    reset,   ///< From the start, in the show.
    rerun,   ///< Another value of a parameter with `rerun`, run at once.
    reload,  ///< At once, between two ticks.
    order,   ///< Beside the show: what it is made from is copied.
    take,    ///< What was ordered becomes the show, or was bad.
    scene,   ///< Another scene becomes the show.
  };
  Kind kind = Kind::start;
  bool good = false;
  bool again = false;       ///< Of what the last good run has read.
  std::uint32_t files = 0;  ///< Number of a `files` frame; 0: none.
  std::string scene;        ///< Of `scene`.

  /// Asked for from outside, so a replay does it by itself; else it comes of what happens in the tick.
  bool from_outside() const { return kind >= Kind::reload; }
};

/// A message as the tick took it, or a text of a console.
struct TakeMessage {
  Message message;
  Origin origin;
  bool evaluate = false;  ///< `message.address` is the text.
};

/// An input that the engine derives from real time, kept among the messages of a tick (with an empty address) so that a
/// replay has it too.
struct TakeEvent {
  enum class Kind : std::uint8_t {
    panic_settled = 1,  ///< The first second of a panic is over.
    heard = 2,          ///< Handlers heard `value` of the waiting messages in this tick; without it, all of them.
  };
  Kind kind = Kind::heard;
  std::uint64_t value = 0;
};
Message message_of(const TakeEvent& event);
/// None: it is a message.
std::optional<TakeEvent> event_of(const Message& message);

/// Everything that reached the simulation in one tick, or while time stood still, and what came of it.
struct TakeTick {
  bool running = false;  ///< Time went on.
  std::vector<TakeRun> runs;
  std::vector<TakeMessage> messages;
  std::vector<StoppedCall> stopped;
  std::uint64_t tick = 0;              ///< Of the world, behind it.
  std::uint64_t motion = 0;            ///< MotionHash::now().
  std::optional<std::uint64_t> state;  ///< Engine::state_hash(): as often as it costs little.
  std::uint32_t first_body = 0;        ///< The bodies take turns.
  std::vector<std::uint16_t> bodies;   ///< Low bits of their motion's hashes.
};

struct TakeEnd {
  std::uint64_t tick = 0;
  std::uint64_t state = 0;
};

/// Who recorded it, for people and for `limber take info`.
struct TakeHeader {
  int version = kTakeVersion;
  std::string limber;  ///< Version and commit.
  std::string scene;
  std::string recorded;  ///< Date and time.
  int rules = kTakeRules;
};

}  // namespace limber
