// CommandQueue: the bounded queue of commands to the simulation thread, with a separate queue for urgent requests,
// which are never dropped.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "base/threads/bounded_queue.h"
#include "engine/commands/urgent.h"

namespace limber::engine {

class CommandQueue {
 public:
  /// Maximum number of waiting urgent requests; beyond that an older one of the same kind is replaced.
  static constexpr std::size_t kMaxUrgent = 64;

  CommandQueue(std::size_t capacity, std::size_t bytes) : waiting_(capacity, bytes) {}

  /// Queues a command. Moves its urgent requests to their own queue and removes earlier messages of the command that
  /// they discard. Returns false if the queue is full; the remaining messages are then dropped and counted. [any]
  /// `urgent_pushed`: the urgent requests were already passed to push_urgent().
  bool push(Command command, bool urgent_pushed = false);
  /// Queues an urgent request, possibly before the rest of its packet is decoded. [any]
  void push_urgent(UrgentRequest request);
  /// Moves the waiting commands into `out`, which is cleared first; its memory is reused. [sim]
  void drain(std::vector<Command>& out) { waiting_.drain(out); }
  /// Moves the urgent requests into `out`, in order of arrival. Of several with the same kind and origin only the last
  /// remains. [sim]
  void drain_urgent(std::vector<UrgentRequest>& out);
  /// True if an urgent request of this kind is waiting. [any]
  bool has_urgent(UrgentKind kind);

  /// Returns the next arrival number, larger than all before. [any]
  std::uint64_t next_arrival() { return arrivals_.fetch_add(1, std::memory_order_relaxed) + 1; }
  std::uint64_t dropped() const { return waiting_.dropped(); }
  /// Returns the number of messages that urgent requests in the same command discarded since the last call. [any]
  std::uint64_t fetch_discarded() { return discarded_.exchange(0, std::memory_order_relaxed); }

 private:
  void move_urgent(Command& command, bool urgent_pushed);

  BoundedQueue<Command> waiting_;
  std::mutex urgent_mutex_;
  std::vector<UrgentRequest> urgent_;
  std::atomic<std::size_t> urgent_count_{0};
  std::atomic<std::uint64_t> arrivals_{0};
  std::atomic<std::uint64_t> discarded_{0};
};

}  // namespace limber::engine
