// Latest: publishes the newest value from one writer to many readers, which can keep a value as long as they need it.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace limber {

template <class T>
class Latest {
 public:
  /// Returns the newest value, or null before the first. It is shared and never modified while a reader has it. [any]
  std::shared_ptr<const T> read() const {
    const std::scoped_lock lock(mutex_);
    return newest_;
  }

  /// Returns a value to fill and publish: one without readers, with its old contents, or a new one. [writer]
  std::shared_ptr<T> acquire_buffer() {
    for (const std::shared_ptr<T>& value : pool_) {
      std::shared_ptr<T> buffer = value;
      if (buffer.use_count() != 2) continue;
      // use_count() is relaxed. Another increment synchronizes with the last reader's decrement.
      const std::shared_ptr<T> acquired = buffer;
      return buffer;
    }
    pool_.push_back(std::make_shared<T>());
    return pool_.back();
  }

  /// Makes the value the newest one. [writer]
  void publish(std::shared_ptr<T> value) {
    std::shared_ptr<const T> finished = std::move(value);
    const std::scoped_lock lock(mutex_);
    newest_.swap(finished);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const T> newest_;
  std::vector<std::shared_ptr<T>> pool_;
};

}  // namespace limber
