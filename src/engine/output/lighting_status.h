// LightingStatus: the state of the lighting output, for display. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

namespace limber::engine {

class LightingStatus {
 public:
  enum class State : std::uint8_t {
    no_output,  ///< The program has no lighting output.
    off,        ///< Not armed.
    blocked,    ///< Armed, but values that a replay, --fast or an earlier moment has armed are not sent.
    sending,
  };
  void set(State state) { state_.store(state); }
  State state() const { return state_.load(); }
  /// Number of packets sent.
  std::atomic<std::uint64_t> packets{0};

  /// The targets, such as "Art-Net 10.0.0.5", or the last error.
  void set_text(std::string text) {
    const std::scoped_lock lock(mutex_);
    text_ = std::move(text);
  }
  std::string text() const {
    const std::scoped_lock lock(mutex_);
    return text_;
  }

 private:
  std::atomic<State> state_{State::no_output};
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace limber::engine
