// PanicControl: start and end of a panic. [sim]
#pragma once

#include "engine/show_state.h"

namespace limber::engine {

class PanicControl {
 public:
  explicit PanicControl(ShowState& show) : show_(show) {}

  /// Begins a requested panic. Call it after all commands and scripts of a pass, so that the panic overrides all their
  /// effects.
  void begin_if_requested();
  /// Ends a panic if that is requested, and restores the newest checkpoint before it. Call it before the other phases
  /// of a pass, so that they act on the restored state.
  void end_if_requested();

 private:
  bool end_requested(sim::World& world);

  ShowState& show_;
  bool ignored_request_reported_ = false;  // an ignored panic request was logged
};

}  // namespace limber::engine
