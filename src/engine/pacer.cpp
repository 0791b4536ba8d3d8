// Pacer: waiting for ticks, and reports of a slow or interrupted machine.
#include "engine/pacer.h"

#include <algorithm>
#include <utility>

#include "base/log/log.h"
#include "base/system/clock.h"

namespace limber::engine {

namespace {
// Longest wait between two checks of the command queue, so that commands take effect even if the next tick is far away.
constexpr auto kMaxWait = std::chrono::milliseconds(50);
}  // namespace

bool Pacer::wait_for_tick(const SimThreadExecutor& requests) {
  const auto next_tick = clock_.next_tick();
  const auto until = std::min(next_tick, Clock::Time::clock::now() + kMaxWait);
  std::unique_lock lock(wake_mutex_);
  const bool requested = wake_.wait_until(lock, until, [&] {
    return stopped() || requests.waiting() || (wakes_for_commands_ && commands_waiting_.load());
  });
  return until == next_tick && !requested;
}

void Pacer::begin_tick(const Session& session) {
  const double speed = session.world_value("speed");
  const bool paused = session.transport.paused();
  clock_.tick(Clock::Time::clock::now(), session.world.timestep(), speed);
  count_stall(paused);
  if (clock_.consume_late() && !paused) {
    log_warning(
        "time runs at {:.2f} × real time instead of {}: this machine can't keep up; fewer substeps or "
        "solver_iterations would help",
        clock_.speed_reached(), speed);
  }
}

// Counts interruptions. A machine that is permanently too slow loses time in small pieces, which begin_tick() reports.
void Pacer::count_stall(bool paused) {
  constexpr double kReportSeconds = 0.5;  // s
  const double lost = clock_.lost_seconds(system::suspended_seconds());
  if (std::exchange(stall_excused_, false) || paused) return;
  lost_time_ += lost;
  if (lost < kReportSeconds || std::exchange(stall_reported_, true)) return;
  log_warning(
      "the show was stalled for {:.1f} s: the program was stopped, or the machine was suspended or busy. The lost time "
      "is not caught up. Reported once; /transport/lost_time has the total",
      lost);
}

void Pacer::stop() {
  {
    const std::scoped_lock lock(wake_mutex_);
    stopped_.store(true);
  }
  wake_.notify_all();
}

void Pacer::wake() {
  notify_commands();
  { const std::scoped_lock lock(wake_mutex_); }
  wake_.notify_all();
}

}  // namespace limber::engine
