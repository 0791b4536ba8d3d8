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
  if (!has_rules()) world.panic().settle();
  ignored_said_ = false;
  history_.hold();
  log_warning(
      "panic: behaviours, forces and the scene's callbacks stop, motors are {}; /transport/panic_end ends it, and so "
      "does /transport/panic after its first second; /transport/reset begins anew",
      world.panic().holds_motors() ? "held" : "limp");
}

// ahead of all that the tick does: it is done to the moment that comes back
void Engine::end_panic() {
  World& world = stage_->world;
  const bool end = world.take_panic_end_request();
  if (!world.panic().on()) return;
  if (!end) {
    if (!world.take_panic_request()) return;
    if (!world.panic().settled()) {
      if (!std::exchange(ignored_said_, true))
        log_info("panic: another request in its first second is ignored; /transport/panic_end ends it");
      return;
    }
  }
  const std::uint64_t began = world.panic().began();
  world.panic().end();
  const bool pressed = world.take_panic_request();  // behind /transport/panic_end: it begins again
  const bool back = return_before(began);
  if (pressed) world.ask_panic();
  log_info("the panic is over{}", back ? "; the show goes on from the newest good moment before it" : "");
}

// Real time in a show; with --fast the time of ticks, so that equal runs are equal.
void Engine::age_panic(bool may_step) {
  const double now = options_.clock();
  const double real = now - std::exchange(pass_at_, now);
  World& world = stage_->world;
  if (replays() || !world.panic().on() || world.panic().settled()) {
    panic_age_ = 0;
    return;
  }
  panic_age_ += !options_.fast ? real : may_step ? world.timestep() : 0;
  if (panic_age_ < kPanicFirst - 1e-9) return;
  world.panic().settle();
  note_event({TakeEvent::Kind::panic_settled, 0});
}

}  // namespace limber
