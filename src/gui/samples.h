// Samples of a graph, each of a tick. Time may go back: what was sampled from there on has not been, then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "gui/hand_values.h"

namespace limber {

class Samples {
 public:
  /// `most`: the oldest goes when there are more.
  explicit Samples(std::size_t most) : most_(most) {}

  /// Those of that tick and of later ones go.
  void add(std::uint64_t tick, const HandValues::Values& values) {
    while (!samples_.empty() && samples_.back().tick >= tick) samples_.pop_back();
    samples_.push_back({tick, values});
    if (samples_.size() > most_) samples_.pop_front();
  }
  bool empty() const { return samples_.empty(); }
  std::size_t size() const { return samples_.size(); }
  const HandValues::Values& operator[](std::size_t i) const { return samples_[i].values; }

 private:
  struct Sample {
    std::uint64_t tick = 0;
    HandValues::Values values{};
  };
  std::deque<Sample> samples_;
  std::size_t most_;
};

}  // namespace limber
