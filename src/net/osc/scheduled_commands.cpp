// The first entry of the map is always the next to become due.
#include "net/osc/scheduled_commands.h"

#include <algorithm>
#include <utility>

namespace limber::osc {

namespace {

constexpr std::int64_t kMaxWait = 10'000'000'000;  // ns

}  // namespace

ScheduledCommands::ScheduleResult ScheduledCommands::schedule(std::uint64_t time_tag, engine::Command& command) {
  const std::uint64_t now = clock_.ntp();
  if (time_tag <= now) return ScheduleResult::now;
  if (time_tag - now > kMaxLead) return ScheduleResult::too_far;
  const std::size_t bytes = engine::weight_of(command);
  if (scheduled_.size() >= kMaxCommands || bytes > kMaxBytes - bytes_) return ScheduleResult::full;
  bytes_ += bytes;
  scheduled_.emplace(time_tag, Entry{std::move(command), bytes, clock_.steady() + kMaxWait});
  return ScheduleResult::scheduled;
}

std::optional<engine::Command> ScheduledCommands::pop_due() {
  if (scheduled_.empty()) return std::nullopt;
  const auto first = scheduled_.begin();
  if (first->first > clock_.ntp() && first->second.deadline > clock_.steady()) return std::nullopt;
  std::optional<engine::Command> command = std::move(first->second.command);
  bytes_ -= first->second.bytes;
  scheduled_.erase(first);
  return command;
}

std::optional<std::int64_t> ScheduledCommands::timeout() const {
  if (scheduled_.empty()) return std::nullopt;
  const auto& [tag, entry] = *scheduled_.begin();
  const std::uint64_t now = clock_.ntp();
  if (tag <= now) return 0;
  // 2^32 NTP units are a second; rounded up, so that the command is due when the wait ends. A wait above the maximum
  // means that the system clock was changed.
  const std::uint64_t ahead = std::min(tag - now, kMaxLead);
  const std::uint64_t fraction = (ahead & 0xffffffffu) * 1'000'000'000u >> 32;
  const auto by_tag = static_cast<std::int64_t>((ahead >> 32) * 1'000'000'000u + fraction + 1);
  return std::clamp<std::int64_t>(entry.deadline - clock_.steady(), 0, by_tag);
}

}  // namespace limber::osc
