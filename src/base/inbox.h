// Inbox: many writers, one reader, bounded in items and in bytes. What does not fit is counted. The lock is held for a
// push or a swap only.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace limber {

/// Where there is a function weight_of(const T&), it says an item's bytes; else an item weighs what its type does.
template <class T>
class Inbox {
 public:
  explicit Inbox(std::size_t capacity, std::size_t bytes = SIZE_MAX) : capacity_(capacity), most_bytes_(bytes) {}

  /// False when it is full: the item is dropped and counted. [any]
  bool push(T item) {
    const std::size_t weight = weigh(item);
    const std::scoped_lock lock(mutex_);
    if (items_.size() >= capacity_ || weight > most_bytes_ - bytes_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_.push_back(std::move(item));
    bytes_ += weight;
    return true;
  }

  /// Swaps what has come into `out` (cleared first, its memory reused). [the reader]
  void drain(std::vector<T>& out) {
    out.clear();
    const std::scoped_lock lock(mutex_);
    items_.swap(out);
    bytes_ = 0;
  }

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static std::size_t weigh(const T& item) {
    if constexpr (requires { weight_of(item); }) {
      return weight_of(item);
    } else {
      return sizeof item;
    }
  }

  std::mutex mutex_;
  std::vector<T> items_;
  std::size_t capacity_;
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace limber
