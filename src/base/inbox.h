// Inbox: many writers, one reader, bounded. What does not fit is counted. The lock is held for a push or a swap only.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace limber {

template <class T>
class Inbox {
 public:
  explicit Inbox(std::size_t capacity) : capacity_(capacity) {}

  /// False when it is full: the item is dropped and counted. [any]
  bool push(T item) {
    const std::scoped_lock lock(mutex_);
    if (items_.size() >= capacity_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_.push_back(std::move(item));
    return true;
  }

  /// Swaps what has come into `out` (cleared first, its memory reused). [the reader]
  void drain(std::vector<T>& out) {
    out.clear();
    const std::scoped_lock lock(mutex_);
    items_.swap(out);
  }

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::mutex mutex_;
  std::vector<T> items_;
  std::size_t capacity_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace limber
