// CallLedger: the guarded calls of scripts between two ticks, by number, and which of them were stopped. What stops a
// call (computing time, memory) is not the same in every run, so a take keeps the numbers, and a replay stops the same
// ones. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limber {

struct StoppedCall {
  std::uint64_t number = 0;  ///< From 1.
  std::string file;
  int line = 0;
  std::string text;
};

class CallLedger {
 public:
  /// A tick begins; these are the calls that it must not make.
  void begin_tick(std::vector<StoppedCall> forbidden = {}) {
    count_ = 0;
    stopped_.clear();
    forbidden_ = std::move(forbidden);
    next_ = 0;
  }
  /// Whether the call that would be next must not be made.
  bool forbids_next() const { return next_ < forbidden_.size() && forbidden_[next_].number == count_ + 1; }
  /// A call begins.
  void count() { count_++; }
  /// The next call is not made; what was said of it then.
  const StoppedCall& skip() {
    count_++;
    return forbidden_[next_++];
  }
  /// The call that was counted last was stopped.
  void note_stop(std::string file, int line, std::string text) {
    stopped_.push_back({count_, std::move(file), line, std::move(text)});
  }

  const std::vector<StoppedCall>& stopped() const { return stopped_; }
  /// Calls that should have been stopped and did not come.
  std::size_t missed() const { return forbidden_.size() - next_; }

 private:
  std::uint64_t count_ = 0;
  std::vector<StoppedCall> stopped_;
  std::vector<StoppedCall> forbidden_;
  std::size_t next_ = 0;
};

}  // namespace limber
