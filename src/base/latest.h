// Latest: one writer publishes finished values, readers hold what they read as long as they like.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace limber {

template <class T>
class Latest {
 public:
  /// The newest value, or null before the first. Shared and never changed again. [any]
  std::shared_ptr<const T> read() const {
    const std::scoped_lock lock(mutex_);
    return newest_;
  }

  /// A value to fill: one that nobody reads any more, else a new one. Holds old content. [the writer]
  std::shared_ptr<T> spare() {
    for (const std::shared_ptr<T>& value : pool_) {
      std::shared_ptr<T> mine = value;
      if (mine.use_count() != 2) continue;
      // a look at the count orders nothing; one more change of it does: it comes after the last reader's release
      const std::shared_ptr<T> acquired = mine;
      return mine;
    }
    pool_.push_back(std::make_shared<T>());
    return pool_.back();
  }

  /// [the writer]
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
