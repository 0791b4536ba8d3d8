// Traffic: the messages that came in and went out lately, kept only while somebody watches. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"

namespace limber {

struct TrafficLine {
  std::uint64_t number = 0;  ///< Counts from 1; some may have been forgotten in between.
  double time = 0;           ///< system::clock_seconds().
  bool in = false;
  std::string end;  ///< Who sent it, or whom it went to.
  Message message;
};

class Traffic {
 public:
  static constexpr std::size_t kMostLines = 8192;
  static constexpr std::size_t kMostBytes = std::size_t{4} << 20;

  /// While one lives, traffic is kept.
  class Watch {
   public:
    explicit Watch(Traffic& traffic) : traffic_(traffic) { traffic_.watchers_.fetch_add(1); }
    ~Watch() { traffic_.watchers_.fetch_sub(1); }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    Traffic& traffic_;
  };

  /// To be asked before a line is made: nobody watches, nothing is to be noted.
  bool watched() const { return watchers_.load(std::memory_order_relaxed) > 0; }
  /// The oldest lines go when there are too many.
  void note(bool in, std::string end, const Message& message);
  /// Those after that number, the oldest first.
  std::vector<TrafficLine> since(std::uint64_t number) const;
  std::uint64_t newest() const;

 private:
  std::atomic<int> watchers_{0};
  mutable std::mutex mutex_;
  std::deque<TrafficLine> lines_;
  std::size_t bytes_ = 0;
  std::uint64_t newest_ = 0;
};

/// "/physics/part/mass arm 0.3": for people. At most sixteen arguments are shown, and long ones shortened.
std::string message_text(const Message& message);

}  // namespace limber
