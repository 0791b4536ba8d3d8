// Health: whatever the program has dropped, reduced, disabled or lost, how much, and since when. One collection for all
// sources: they report to it, or Engine reads their counters into it after each tick. [any]
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/message.h"

namespace limber {

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
  std::int64_t since = 0;  ///< When it left 0, seconds since 1970.
};

class Health {
 public:
  static constexpr std::size_t kItems = static_cast<std::size_t>(HealthItem::count);

  /// The clock is of seconds since 1970.
  explicit Health(std::int64_t (*now)() = &clock) : now_(now) {}

  /// Its number now: a total, or how many are disabled at the moment; 0: all is well with it. Allocates nothing.
  void set(HealthItem item, std::uint64_t count);
  /// So many more.
  void add(HealthItem item, std::uint64_t count = 1);

  std::uint64_t count(HealthItem item) const { return at(item).count.load(std::memory_order_relaxed); }
  /// Those that are not well, in the order of the items.
  std::vector<HealthEntry> entries() const;
  /// Whether entries() is empty. Allocates nothing.
  bool well() const;

  /// "dropped 17 since 21:14:03, handlers 1 since 21:20:45"; empty: all is well.
  std::string text() const;
  /// Name, count, and seconds ago of each entry.
  Message answer(std::string address) const;

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

/// "21:14:03", local time. [any]
std::string time_of_day(std::int64_t seconds);

/// Files of this program that could not be written so far: presets, recovery, takes. [any]
std::uint64_t failed_writes();
void note_failed_write();

}  // namespace limber
