// The first in the map is always the next that is due.
#include "osc/held.h"

#include <algorithm>
#include <utility>

namespace limber {

namespace {

constexpr std::int64_t kLongestWait = 10'000'000'000;  // ns

}  // namespace

HeldCommands::Verdict HeldCommands::offer(std::uint64_t time_tag, Command& command) {
  const std::uint64_t now = clock_.ntp();
  if (time_tag <= now) return Verdict::now;
  if (time_tag - now > kFarthest) return Verdict::far;
  const std::size_t bytes = weight_of(command);
  if (held_.size() >= kMost || bytes > kMostBytes - bytes_) return Verdict::full;
  bytes_ += bytes;
  held_.emplace(time_tag, Entry{std::move(command), bytes, clock_.steady() + kLongestWait});
  return Verdict::held;
}

std::optional<Command> HeldCommands::due() {
  if (held_.empty()) return std::nullopt;
  const auto first = held_.begin();
  if (first->first > clock_.ntp() && first->second.at_latest > clock_.steady()) return std::nullopt;
  std::optional<Command> command = std::move(first->second.command);
  bytes_ -= first->second.bytes;
  held_.erase(first);
  return command;
}

std::optional<std::int64_t> HeldCommands::wait() const {
  if (held_.empty()) return std::nullopt;
  const auto& [tag, entry] = *held_.begin();
  const std::uint64_t now = clock_.ntp();
  if (tag <= now) return 0;
  // 2^32 NTP units are a second; rounded up, so that it is due when the wait is over. More than the longest wait
  // means that the system's clock was turned
  const std::uint64_t ahead = std::min(tag - now, kFarthest);
  const std::uint64_t fraction = (ahead & 0xffffffffu) * 1'000'000'000u >> 32;
  const auto by_tag = static_cast<std::int64_t>((ahead >> 32) * 1'000'000'000u + fraction + 1);
  return std::clamp<std::int64_t>(entry.at_latest - clock_.steady(), 0, by_tag);
}

}  // namespace limber
