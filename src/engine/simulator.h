// Simulator: the part of a pass after its messages: morphs, handlers and callbacks of the scene, and a time step. [sim]
#pragma once

#include "engine/panic_control.h"
#include "engine/show_state.h"

namespace limber::engine {

class Simulator {
 public:
  explicit Simulator(ShowState& show) : show_(show) {}

  /// Runs the rest of a pass, with a time step if `running`. `input` decides how many handlers are called. Sets the
  /// `times` of the phases that were run.
  void simulate(bool running, InputSource& input, PhaseTimes& times);

 private:
  void call_handlers(InputSource& input);
  void call_handler();
  void execute_preset_requests();
  void send_contacts();
  void send_contact_points();

  ShowState& show_;
  PanicControl panic_{show_};
};

}  // namespace limber::engine
