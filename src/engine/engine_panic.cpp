// Engine: start and end of a panic.
#include "base/log/log.h"
#include "engine/engine.h"

namespace limber {

void Engine::request_panic() { session_->world.request_panic(); }

// Runs after all commands and scripts of the tick, so that the panic overrides all their effects.
void Engine::begin_panic() {
  World& world = session_->world;
  if (world.panic().on() || !world.consume_panic_request()) return;
  presets_.stop();
  session_->dispatcher.release_mouse_springs();
  world.panic().begin();
  if (!has_current_rules()) world.panic().end_first_second();
  ignored_panic_reported_ = false;
  history_.pin();
  log_warning(
      "panic: behaviors, forces and callbacks of the scene are stopped, motors are {}. /transport/panic_end ends it, "
      "as does /transport/panic after its first second; /transport/reset restarts the scene",
      world.panic().holds_motors() ? "held" : "limp");
}

// Runs before the other phases of the tick, so that they act on the restored checkpoint.
void Engine::end_panic() {
  World& world = session_->world;
  const bool end = world.consume_panic_end_request();
  if (!world.panic().on()) return;
  if (!end) {
    if (!world.consume_panic_request()) return;
    if (!world.panic().first_second_over()) {
      if (!std::exchange(ignored_panic_reported_, true))
        log_info("panic: another request in the first second is ignored; /transport/panic_end ends the panic");
      return;
    }
  }
  const std::uint64_t start_tick = world.panic().start_tick();
  world.panic().end();
  const bool panic_requested = world.consume_panic_request();  // a panic after /transport/panic_end begins another one
  const bool restored = restore_before(start_tick);
  if (panic_requested) world.request_panic();
  log_info("panic ended{}", restored ? "; the show continues from the last checkpoint before it" : "");
}

// Measures the age of a panic in real time, or with --fast in simulated time, so that equal runs have equal results.
void Engine::update_panic_age(bool may_step) {
  const double now = options_.clock();
  const double real_seconds = now - std::exchange(last_pass_time_, now);
  World& world = session_->world;
  if (is_replaying() || !world.panic().on() || world.panic().first_second_over()) {
    panic_age_ = 0;
    return;
  }
  panic_age_ += !options_.fast ? real_seconds : may_step ? world.timestep() : 0;
  if (panic_age_ < kPanicGuardSeconds - 1e-9) return;
  world.panic().end_first_second();
  record_event({TakeEvent::Kind::panic_settled, 0});
}

}  // namespace limber
