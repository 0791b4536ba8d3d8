// TakeRecording: the take that is recorded, if there is one, and takes that are still being written. While no take is
// recorded, its functions do nothing. [sim]
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/show_state.h"
#include "engine/takes/recorder.h"
#include "engine/takes/take_node.h"

namespace limber::engine {

/// Returns the options, seeds, presets and overrides with which a take begins. `reset`: it begins with a reset of the
/// running session.
TakeInitialState capture_initial_state(const ShowState& show, bool reset);
/// Sets the state that a take began with a reset from.
void apply_initial_state(ShowState& show, const TakeInitialState& state);

class TakeRecording {
 public:
  explicit TakeRecording(ShowState& show) : show_(show) {}

  /// Executes /take/record, /take/stop or /take/play while no take is replayed. The effect follows after the pass.
  Outcome request(const Message& message);
  /// True if a recording is to begin after this pass.
  bool requested() const { return requested_file_.has_value(); }
  /// True if a take is recorded or requested.
  bool active() const { return recorder_ != nullptr || requested(); }

  /// Starts a recording to the file in the options, at the start of the program. Waits for the disk.
  Result<void> start();
  /// Starts the requested recording and returns its file. A reset must follow.
  std::string begin_requested();
  /// Ends the recording.
  void end();
  /// Discards the recording and its file.
  void abandon();
  /// Sends and logs the reason why a recording failed.
  void report_failure(const std::string& why) { failure_reporter()(why); }

  void record(const Message& message, const CommandOrigin& origin, bool evaluate);
  /// Records the start of a run of the scene; returns its index for run_succeeded().
  std::size_t begin_run(TakeSceneRun run) { return recorder_ == nullptr ? 0 : recorder_->begin_run(std::move(run)); }
  /// Records that a run succeeded, with the files of its session and the presets that it has read.
  void run_succeeded(std::size_t run, const Session& session, std::optional<PresetList> presets = {},
                     const std::string& preset_file = "");
  /// Records the end of a pass, with the state hash in any case if the take `begins` there; ends a recording that
  /// failed.
  void end_pass(bool running, bool begins = false);
  /// Ends the recording if /take/stop has requested that.
  void end_if_requested();

  /// The state for TakeNode; nothing if no take is recorded.
  std::optional<TakeNode::Status> status() const;
  /// Waits until ended takes are on the disk. [any but sim]
  void finish_saving() { ended_.clear(); }

 private:
  std::function<void(const std::string&)> failure_reporter();

  ShowState& show_;
  std::unique_ptr<TakeRecorder> recorder_;
  std::string name_;
  std::vector<std::unique_ptr<TakeWriter>> ended_;  // ended takes that may still be written to disk
  std::optional<std::string> requested_file_;       // file of the recording that begins at the end of this pass
  bool end_requested_ = false;                      // the recording ends at the end of this pass
};

}  // namespace limber::engine
