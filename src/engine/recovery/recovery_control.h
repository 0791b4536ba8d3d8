// RecoveryControl: crash recovery of property values: offers or restores those of a run that crashed, and supplies the
// current ones to the RecoverySaver. Does nothing without a recovery folder. [sim]
#pragma once

#include <memory>
#include <string>

#include "engine/recovery/recovery_saver.h"
#include "engine/show_state.h"

namespace limber::engine {

class RecoveryControl {
 public:
  explicit RecoveryControl(ShowState& show) : show_(show) {}

  /// Opens the recovery file, before the scene runs. Offers or loads values of a run that crashed.
  void open();
  /// Applies recovered values (ShowState::recovered). Call it before those of --preset and --set, which take
  /// precedence.
  Result<void> apply();
  /// Starts to save values.
  void begin();
  /// Submits the values if they are due. `script`: those that the last run of the scene left.
  void update(const std::shared_ptr<const Preset>& script);
  /// While `on`, a take is played in the show, and nothing is saved.
  void set_suspended(bool on) { suspended_ = on; }
  /// True if another program owns the recovery file of the scene.
  bool owned_elsewhere() const { return saver_ != nullptr && !saver_->owned(); }
  /// Marks the show as properly ended. [any but sim, after Engine::run()]
  void end();

 private:
  ShowState& show_;
  std::unique_ptr<RecoverySaver> saver_;  // null: no recovery file
  std::string crash_time_;                // time of the crash; empty: the recovered values come from a take
  std::uint64_t submitted_version_ = 0;   // version of the store that was last submitted
  std::string submitted_scene_;           // scene that was last submitted
  bool suspended_ = false;
};

}  // namespace limber::engine
