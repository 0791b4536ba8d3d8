// TakeRecorder: collects the inputs and result hashes of each tick and passes them to a TakeWriter. [sim]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/takes/encoding.h"
#include "engine/takes/writer.h"
#include "sim/world/world.h"

namespace limber::engine {

class TakeRecorder {
 public:
  /// Number of body hashes per tick; larger scenes rotate through their bodies.
  static constexpr std::size_t kBodyHashesPerTick = 32;
  /// Average bytes of property values that may be hashed per tick: determines how often the full state is hashed.
  static constexpr std::size_t kStateBytesPerTick = 4096;

  /// `on_failure` is called with the reason when the file can't be written. [the writer's thread]
  TakeRecorder(BackgroundWriter& writer, TakeWriter::Target target, TakeInitialState initial_state,
               std::function<void(const std::string&)> on_failure);

  /// Waits until the file has been created, or returns the reason why it can't be. Call before the first tick.
  Result<void> wait_until_open() { return writer_->wait_until_open(); }
  bool failed() const { return writer_->failed(); }
  /// Number of recorded ticks; passes while paused are not counted.
  std::uint64_t ticks() const { return ticks_; }

  /// Records the start of a run of the scene; returns its index in this tick, for run_succeeded().
  std::size_t begin_run(TakeSceneRun run);
  /// Records that the run succeeded, and the files that it has read.
  void run_succeeded(std::size_t run, TakeFiles files);
  /// Records an input; see InputLog::record().
  void record_message(const Message& message, const CommandOrigin& origin, bool evaluate = false) {
    inputs_.record(message, origin, evaluate);
  }
  /// Writes the pass; a pass without inputs while paused is skipped. `with_state_hash`: include the state hash in any
  /// case. Doesn't allocate once its buffers have grown.
  void end_tick(bool running, sim::World& world, const script::CallLog& calls,
                const std::function<std::uint64_t()>& state_hash, bool with_state_hash = false);

  /// Ends the take, or discards it and its file. Returns the writer, which may need a while to finish in the
  /// background.
  std::unique_ptr<TakeWriter> finish(const TakeEnd& end);
  std::unique_ptr<TakeWriter> abandon();

 private:
  std::unique_ptr<TakeWriter> writer_;
  InputLog inputs_;
  RecordedPass tick_;
  std::uint32_t files_ = 0;
  std::uint64_t ticks_ = 0;
  std::size_t state_hash_budget_ = 0;
  std::size_t next_body_ = 0;
  std::string payload_, frame_;  // scratch
};

}  // namespace limber::engine
