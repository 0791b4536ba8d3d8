// Sends the messages of sd_notify(3).
#include "app/show/service_notifier.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::app {

namespace {

using std::chrono::microseconds;

constexpr microseconds kExtension = std::chrono::seconds(15);
constexpr int kFeedsPerInterval = 4;
constexpr int kResetFactor = 3;  // a reset loads the scene in the simulation's loop and may take as long as the start

}  // namespace

void ServiceNotifier::loading(Clock::time_point now) {
  if (!present() || now - start_time_ > kMaxLoadTime) return;
  (void)manager_.notify(fmt::format("EXTEND_TIMEOUT_USEC={}\nSTATUS=loading the scene", kExtension.count()));
}

void ServiceNotifier::on_iteration(Clock::time_point now) {
  if (!present()) return;
  if (!ready_) return ready(now);
  if (manager_.watchdog() == microseconds(0) || now - last_fed_ < manager_.watchdog() / kFeedsPerInterval) return;
  if (manager_.notify("WATCHDOG=1")) last_fed_ = now;
}

// if sending fails, it is retried in the next iteration
void ServiceNotifier::ready(Clock::time_point now) {
  const auto load =
      std::chrono::duration_cast<microseconds>(std::min<Clock::duration>(now - start_time_, kMaxLoadTime));
  std::string lines = "READY=1\nSTATUS=playing";
  if (manager_.watchdog() > microseconds(0)) {
    lines += "\nWATCHDOG=1";
    if (load * kResetFactor > manager_.watchdog())
      lines += fmt::format("\nWATCHDOG_USEC={}", (load * kResetFactor).count());
  }
  ready_ = manager_.notify(lines);
  last_fed_ = now;
}

void ServiceNotifier::status(const std::string& line) const {
  if (present()) (void)manager_.notify("STATUS=" + printable(line));
}

}  // namespace limber::app
