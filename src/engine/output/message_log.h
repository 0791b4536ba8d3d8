// MessageLog: recently received and sent messages, logged only while there is a watcher. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"

namespace limber::engine {

struct LoggedMessage {
  std::uint64_t number = 0;  ///< Counts from 1; there are gaps if entries were dropped.
  double time = 0;           ///< system::clock_seconds().
  bool incoming = false;
  std::string peer;  ///< Sender of a received message, receiver of a sent one.
  Message message;
};

class MessageLog {
 public:
  static constexpr std::size_t kMaxEntries = 8192;
  static constexpr std::size_t kMaxBytes = std::size_t{4} << 20;

  /// Enables the log during its lifetime.
  class Watch {
   public:
    explicit Watch(MessageLog& log) : log_(log) { log_.watchers_.fetch_add(1); }
    ~Watch() { log_.watchers_.fetch_sub(1); }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    MessageLog& log_;
  };

  /// True if the log is enabled. Check it before an entry is composed.
  bool enabled() const { return watchers_.load(std::memory_order_relaxed) > 0; }
  /// Adds an entry; drops the oldest ones if there are too many.
  void add(bool incoming, std::string peer, const Message& message);
  /// Returns the entries after that number, oldest first.
  std::vector<LoggedMessage> since(std::uint64_t number) const;
  std::uint64_t newest() const;

 private:
  std::atomic<int> watchers_{0};
  mutable std::mutex mutex_;
  std::deque<LoggedMessage> entries_;
  std::size_t bytes_ = 0;
  std::uint64_t newest_ = 0;
};

/// Returns a readable text such as "/physics/part/mass arm 0.3". Shows at most 16 arguments and shortens long ones.
std::string message_text(const Message& message);

}  // namespace limber::engine
