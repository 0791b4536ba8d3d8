// Rewinder: rewinds simulated time by restoring a checkpoint and simulating the recorded passes after it again, without
// output. [sim]
#pragma once

#include "engine/input/recorded_input.h"
#include "engine/simulator.h"

namespace limber::engine {

class Rewinder {
 public:
  Rewinder(ShowState& show, CommandExecutor& executor, Simulator& simulator)
      : show_(show), executor_(executor), simulator_(simulator) {}

  /// Rewinds. Inputs of the current tick that were executed before are discarded as well; the remaining ones are
  /// executed at the restored time.
  Outcome rewind(const Transport::RewindRequest& request);

 private:
  /// A target and the reason why the history does not reach back to the requested one; empty: it does.
  struct Target {
    RewindTarget target;
    std::string limit_reason;
  };
  Target target_of(const Transport::RewindRequest& request) const;
  void resimulate_until(const RewindTarget& target);
  bool resimulate_passes(const RewindTarget& target);
  void resimulate(RecordedPass& pass);

  ShowState& show_;
  CommandExecutor& executor_;
  Simulator& simulator_;
};

}  // namespace limber::engine
