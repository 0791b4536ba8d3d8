// HandlerQueue: messages that wait for the scene's handlers (osc:on), of this tick and of earlier ones.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>

#include "base/message.h"

namespace limber::engine {

/// A bounded FIFO. A message that does not fit is dropped. The limits depend only on the pushed messages, so a replay
/// drops the same ones. [sim]
class HandlerQueue {
 public:
  static constexpr std::size_t kMaxEntries = 16384;
  static constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

  struct Entry {
    Message message;
    CommandOrigin origin;
    bool unknown = false;  ///< Not an address of Limber: rejected with `error` if no handler handles it.
    std::string error;
  };

  /// Returns false if the queue is full. `bounded`: false for replays of takes older than the limits.
  bool push(Entry entry, bool bounded = true) {
    const std::size_t bytes = size_of(entry);
    if (bounded && (entries_.size() >= kMaxEntries || bytes_ + bytes > kMaxBytes)) return false;
    bytes_ += bytes;
    entries_.push_back(std::move(entry));
    return true;
  }
  /// The oldest entry. Requires that the queue is not empty.
  const Entry& front() const { return entries_.front(); }
  Entry pop() {
    Entry entry = std::move(entries_.front());
    bytes_ -= size_of(entry);
    entries_.pop_front();
    return entry;
  }
  void clear() {
    entries_.clear();
    bytes_ = 0;
  }
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  std::size_t bytes() const { return bytes_; }

 private:
  static std::size_t size_of(const Entry& entry) {
    std::size_t bytes = sizeof entry + entry.message.address.size() + entry.error.size();
    for (const Arg& arg : entry.message.args) bytes += sizeof arg + arg.text.size();
    return bytes;
  }

  std::deque<Entry> entries_;
  std::size_t bytes_ = 0;
};

}  // namespace limber::engine
