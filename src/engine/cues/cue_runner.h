// CueRunner: starts cues in a live show: on request, and when their time has come. A cue is expanded into messages,
// which are executed and recorded like those of a controller. [sim]
#pragma once

#include <cstddef>
#include <optional>

#include "engine/commands/command_executor.h"
#include "engine/cues/cue_player.h"

namespace limber::engine {

class CueRunner {
 public:
  CueRunner(ShowState& show, CommandExecutor& executor) : show_(show), executor_(executor) {}

  /// Accepts a request, which run_requested() executes: after the message that contains it.
  Outcome request(const CueRequest& request);
  /// True if the next cue waits for this message. It then is requested, unless the message has the value 0, which
  /// buttons send when they are released.
  bool starts(const Message& message);
  /// Executes the accepted request, if there is one; returns its work in units of LiveInput::kPassWork.
  int run_requested(InputSource& source);
  /// Starts the next cue if its time or its beat has come. `may_step`: simulated time may advance in this pass.
  void run_due(bool may_step, EditScope& edit_scope, InputSource& source);

 private:
  int start(std::size_t index, InputSource& source);
  int run(std::size_t index, InputSource& source);
  bool beat_reached(CueStart at) const;
  void set_state(CueState state, InputSource& source);

  ShowState& show_;
  CommandExecutor& executor_;
  std::optional<std::size_t> requested_cue_;  // its index
  std::optional<bool> requested_pause_;
  bool running_ = false;  // the messages of a cue are executed
};

}  // namespace limber::engine
