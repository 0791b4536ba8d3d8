// History: the last seconds of the show, so that time can go back: key states at most a second apart, and all that
// reached the ticks between them. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/key_bytes.h"
#include "base/page_store.h"
#include "engine/edits.h"
#include "engine/grips.h"
#include "engine/hand.h"
#include "engine/handler_queue.h"
#include "engine/presets.h"
#include "engine/stage.h"
#include "engine/take.h"
#include "script/call_ledger.h"
#include "script/scene_key.h"
#include "sim/world_key.h"

namespace limber {

/// What reached one pass of the engine.
struct PastPass {
  bool running = false;  ///< Time went on.
  std::vector<TakeMessage> messages;
  std::vector<StoppedCall> stopped;
};

/// Where time is to go back to.
struct PastGoal {
  std::uint64_t tick = 0;
  std::optional<double> time;  ///< s; then this one counts.

  bool reached(const World& world) const {
    return time ? world.time() + world.timestep() / 2 > *time : world.tick() >= tick;
  }
};

class History {
 public:
  static constexpr double kApart = 1;                                ///< Simulated seconds between key states.
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;  ///< Of all of it.

  History(PerformerHand& hand, Edits& edits, Presets& presets, HandlerQueue& heard)
      : hand_(hand), edits_(edits), presets_(presets), heard_(heard) {}

  /// All of it goes: what comes from here on can't be undone by going back. `why`: for who asks how far that goes.
  void begin_anew(std::string_view why);
  /// A message or a text of a console reaches this pass.
  void note(const Message& message, const Origin& origin, bool evaluate = false);
  /// The pass is over: what was stopped in it stands in the ledger. A key state is taken where one is due, and what is
  /// older than `seconds` goes; 0: all of it.
  void end_pass(Stage& stage, const CallLedger& calls, bool running, double seconds);
  /// More than usual, for who plays a take again.
  void allow(std::size_t bytes) { most_ = bytes; }

  bool empty() const { return keys_.empty(); }
  /// Whether there is a state to go back to. Things that came or went since the last call end history. [sim]
  bool fits(const Stage& stage);
  /// Why it goes no further back.
  const std::string& why() const { return why_; }
  double oldest_time() const { return keys_.empty() ? 0 : keys_.front()->time; }
  std::uint64_t oldest_tick() const { return keys_.empty() ? 0 : keys_.front()->tick; }
  /// Of the newest key state.
  std::uint64_t newest_tick() const { return keys_.empty() ? 0 : keys_.back()->tick; }
  /// Bytes that it takes.
  std::size_t bytes() const;

  /// Brings the newest key state back that is not behind the goal, else the oldest. Not while it is empty. What is kept
  /// between key states follows from next().
  void bring_back(Stage& stage, const PastGoal& goal);
  /// The next pass after that; false: there is none.
  bool next(PastPass& pass);
  /// What next() has not given never was; `last`: nor was what it gave last.
  void cut(bool last = false);
  /// The newest key state stays until begin_anew() or the next hold(), however long ago it may be: for return_before().
  void hold();
  /// The newest key state before a tick is brought back, and all behind it never was; false: there is none.
  bool return_before(Stage& stage, std::uint64_t tick);

 private:
  struct Key {
    std::uint64_t tick = 0;
    double time = 0;
    WorldKey world;
    SceneKey scene;
    bool has_scene = false;
    std::shared_ptr<const PerformerHand> hand;
    std::shared_ptr<const Edits::Memory> edits;
    Presets::Memory presets;
    Grips grips;
    HandlerQueue heard;
    KeyBytes inputs;  // of the passes behind it
  };
  /// A copy, and the version of what it is a copy of.
  template <class T>
  struct Known {
    std::shared_ptr<const T> copy;
    std::uint64_t version = 0;
  };

  static constexpr std::uint64_t kNoTick = ~std::uint64_t{0};
  bool due(const World& world, bool stopped) const;
  void take(Stage& stage);
  void restore(Stage& stage, std::size_t number);
  void drop(std::size_t number);
  void forget(std::unique_ptr<Key> key);
  void let_go_oldest();
  void trim(const World& world, double seconds);
  void release_runs(Stage& stage) const;
  static void pass_input(KeyBytes& bytes, TakeMessage& input);
  static void pass_stop(KeyBytes& bytes, StoppedCall& stop);

  PerformerHand& hand_;
  Edits& edits_;
  Presets& presets_;
  HandlerQueue& heard_;
  PageStore pages_;
  std::vector<std::unique_ptr<Key>> keys_;   // the oldest first
  std::unique_ptr<Key> held_;                // one that would have gone, without what lies behind it
  std::uint64_t hold_ = kNoTick;             // its tick
  std::vector<std::unique_ptr<Key>> spare_;  // their room is used again
  Known<PerformerHand> known_hand_;
  Known<Edits::Memory> known_edits_;
  std::uint64_t structure_ = 0;  // of the store, that holds for all keys
  std::uint64_t last_tick_ = 0;  // when a key was taken last
  double last_time_ = 0;
  bool too_large_ = false;
  bool said_short_ = false;
  std::size_t most_ = kMostBytes;
  std::size_t pass_begins_ = 0;  // in the newest key's inputs
  std::size_t given_from_ = 0;   // where the pass that next() gave last begins
  std::string why_ = "the scene has begun there";
  KeyBytes scratch_;
  TakeMessage input_;  // scratch
  StoppedCall stop_;   // scratch
};

}  // namespace limber
