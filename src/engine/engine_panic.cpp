// Engine: the panic button.
#include "base/log.h"
#include "engine/engine.h"

namespace limber {

void Engine::ask_panic() { stage_->world.ask_panic(); }

// behind all that hands and scripts have done in this tick, so that nothing of it is left
void Engine::press_panic() {
  Panic& panic = stage_->world.panic();
  if (panic.on()) {
    panic.end();
    const bool back = return_before(panic_tick_);
    log_info("the panic is over{}", back ? "; the show goes on from the newest good moment before it" : "");
    return;
  }
  presets_.stop();
  stage_->dispatch.let_go();
  panic.begin();
  panic_tick_ = stage_->world.tick();
  log_warning(
      "panic: behaviours, forces and the scene's callbacks stop, motors are {}; /transport/panic again ends it, "
      "/transport/reset begins anew",
      panic.holds_motors() ? "held" : "limp");
}

}  // namespace limber
