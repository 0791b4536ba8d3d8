// PanicControl: requests for a panic and its end.
#include "engine/panic_control.h"

#include <utility>

#include "base/log/log.h"

namespace limber::engine {

void PanicControl::begin_if_requested() {
  sim::World& world = show_.session->world;
  if (world.panic().on() || !std::exchange(world.requests().panic, false)) return;
  show_.presets.stop();
  show_.session->dispatcher.release_mouse_springs();
  world.panic().begin();
  if (show_.rules.before_first_revision) world.panic().end_first_second();
  ignored_request_reported_ = false;
  show_.history.pin();
  log_warning(
      "panic: behaviors, forces and callbacks of the scene are stopped, motors are {}. /transport/panic_end ends it, "
      "as does /transport/panic after its first second; /transport/reset restarts the scene",
      world.panic().holds_motors() ? "held" : "limp");
}

// A second request for a panic ends it, too, but not in its first second.
bool PanicControl::end_requested(sim::World& world) {
  const bool end = std::exchange(world.requests().panic_end, false);
  if (!world.panic().on()) return false;
  if (end) return true;
  if (!std::exchange(world.requests().panic, false)) return false;
  if (world.panic().first_second_over()) return true;
  if (!std::exchange(ignored_request_reported_, true))
    log_info("panic: another request in the first second is ignored; /transport/panic_end ends the panic");
  return false;
}

void PanicControl::end_if_requested() {
  sim::World& world = show_.session->world;
  if (!end_requested(world)) return;
  const std::uint64_t start_tick = world.panic().start_tick();
  world.panic().end();
  const bool panic_requested =
      std::exchange(world.requests().panic, false);  // a panic after /transport/panic_end begins another one
  const bool restored = show_.restore_before(start_tick);
  if (panic_requested) world.requests().panic = true;
  log_info("panic ended{}", restored ? "; the show continues from the last checkpoint before it" : "");
}

}  // namespace limber::engine
