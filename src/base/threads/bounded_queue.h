// BoundedQueue: a queue with many writers and one reader, limited in items and bytes. Items that exceed the limits are
// dropped and counted. The lock is held for a push or a swap only.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace limber {

/// The size of an item in bytes is weight_of(const T&) if that function exists, else sizeof(T).
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity, std::size_t bytes = SIZE_MAX) : capacity_(capacity), max_bytes_(bytes) {}

  /// Adds the item. If the queue is full, drops and counts it and returns false. [any]
  bool push(T item) {
    const std::size_t size = item_bytes(item);
    const std::scoped_lock lock(mutex_);
    if (items_.size() >= capacity_ || size > max_bytes_ - bytes_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_.push_back(std::move(item));
    bytes_ += size;
    return true;
  }

  /// Moves all items to `out`, which is cleared first; its memory is reused. [the reader]
  void drain(std::vector<T>& out) {
    out.clear();
    const std::scoped_lock lock(mutex_);
    items_.swap(out);
    bytes_ = 0;
  }

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static std::size_t item_bytes(const T& item) {
    if constexpr (requires { weight_of(item); }) {
      return weight_of(item);
    } else {
      return sizeof item;
    }
  }

  std::mutex mutex_;
  std::vector<T> items_;
  std::size_t capacity_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace limber
