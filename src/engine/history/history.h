// History: the last seconds of the simulation, for rewind: checkpoints at most a second apart, and all inputs between
// them. An earlier tick is reached by restoring a checkpoint and simulating the passes after it again. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/history/checkpoint.h"
#include "script/vm/call_log.h"

namespace limber::engine {

/// Target of a rewind.
struct RewindTarget {
  std::uint64_t tick = 0;
  std::optional<double> time;  ///< s; takes precedence over `tick`.

  /// True if the world is at the target or past it.
  bool reached(const sim::World& world) const {
    return time ? world.time() + world.timestep() / 2 > *time : world.tick() >= tick;
  }
};

class History {
 public:
  static constexpr double kCheckpointInterval = 1;                  ///< Simulated seconds between checkpoints.
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 20;  ///< Memory limit of the history, in bytes.

  History(Overrides& overrides, UndoStack& undo, Presets& presets, CuePlayer& cues, HandlerQueue& handler_queue)
      : store_(overrides, undo, presets, cues, handler_queue) {}

  /// Discards everything: the state from now on is the oldest that can be restored. `why`: reason, for limit_reason().
  void clear(std::string_view why);
  /// Number of calls of clear(): no state from before the last one can be restored.
  std::uint64_t clears() const { return clears_; }
  /// Records an input of the current pass; see InputLog::record().
  void record_input(const Message& message, const CommandOrigin& origin, bool evaluate);
  /// Ends the pass: records the stopped calls in `calls`, captures a checkpoint if one is due and discards everything
  /// older than `seconds`; 0 switches history off.
  void end_pass(Session& session, const script::CallLog& calls, bool running, double seconds);
  /// Sets the memory limit: a replay may use more than kMaxBytes.
  void set_max_bytes(std::size_t bytes) { max_bytes_ = bytes; }

  bool empty() const { return checkpoints_.empty(); }
  /// True if there is a checkpoint to restore. Discards the history if nodes were added or removed since the last call:
  /// checkpoints fit only the structure that they were captured from. [sim]
  bool validate(const Session& session);
  /// Reason why older checkpoints were discarded, for error messages.
  const std::string& limit_reason() const { return limit_reason_; }
  double oldest_time() const { return checkpoints_.empty() ? 0 : checkpoints_.front()->time; }
  std::uint64_t oldest_tick() const { return checkpoints_.empty() ? 0 : checkpoints_.front()->tick; }
  /// Tick of the newest checkpoint.
  std::uint64_t newest_tick() const { return checkpoints_.empty() ? 0 : checkpoints_.back()->tick; }
  /// Memory use in bytes.
  std::size_t bytes() const;

  /// Restores the newest checkpoint that is not after the target, else the oldest; must not be empty. Then next()
  /// supplies the recorded passes after the checkpoint.
  void restore(Session& session, const RewindTarget& target);
  /// Reads the next recorded pass. False at the end of the recording.
  bool next(RecordedPass& pass) { return checkpoints_.back()->passes.next(pass); }
  /// Discards the passes that next() has not read yet. `last`: also the last one that it has read.
  void truncate(bool last = false) { checkpoints_.back()->passes.truncate(last); }
  /// Keeps the newest checkpoint, regardless of its age, for restore_before(), until clear() or the next pin().
  void pin();
  /// Restores the newest checkpoint before a tick and discards everything after it. False if there is none.
  bool restore_before(Session& session, std::uint64_t tick);

 private:
  static constexpr std::uint64_t kNoTick = ~std::uint64_t{0};
  void append_pass(const script::CallLog& calls, bool running);
  bool checkpoint_due(const sim::World& world, bool stopped) const;
  void capture_checkpoint(Session& session);
  void restore_checkpoint(Session& session, std::size_t index);
  void drop(std::size_t index);
  void drop_oldest();
  void trim(const sim::World& world, double seconds);
  void release_ended_runs(Session& session) const;

  CheckpointStore store_;
  std::vector<std::unique_ptr<Checkpoint>> checkpoints_;  // oldest first
  std::unique_ptr<Checkpoint> pinned_;                    // pinned checkpoint that left the list, without passes
  std::uint64_t pinned_tick_ = kNoTick;                   // tick of the pinned checkpoint
  std::uint64_t structure_version_ = 0;  // structure version of the store, the same for all checkpoints
  std::uint64_t checkpoint_tick_ = 0;    // of the last checkpoint
  double checkpoint_time_ = 0;
  std::uint64_t clears_ = 0;
  bool too_large_ = false;
  bool shortage_reported_ = false;
  std::size_t max_bytes_ = kMaxBytes;
  std::string limit_reason_ = "the scene starts there";
  InputLog inputs_{0};  // of the current pass
  RecordedPass pass_;   // scratch
};

}  // namespace limber::engine
