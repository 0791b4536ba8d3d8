// Samples: the samples of a graph, one per tick. After a rewind, later samples are discarded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "ui/panel/pending_values.h"

namespace limber::panel {

class Samples {
 public:
  /// `max_size`: maximum number of samples; the oldest is removed if there are more.
  explicit Samples(std::size_t max_size) : max_size_(max_size) {}

  /// Adds a sample after removing those of this and later ticks.
  void add(std::uint64_t tick, const PendingValues::Values& values) {
    while (!samples_.empty() && samples_.back().tick >= tick) samples_.pop_back();
    samples_.push_back({tick, values});
    if (samples_.size() > max_size_) samples_.pop_front();
  }
  bool empty() const { return samples_.empty(); }
  std::size_t size() const { return samples_.size(); }
  const PendingValues::Values& operator[](std::size_t i) const { return samples_[i].values; }

 private:
  struct Sample {
    std::uint64_t tick = 0;
    PendingValues::Values values{};
  };
  std::deque<Sample> samples_;
  std::size_t max_size_;
};

}  // namespace limber::panel
