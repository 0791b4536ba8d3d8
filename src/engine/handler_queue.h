// HandlerQueue: messages of this tick and of earlier ones that the scene's handlers (osc:on) have not heard yet.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>

#include "base/message.h"

namespace limber {

/// Bounded: a message that finds no room is not heard. The bound depends on what was pushed alone, so that a replay
/// drops the same messages. [sim]
class HandlerQueue {
 public:
  static constexpr std::size_t kMost = 16384;
  static constexpr std::size_t kMostBytes = std::size_t{16} << 20;

  struct Entry {
    Message message;
    Origin origin;
    bool unknown = false;  ///< No address of ours: refused with `error` where no handler hears it.
    std::string error;
  };

  /// False: there is no room. `bounded`: false for takes of before there was a bound.
  bool push(Entry entry, bool bounded = true) {
    const std::size_t bytes = size_of(entry);
    if (bounded && (entries_.size() >= kMost || bytes_ + bytes > kMostBytes)) return false;
    bytes_ += bytes;
    entries_.push_back(std::move(entry));
    return true;
  }
  /// The oldest one. Not while it is empty.
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

}  // namespace limber
