// The first of many failures of an end is logged.
#include "osc/refusals.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/log.h"

namespace limber {

namespace {

constexpr int kMostAtOnce = 64;

}  // namespace

void Refusals::take(system::UdpSender& sender, Counters& counters, std::int64_t now) {
  for (int i = 0; i < kMostAtOnce; i++) {
    const std::optional<system::SendFailure> failure = sender.next_failure();
    if (!failure) return;
    counters.unsent.fetch_add(1, std::memory_order_relaxed);
    note(failure->to, failure->error, now);
  }
}

void Refusals::note(const Endpoint& end, int error, std::int64_t now) {
  const auto known = last_.find(end);
  const bool again = known != last_.end() && now - known->second < kPause;
  if (known == last_.end() && last_.size() >= kMost)
    last_.erase(std::ranges::min_element(last_, {}, [](const auto& entry) { return entry.second; }));
  last_[end] = now;
  if (again) return;
  const std::string why = error == ECONNREFUSED ? "nobody listens there" : std::generic_category().message(error);
  log_info("OSC out {}: {}; it is sent to all the same", endpoint_text(end), why);
}

}  // namespace limber
