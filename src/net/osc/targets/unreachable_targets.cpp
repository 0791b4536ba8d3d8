// Only the first failure of a target is logged.
#include "net/osc/targets/unreachable_targets.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/log/log.h"

namespace limber::osc {

namespace {

constexpr int kMaxPerCall = 64;

}  // namespace

void UnreachableTargets::poll(system::UdpSender& sender, engine::Counters& counters, std::int64_t now) {
  for (int i = 0; i < kMaxPerCall; i++) {
    const std::optional<system::SendFailure> failure = sender.next_failure();
    if (!failure) return;
    counters.unsent.fetch_add(1, std::memory_order_relaxed);
    record(failure->to, failure->error, now);
  }
}

void UnreachableTargets::record(const Endpoint& target, int error, std::int64_t now) {
  const auto known = last_failure_.find(target);
  const bool repeated = known != last_failure_.end() && now - known->second < kQuietPeriod;
  if (known == last_failure_.end() && last_failure_.size() >= kMaxTargets)
    last_failure_.erase(std::ranges::min_element(last_failure_, {}, [](const auto& entry) { return entry.second; }));
  last_failure_[target] = now;
  if (repeated) return;
  const std::string reason = error == ECONNREFUSED ? "no listener yet" : std::generic_category().message(error);
  log_info("OSC out {}: {}; sending anyway", endpoint_text(target), reason);
}

}  // namespace limber::osc
