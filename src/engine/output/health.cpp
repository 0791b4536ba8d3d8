// Health: names and descriptions of the items.
#include "engine/output/health.h"

#include <ctime>
#include <utility>

#include <fmt/format.h>

namespace limber::engine {

namespace {

struct ItemText {
  const char* name;
  const char* doc;
};

// in the order of HealthItem
constexpr std::array<ItemText, Health::kItems> kItemTexts = {{
    {"dropped", "OSC messages dropped because the command queue was full"},
    {"dropped_kernel", "OSC datagrams dropped by the system because the socket's buffer was full"},
    {"discarded", "requests that a later panic, pause or end of a take discarded"},
    {"unheard", "messages dropped because the queue of handlers (osc:on) was full"},
    {"unanswered", "answers and events dropped because the output queue was full"},
    {"reduced", "subscribers that currently receive less than they subscribed to"},
    {"limited", "datagrams not sent to senders that have not returned their token"},
    {"loops", "programs that answer /error, and targets that are this program itself"},
    {"handlers", "handlers (osc:on) that failed and are disabled"},
    {"behaviors", "behaviors that failed and are disabled"},
    {"stopped", "calls of scripts that were stopped: too much time or memory"},
    {"bodies", "bodies that the stability check restored or disabled"},
    {"late", "times that the show was a quarter of a second late and skipped the delay"},
    {"files", "files that could not be written: presets, recovery, takes"},
    {"not_owned", "another program owns this scene's presets and recovery file"},
    {"output", "lines of output that no device accepted"},
    {"log", "repeated log lines that were suppressed"},
}};

std::atomic<std::uint64_t> failed_writes_count{0};

}  // namespace

std::int64_t Health::clock() { return static_cast<std::int64_t>(std::time(nullptr)); }

void Health::set(HealthItem item, std::uint64_t count) {
  Item& entry = items_[static_cast<std::size_t>(item)];
  const std::uint64_t before = entry.count.load(std::memory_order_relaxed);
  if (before == count) return;
  if (before == 0) entry.since.store(now_(), std::memory_order_relaxed);
  entry.count.store(count, std::memory_order_relaxed);
}

void Health::add(HealthItem item, std::uint64_t count) {
  Item& entry = items_[static_cast<std::size_t>(item)];
  if (count == 0) return;
  if (entry.count.load(std::memory_order_relaxed) == 0) entry.since.store(now_(), std::memory_order_relaxed);
  entry.count.fetch_add(count, std::memory_order_relaxed);
}

std::vector<HealthEntry> Health::entries() const {
  std::vector<HealthEntry> list;
  for (std::size_t i = 0; i < kItems; i++) {
    const std::uint64_t count = items_[i].count.load(std::memory_order_relaxed);
    if (count == 0) continue;
    list.push_back({static_cast<HealthItem>(i), kItemTexts[i].name, kItemTexts[i].doc, count,
                    items_[i].since.load(std::memory_order_relaxed)});
  }
  return list;
}

bool Health::healthy() const {
  for (const Item& item : items_) {
    if (item.count.load(std::memory_order_relaxed) != 0) return false;
  }
  return true;
}

std::string Health::text() const {
  if (healthy()) return {};
  std::string text;
  for (const HealthEntry& entry : entries())
    text +=
        fmt::format("{}{} {} since {}", text.empty() ? "" : ", ", entry.name, entry.count, time_of_day(entry.since));
  return text;
}

Message Health::answer_message(std::string address) const {
  Message answer{std::move(address), {}};
  const std::int64_t now = now_();
  for (const HealthEntry& entry : entries()) {
    answer.args.push_back(Arg::of(entry.name));
    answer.args.push_back(Arg::of(static_cast<double>(entry.count)));
    answer.args.push_back(Arg::of(static_cast<double>(now - entry.since)));
  }
  return answer;
}

std::string time_of_day(std::int64_t seconds) {
  const auto time = static_cast<std::time_t>(seconds);
  std::tm local_time{};
  localtime_r(&time, &local_time);
  return fmt::format("{:02}:{:02}:{:02}", local_time.tm_hour, local_time.tm_min, local_time.tm_sec);
}

std::uint64_t failed_writes() { return failed_writes_count.load(std::memory_order_relaxed); }
void count_failed_write() { failed_writes_count.fetch_add(1, std::memory_order_relaxed); }

}  // namespace limber::engine
