// OscStatus: the targets of OSC output, for display. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace limber::engine {

class OscStatus {
 public:
  /// Sets the targets: one per line, host and port, then the settings in parentheses.
  void set_targets(std::string targets) {
    const std::scoped_lock lock(mutex_);
    if (targets == targets_) return;
    targets_ = std::move(targets);
    version_.fetch_add(1);
  }
  std::string targets() const {
    const std::scoped_lock lock(mutex_);
    return targets_;
  }
  /// Increases with each change.
  std::uint64_t version() const { return version_.load(); }

 private:
  std::atomic<std::uint64_t> version_{0};
  mutable std::mutex mutex_;
  std::string targets_;
};

}  // namespace limber::engine
