// TakePlayer: gives an engine what a take holds, tick by tick, and compares what comes of it. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/take_reader.h"
#include "sim/world.h"

namespace limber {

/// What a replay found.
struct TakeVerdict {
  std::uint64_t ticks = 0;              ///< Replayed.
  std::optional<std::uint64_t> parted;  ///< The first tick whose hash is another one.
  std::string body;                     ///< The first body that moves otherwise, where one was found.
  std::string damage;                   ///< What is wrong in the file behind the last tick.
  bool cut_off = false;                 ///< The take has no end.
  bool compared = true;                 ///< False: it is of a version with other hashes.
  std::string recorded_by;              ///< Which Limber.
};

class TakePlayer {
 public:
  /// `current_scripts`: the scene and its files are read from the disk as they are now.
  static Result<std::unique_ptr<TakePlayer>> open(const std::string& path, bool current_scripts);

  const TakeBegin& begin() const { return reader_->begin(); }
  bool current_scripts() const { return current_; }
  /// Whether saves kept timers when it was recorded.
  bool keeps_timers() const { return reader_->header().version >= kTakeKeepsTimers; }
  /// See kTakeRules.
  int rules() const { return reader_->header().rules; }
  /// Goes on to the next tick; false: there is none, or the runs have parted and nothing more is to be found out.
  bool next();
  /// Whether time goes on in the tick that next() will bring.
  bool steps_next() const { return ahead() && ahead_[ahead_at_].running; }
  bool over() const { return over_; }
  const TakeTick& tick() const { return tick_; }
  /// The tick's, for who carries them out and may change them.
  std::span<TakeMessage> messages() { return tick_.messages; }
  /// The tick's calls that are stopped again; none where the runs may part.
  std::vector<StoppedCall> stopped() const { return current_ ? std::vector<StoppedCall>() : tick_.stopped; }
  /// Ticks replayed so far, and those of the whole take; where time stood still does not count.
  std::uint64_t ticks() const { return found_.ticks; }
  std::uint64_t whole() const { return whole_; }

  /// The tick's next run, when it is one of that kind; null: it is none.
  const TakeRun* take_run(TakeRun::Kind kind);
  bool comes(TakeRun::Kind kind) const { return next_run_ < tick_.runs.size() && tick_.runs[next_run_].kind == kind; }
  /// The tick's next run, when it was asked for from outside.
  const TakeRun* run_from_outside() const;
  std::shared_ptr<const Sources> sources(const TakeRun& run) { return reader_->sources(run.files); }
  std::optional<TakeReader::PresetBook> presets(const TakeRun& run) const { return reader_->presets(run.files); }

  /// After the tick.
  void compare(World& world, const CallLedger& calls, const std::function<std::uint64_t()>& state_hash);
  TakeVerdict verdict() const;

 private:
  TakePlayer(std::unique_ptr<TakeReader> reader, bool current) : reader_(std::move(reader)), current_(current) {}
  void read_ahead();
  /// The take has more than the present tick.
  bool ahead() const { return ahead_at_ < ahead_end_; }
  /// Its hashes are made as ours.
  bool comparable() const { return reader_->header().version >= kTakeComparable; }
  void find_body(World& world);
  bool ends_well(const std::function<std::uint64_t()>& state_hash) const;

  std::unique_ptr<TakeReader> reader_;
  bool current_;
  bool over_ = false;
  TakeTick tick_;
  // several are read at once, while what reading them takes is near
  std::array<TakeTick, 16> ahead_;
  std::size_t ahead_at_ = 0, ahead_end_ = 0;
  std::size_t next_run_ = 0;
  std::uint64_t whole_ = 0;
  TakeVerdict found_;
  std::size_t looking_ = 0;  // ticks in which a body may still be found
};

/// "replayed 600 ticks: every hash is the take's", or where it is not.
std::string text_of(const TakeVerdict& verdict);

}  // namespace limber
