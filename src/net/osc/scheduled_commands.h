// ScheduledCommands: stores bundles until the time of their time tag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "engine/commands/command.h"
#include "net/osc/clock.h"

namespace limber::osc {

/// Scheduled commands, ordered by time tag and, for equal tags, by arrival. [net]
class ScheduledCommands {
 public:
  static constexpr std::size_t kMaxCommands = 1024;
  static constexpr std::size_t kMaxBytes = std::size_t{32} << 20;
  static constexpr std::uint64_t kMaxLead = std::uint64_t{10}
                                            << 32;  ///< 10 s in NTP units; commands farther ahead are not scheduled.

  enum class ScheduleResult : std::uint8_t {
    now,        ///< Not in the future: apply it.
    scheduled,  ///< Stored; pop_due() returns it later.
    too_far,    ///< More than 10 s ahead: apply it now, one of the clocks is wrong.
    full,       ///< The schedule is full: apply it now.
  };

  explicit ScheduledCommands(const NetClock& clock) : clock_(clock) {}

  /// True if a time tag is in the future, by at most kMaxLead. [any]
  bool is_future(std::uint64_t time_tag) const {
    const std::uint64_t now = clock_.ntp();
    return time_tag > now && time_tag - now <= kMaxLead;
  }
  /// Schedules a command. Moves from `command` only if the result is `scheduled`.
  ScheduleResult schedule(std::uint64_t time_tag, engine::Command& command);
  /// Returns the next command that is due, if any.
  std::optional<engine::Command> pop_due();
  /// Nanoseconds until a command is due; empty if none is scheduled.
  std::optional<std::int64_t> timeout() const;
  std::size_t size() const { return scheduled_.size(); }

 private:
  struct Entry {
    engine::Command command;
    std::size_t bytes = 0;
    std::int64_t deadline = 0;  // steady time; bounds the wait if the system clock is set back
  };
  const NetClock& clock_;
  std::size_t bytes_ = 0;
  std::multimap<std::uint64_t, Entry> scheduled_;  // a multimap keeps equal keys in insertion order
};

}  // namespace limber::osc
