// The two clocks of the network thread, injected so that tests can control them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

namespace limber::osc {

/// Real time as monotonic time and as NTP time.
struct NetClock {
  /// Monotonic time in nanoseconds with an arbitrary zero.
  std::function<std::int64_t()> steady = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  /// NTP time as in OSC time tags: seconds since 1900 in the upper 32 bits, units of 1/2^32 s in the lower.
  std::function<std::uint64_t()> ntp = [] {
    constexpr std::uint64_t kFrom1900To1970 = 2208988800u;
    const auto ns = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
            .count());
    return (ns / 1'000'000'000u + kFrom1900To1970) << 32 | (ns % 1'000'000'000u << 32) / 1'000'000'000u;
  };
};

}  // namespace limber::osc
