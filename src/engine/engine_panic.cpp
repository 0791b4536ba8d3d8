// Engine: the panic button.
#include "base/log.h"
#include "engine/engine.h"

namespace limber {

void Engine::ask_panic() { stage_->world.ask_panic(); }

// behind all that hands and scripts have done in this tick, so that nothing of it is left
void Engine::begin_panic() {
  World& world = stage_->world;
  if (world.panic().on() || !world.take_panic_request()) return;
  presets_.stop();
  stage_->dispatch.let_go();
  world.panic().begin();
  history_.hold();
  log_warning(
      "panic: behaviours, forces and the scene's callbacks stop, motors are {}; /transport/panic again ends it, "
      "/transport/reset begins anew",
      world.panic().holds_motors() ? "held" : "limp");
}

// ahead of all that the tick does: it is done to the moment that comes back
void Engine::end_panic() {
  World& world = stage_->world;
  if (!world.panic().on() || !world.take_panic_request()) return;
  const std::uint64_t began = world.panic().began();
  world.panic().end();
  const bool back = return_before(began);
  log_info("the panic is over{}", back ? "; the show goes on from the newest good moment before it" : "");
}

}  // namespace limber
