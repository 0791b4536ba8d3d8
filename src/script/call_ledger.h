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
    count_ = rewound_at_ = 0;
    rewound_stops_ = 0;
    stopped_.clear();
    forbidden_ = std::move(forbidden);
    next_ = 0;
  }
  /// Whether the call that would be next must not be made.
  bool forbids_next() const { return next_ < forbidden_.size() && forbidden_[next_].number == count_ + 1; }
  /// A call begins.
  void count() { count_++; }
  /// The next call is not made; what was reported of it then. It counts as stopped: history does not make it either.
  const StoppedCall& skip() {
    count_++;
    return stopped_.emplace_back(forbidden_[next_++]);
  }
  /// The call that was counted last was stopped.
  void note_stop(std::string file, int line, std::string text) {
    stopped_.push_back({count_, std::move(file), line, std::move(text)});
  }

  /// Time has gone back in this tick: for history the tick begins here, for a take it does not.
  void note_rewind() {
    rewound_at_ = count_;
    rewound_stops_ = stopped_.size();
  }

  const std::vector<StoppedCall>& stopped() const { return stopped_; }
  /// Those since the last rewind, numbered from there.
  std::vector<StoppedCall> stopped_since_rewind() const {
    std::vector<StoppedCall> stops(stopped_.begin() + static_cast<std::ptrdiff_t>(rewound_stops_), stopped_.end());
    for (StoppedCall& stop : stops) stop.number -= rewound_at_;
    return stops;
  }
  /// Calls that were stopped, though they were not among those that must not be made.
  std::size_t unforeseen() const { return stopped_.size() - next_; }
  /// Calls that should have been stopped and did not come.
  std::size_t missed() const { return forbidden_.size() - next_; }

 private:
  std::uint64_t count_ = 0;
  std::uint64_t rewound_at_ = 0;
  std::size_t rewound_stops_ = 0;
  std::vector<StoppedCall> stopped_;
  std::vector<StoppedCall> forbidden_;
  std::size_t next_ = 0;
};

}  // namespace limber
