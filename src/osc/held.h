// Bundles with a time tag ahead of now wait here until they are due.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "engine/command.h"
#include "osc/clock.h"

namespace limber {

/// Waiting commands, in order of their time tags; equal tags in order of arrival. [net]
class HeldCommands {
 public:
  static constexpr std::size_t kMost = 1024;
  static constexpr std::size_t kMostBytes = std::size_t{32} << 20;
  static constexpr std::uint64_t kFarthest = std::uint64_t{10} << 32;  ///< 10 s, NTP.

  enum class Verdict : std::uint8_t {
    now,   ///< Not ahead: apply it.
    held,  ///< Taken; it comes out of due() later.
    far,   ///< More than 10 s ahead: apply it now, a clock is wrong.
    full,  ///< No room: apply it now.
  };

  explicit HeldCommands(const NetClock& clock) : clock_(clock) {}

  /// Whether a time tag is ahead of now, and not by too much. [any]
  bool waits(std::uint64_t time_tag) const {
    const std::uint64_t now = clock_.ntp();
    return time_tag > now && time_tag - now <= kFarthest;
  }
  /// Moves from `command` only when the verdict is `held`.
  Verdict offer(std::uint64_t time_tag, Command& command);
  /// The next command that is due, or nothing.
  std::optional<Command> due();
  /// Nanoseconds until something is due; nothing when nothing waits.
  std::optional<std::int64_t> wait() const;
  std::size_t size() const { return held_.size(); }

 private:
  struct Entry {
    Command command;
    std::size_t bytes = 0;
    std::int64_t at_latest = 0;  // steady time; a system clock that is turned back must not keep it for ever
  };
  const NetClock& clock_;
  std::size_t bytes_ = 0;
  std::multimap<std::uint64_t, Entry> held_;  // a multimap keeps equal keys in order of insertion
};

}  // namespace limber
