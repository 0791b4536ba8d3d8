// TakeRecorder: gathers what reaches a tick and what comes of it, and hands it to the writer. [sim]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/take_text.h"
#include "engine/take_writer.h"
#include "sim/world.h"

namespace limber {

class TakeRecorder {
 public:
  /// The bodies whose hashes stand in a tick; more take turns.
  static constexpr std::size_t kBodies = 32;
  /// Bytes of rows that a tick may hash: the state's hash comes as often as that allows.
  static constexpr std::size_t kStateBytes = 4096;

  TakeRecorder(TakeWriter::Place place, TakeBegin begin, std::function<void(const std::string&)> failed);

  /// Waits until the file is there, or can't be; before time goes.
  Result<void> opened() { return writer_->opened(); }
  bool failed() const { return writer_->failed(); }
  /// Ticks in it so far, those in which time stood still left out.
  std::uint64_t ticks() const { return ticks_; }

  /// A run of the scene begins: its number in this tick.
  std::size_t begin_run(TakeRun run);
  /// It was good, and has read this.
  void run_was_good(std::size_t run, TakeFiles files);
  void message(const Message& message, const Origin& origin);
  void evaluation(const std::string& text, const Origin& origin);
  /// Where nothing happened while time stood still, nothing is written. `whole`: the state's hash stands in it.
  /// Allocates nothing once its buffers have grown.
  void end_tick(bool running, World& world, const CallLedger& calls, const std::function<std::uint64_t()>& state_hash,
                bool whole = false);

  /// The take ends here, or never was. What writes it may then go on for a while.
  std::unique_ptr<TakeWriter> finish(const TakeEnd& end);
  std::unique_ptr<TakeWriter> abandon();

 private:
  std::unique_ptr<TakeWriter> writer_;
  TakeForms forms_;
  TakeTick tick_;
  std::string messages_;
  std::size_t message_count_ = 0;
  std::uint32_t files_ = 0;
  std::uint64_t ticks_ = 0;
  std::size_t state_credit_ = 0;
  std::size_t next_body_ = 0;
  Message console_;              // scratch
  std::string payload_, frame_;  // scratch
};

}  // namespace limber
