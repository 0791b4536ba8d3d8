// TakePlayer: supplies an engine with the inputs of a take, tick by tick, and compares the resulting hashes with the
// recorded ones. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/takes/reader.h"
#include "sim/world/world.h"

namespace limber::engine {

/// Result of a replay.
struct ReplayResult {
  std::uint64_t ticks = 0;                   ///< Number of ticks that were replayed.
  std::optional<std::uint64_t> diverged_at;  ///< The first tick with a different hash.
  std::string diverged_body;  ///< Name of the first body that moves differently; empty if none was found.
  std::string damage;         ///< Corruption of the file after the last tick; empty: none.
  bool truncated = false;     ///< The file has no end frame: the recording was interrupted.
  bool compared = true;       ///< False: the format version has different hashes, so nothing was compared.
  std::string recorded_by;    ///< Version of Limber that recorded the take.
};

class TakePlayer {
 public:
  /// Opens a take. `current_scripts`: the scene and its files are read from the disk instead of from the take.
  static Result<std::unique_ptr<TakePlayer>> open(const std::string& path, bool current_scripts);

  const TakeInitialState& initial_state() const { return reader_->initial_state(); }
  bool current_scripts() const { return current_scripts_; }
  /// True if reloads kept timers when the take was recorded.
  bool keeps_timers() const { return reader_->header().version >= kFirstTakeVersionKeepingTimers; }
  bool frames_scenes() const { return reader_->header().version >= kFirstTakeVersionFramingScenes; }
  /// See kTakeRules.
  int rules() const { return reader_->header().rules; }
  /// Advances to the next tick. False at the end of the take, and once the replay has diverged and the first differing
  /// body is known (or can't be found any more).
  bool next();
  /// True if simulated time advances in the next tick of the take.
  bool steps_next() const { return has_more() && ahead_[ahead_at_].running; }
  /// True once next() has returned false.
  bool finished() const { return finished_; }
  const RecordedPass& tick() const { return tick_; }
  /// The messages of the tick; the caller may modify them while executing them.
  std::span<InputRecord> messages() { return tick_.messages; }
  /// The calls of the tick that must be stopped as in the recording; none with `current_scripts`, where calls may
  /// differ.
  std::vector<script::StoppedCall> stopped_calls() const {
    return current_scripts_ ? std::vector<script::StoppedCall>() : tick_.stopped_calls;
  }
  /// Number of ticks replayed so far; passes while paused are not counted.
  std::uint64_t ticks() const { return result_.ticks; }
  /// Number of ticks of the whole take.
  std::uint64_t total_ticks() const { return total_ticks_; }

  /// Returns the next run of the scene in this tick and advances to the following one; null if the next run is of
  /// another kind or there is none.
  const TakeSceneRun* consume_run(TakeSceneRun::Kind kind);
  bool next_run_is(TakeSceneRun::Kind kind) const {
    return next_run_ < tick_.runs.size() && tick_.runs[next_run_].kind == kind;
  }
  /// Returns the next run of this tick if it was requested from outside, else null.
  const TakeSceneRun* next_external_run() const;
  std::shared_ptr<const script::Sources> sources(const TakeSceneRun& run) { return reader_->sources(run.files); }
  std::optional<TakeReader::PresetBank> presets(const TakeSceneRun& run) const { return reader_->presets(run.files); }

  /// Compares the state after the tick with the recorded hashes.
  void compare(sim::World& world, const script::CallLog& calls, const std::function<std::uint64_t()>& state_hash);
  ReplayResult result() const;

 private:
  TakePlayer(std::unique_ptr<TakeReader> reader, bool current_scripts)
      : reader_(std::move(reader)), current_scripts_(current_scripts) {}
  void read_ahead();
  /// True if the take has ticks after the current one.
  bool has_more() const { return ahead_at_ < ahead_end_; }
  /// True if this version computes hashes in the same way.
  bool comparable() const { return reader_->header().version >= kFirstComparableTakeVersion; }
  void find_diverged_body(sim::World& world);
  bool end_matches(const std::function<std::uint64_t()>& state_hash) const;

  std::unique_ptr<TakeReader> reader_;
  bool current_scripts_;
  bool finished_ = false;
  RecordedPass tick_;
  // a batch of ticks is read at once, for locality of the code and data of the reader
  std::array<RecordedPass, 16> ahead_;
  std::size_t ahead_at_ = 0, ahead_end_ = 0;
  std::size_t next_run_ = 0;
  std::uint64_t total_ticks_ = 0;
  ReplayResult result_;
  std::size_t search_ticks_ = 0;  // ticks left to search for the body that diverged
};

/// Describes a result, such as "replayed 600 ticks: all hashes match the take".
std::string text_of(const ReplayResult& result);

}  // namespace limber::engine
