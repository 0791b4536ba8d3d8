// Messages of sd_notify(3).
#include "app/service_notifier.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/text.h"

namespace limber {

namespace {

using std::chrono::microseconds;

constexpr microseconds kExtension = std::chrono::seconds(15);
constexpr int kFeedsPerInterval = 4;
constexpr int kResetFactor = 3;  // a reset reads the scene in the simulation's loop, and may take as long as the start

}  // namespace

void ServiceNotifier::loading(Clock::time_point now) {
  if (!present() || now - begun_ > kLongestLoad) return;
  (void)manager_.notify(fmt::format("EXTEND_TIMEOUT_USEC={}\nSTATUS=reading the scene", kExtension.count()));
}

void ServiceNotifier::turn(Clock::time_point now) {
  if (!present()) return;
  if (!ready_) return ready(now);
  if (manager_.watchdog() == microseconds(0) || now - fed_ < manager_.watchdog() / kFeedsPerInterval) return;
  if (manager_.notify("WATCHDOG=1")) fed_ = now;
}

// a message that isn't taken is sent again in the next turn
void ServiceNotifier::ready(Clock::time_point now) {
  const auto load = std::chrono::duration_cast<microseconds>(std::min<Clock::duration>(now - begun_, kLongestLoad));
  std::string lines = "READY=1\nSTATUS=playing";
  if (manager_.watchdog() > microseconds(0)) {
    lines += "\nWATCHDOG=1";
    if (load * kResetFactor > manager_.watchdog())
      lines += fmt::format("\nWATCHDOG_USEC={}", (load * kResetFactor).count());
  }
  ready_ = manager_.notify(lines);
  fed_ = now;
}

void ServiceNotifier::status(const std::string& line) const {
  if (present()) (void)manager_.notify("STATUS=" + printable(line));
}

}  // namespace limber
