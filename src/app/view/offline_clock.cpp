// Ticks until a time is reached, for any time step.
#include "app/view/offline_clock.h"

#include <algorithm>

namespace limber::app {

namespace {

constexpr int kMaxIdleTicks = 1000;

}  // namespace

OfflineClock::OfflineClock(engine::Engine& engine, engine::EngineLink& link, const std::function<bool()>& cancel)
    : engine_(engine), link_(link), cancel_(cancel) {
  before_ = now_ = link.snapshots.read();
}

OfflineClock::Outcome OfflineClock::advance_to(double seconds) {
  int idle = 0;  // consecutive ticks that didn't advance time
  while (elapsed_ < seconds - 1e-9) {
    if (cancel_()) return Outcome::canceled;
    if (engine_.is_replaying() && engine_.replay_finished()) return Outcome::ended;
    before_ = now_;
    before_tick_();
    engine_.tick();
    link_.output_queue.drain(discarded_);
    now_ = link_.snapshots.read();
    after_tick_();
    // a reset or rewind sets the time back; elapsed time still advances by one tick
    const bool jumped = now_->time < before_->time;
    const double step = jumped ? std::min(now_->time, last_step_) : now_->time - before_->time;
    if (step > 0) last_step_ = step;
    idle = step > 0 ? 0 : idle + 1;
    // a replay continues by itself even if time was paused for long in the recording
    if (idle > 0 && !engine_.is_replaying() && (now_->paused || idle > kMaxIdleTicks)) return Outcome::stuck;
    elapsed_before_ = elapsed_;
    elapsed_ += step;
  }
  return Outcome::reached;
}

double OfflineClock::mix(double seconds) const {
  const double step = elapsed_ - elapsed_before_;
  return step <= 0 || elapsed_ - seconds < 1e-9 ? 1 : (seconds - elapsed_before_) / step;
}

}  // namespace limber::app
