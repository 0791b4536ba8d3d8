// CommandInbox: the commands that wait for the simulation, bounded; and, in a lane of their own, urgent requests, none
// of which is ever dropped.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "base/inbox.h"
#include "engine/urgent.h"

namespace limber {

class CommandInbox {
 public:
  /// Urgent requests that wait; of more than that, an older one of the same kind is replaced.
  static constexpr std::size_t kMostUrgent = 64;

  CommandInbox(std::size_t capacity, std::size_t bytes) : waiting_(capacity, bytes) {}

  /// Urgent requests move to their lane, and messages before them in the command that they discard are removed. False:
  /// there is no room for the rest of the command; its messages are dropped and counted. [any]
  /// `urgent_pushed`: push_urgent() has them already.
  bool push(Command command, bool urgent_pushed = false);
  /// An urgent request that was recognized before the rest of its packet was decoded. [any]
  void push_urgent(UrgentRequest request);
  /// Swaps the waiting commands into `out` (cleared first, its memory reused). [sim]
  void drain(std::vector<Command>& out) { waiting_.drain(out); }
  /// The urgent requests in order of arrival; several of one kind and origin are one, at the place of the last. [sim]
  void drain_urgent(std::vector<UrgentRequest>& out);
  /// Whether an urgent request of that kind waits. [any]
  bool waits(UrgentKind kind);

  /// A number for what arrives now, larger than all before. [any]
  std::uint64_t arrive() { return arrivals_.fetch_add(1, std::memory_order_relaxed) + 1; }
  std::uint64_t dropped() const { return waiting_.dropped(); }
  /// Messages that an urgent request in the same command discarded since the last call. [any]
  std::uint64_t fetch_discarded() { return discarded_.exchange(0, std::memory_order_relaxed); }

 private:
  void move_urgent(Command& command, bool urgent_pushed);

  Inbox<Command> waiting_;
  std::mutex urgent_mutex_;
  std::vector<UrgentRequest> urgent_;
  std::atomic<std::size_t> urgent_count_{0};
  std::atomic<std::uint64_t> arrivals_{0};
  std::atomic<std::uint64_t> discarded_{0};
};

}  // namespace limber
