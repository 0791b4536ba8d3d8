// Tick by tick, whatever a tick's length is.
#include "app/moments.h"

#include <algorithm>

namespace limber {

namespace {

constexpr int kMostIdle = 1000;

}  // namespace

Moments::Moments(Engine& engine, EngineLink& link, const std::function<bool()>& cancel)
    : engine_(engine), link_(link), cancel_(cancel) {
  before_ = now_ = link.snapshots.read();
}

Moments::Went Moments::go_to(double seconds) {
  int idle = 0;  // ticks without time
  while (elapsed_ < seconds - 1e-9) {
    if (cancel_()) return Went::cancelled;
    if (engine_.replays() && engine_.replay_over()) return Went::ended;
    before_ = now_;
    before_tick_();
    engine_.tick();
    link_.outbox.drain(gone_);
    now_ = link_.snapshots.read();
    after_tick_();
    // after a reset time begins anew, after a rewind it goes on from earlier; the film goes on by a tick
    const bool jumped = now_->time < before_->time;
    const double step = jumped ? std::min(now_->time, last_step_) : now_->time - before_->time;
    if (step > 0) last_step_ = step;
    idle = step > 0 ? 0 : idle + 1;
    // a take goes on by itself, however many hands came while its time stood still
    if (idle > 0 && !engine_.replays() && (now_->paused || idle > kMostIdle)) return Went::stuck;
    elapsed_before_ = elapsed_;
    elapsed_ += step;
  }
  return Went::there;
}

double Moments::mix(double seconds) const {
  const double step = elapsed_ - elapsed_before_;
  return step <= 0 || elapsed_ - seconds < 1e-9 ? 1 : (seconds - elapsed_before_) / step;
}

}  // namespace limber
