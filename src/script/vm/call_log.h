// CallLog: numbers the guarded script calls of a pass and records those that were stopped. Stops for CPU time or memory
// differ from run to run, so a take stores their numbers, and a replay skips the same calls. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limber::script {

struct StoppedCall {
  std::uint64_t number = 0;  ///< From 1.
  std::string file;
  int line = 0;
  std::string text;
};

class CallLog {
 public:
  /// Starts a pass; `skip_list`: the calls that it must skip.
  void begin_pass(std::vector<StoppedCall> skip_list = {}) {
    count_ = rewound_at_ = 0;
    rewound_stops_ = 0;
    stopped_.clear();
    skip_list_ = std::move(skip_list);
    next_skip_ = 0;
  }
  /// True if the next call must be skipped.
  bool skips_next() const { return next_skip_ < skip_list_.size() && skip_list_[next_skip_].number == count_ + 1; }
  /// Counts a call.
  void count_call() { count_++; }
  /// Skips the next call and returns its recorded stop. It counts as stopped, so that history skips it as well.
  const StoppedCall& skip() {
    count_++;
    return stopped_.emplace_back(skip_list_[next_skip_++]);
  }
  /// Records that the latest call was stopped.
  void record_stop(std::string file, int line, std::string text) {
    stopped_.push_back({count_, std::move(file), line, std::move(text)});
  }

  /// Records a rewind within the pass. The history numbers the pass's calls from its last rewind, a take from its
  /// start.
  void record_rewind() {
    rewound_at_ = count_;
    rewound_stops_ = stopped_.size();
  }

  const std::vector<StoppedCall>& stopped() const { return stopped_; }
  /// Returns the stops since the last rewind, numbered from there.
  std::vector<StoppedCall> stopped_since_rewind() const {
    std::vector<StoppedCall> stops(stopped_.begin() + static_cast<std::ptrdiff_t>(rewound_stops_), stopped_.end());
    for (StoppedCall& stop : stops) stop.number -= rewound_at_;
    return stops;
  }
  /// Number of stopped calls that were not on the skip list.
  std::size_t unexpected_stops() const { return stopped_.size() - next_skip_; }
  /// Number of calls on the skip list that did not occur.
  std::size_t missing_stops() const { return skip_list_.size() - next_skip_; }

 private:
  std::uint64_t count_ = 0;
  std::uint64_t rewound_at_ = 0;
  std::size_t rewound_stops_ = 0;
  std::vector<StoppedCall> stopped_;
  std::vector<StoppedCall> skip_list_;
  std::size_t next_skip_ = 0;
};

}  // namespace limber::script
