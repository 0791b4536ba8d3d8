// Health: counts everything that the program has dropped, reduced, disabled or lost, and since when. One collection for
// all sources: they report to it, or Engine copies their counters into it after each tick. [any]
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"

namespace limber::engine {

/// Kinds of problems. health.cpp has their names and descriptions.
enum class HealthItem : std::uint8_t {
  dropped,
  dropped_kernel,
  discarded,
  unheard,
  unanswered,
  reduced,
  limited,
  loops,
  handlers,
  behaviors,
  stopped,
  bodies,
  late,
  files,
  not_owned,
  output,
  log,
  count
};

struct HealthEntry {
  HealthItem item = HealthItem::count;
  const char* name = "";  ///< "dropped_kernel"
  const char* doc = "";   ///< "OSC datagrams that the system dropped: ..."
  std::uint64_t count = 0;
  std::int64_t since = 0;  ///< Time when `count` became nonzero, seconds since 1970.
};

class Health {
 public:
  static constexpr std::size_t kItems = static_cast<std::size_t>(HealthItem::count);

  /// `now` returns seconds since 1970.
  explicit Health(std::int64_t (*now)() = &clock) : now_(now) {}

  /// Sets the count of an item: a total, or the number that is disabled at the moment; 0: healthy. Does not allocate.
  void set(HealthItem item, std::uint64_t count);
  /// Increases the count of an item.
  void add(HealthItem item, std::uint64_t count = 1);

  std::uint64_t count(HealthItem item) const { return at(item).count.load(std::memory_order_relaxed); }
  /// Returns the items with a nonzero count, in the order of HealthItem.
  std::vector<HealthEntry> entries() const;
  /// True if all counts are 0. Does not allocate.
  bool healthy() const;

  /// Returns a text such as "dropped 17 since 21:14:03, handlers 1 since 21:20:45"; empty if healthy().
  std::string text() const;
  /// Returns a message with name, count and age in seconds of each entry.
  Message answer_message(std::string address) const;

 private:
  struct Item {
    std::atomic<std::uint64_t> count{0};
    std::atomic<std::int64_t> since{0};
  };
  static std::int64_t clock();
  const Item& at(HealthItem item) const { return items_[static_cast<std::size_t>(item)]; }

  std::int64_t (*now_)();
  std::array<Item, kItems> items_;
};

/// Formats seconds since 1970 as local time, such as "21:14:03". [any]
std::string time_of_day(std::int64_t seconds);

/// Returns the number of failed writes of presets, recovery files and takes by this program. [any]
std::uint64_t failed_writes();
void count_failed_write();

}  // namespace limber::engine
