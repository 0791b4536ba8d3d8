// Time and memory as the bench takes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/system/clock.h"

namespace limber {

/// A figure with so many decimals, as many as it deserves.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

/// Samples of one thing, seconds.
class Samples {
 public:
  void add(double seconds) { all_.push_back(seconds); }
  /// What was taken again and again: its i-th sample is the least that was told of it.
  void add_least(std::size_t i, double seconds) {
    if (i == all_.size()) {
      all_.push_back(seconds);
    } else {
      all_[i] = std::min(all_[i], seconds);
    }
  }
  bool empty() const { return all_.empty(); }
  std::size_t count() const { return all_.size(); }
  /// 0: the least, 0.5: the median, 0.99: what one in a hundred exceeds.
  double at(double part) const {
    std::vector<double> sorted = all_;
    const auto index = static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(index), sorted.end());
    return sorted[index];
  }
  /// {"min", "median", "p99"} in microseconds.
  nlohmann::ordered_json microseconds() const {
    return {{"min", in_microseconds(at(0))}, {"median", in_microseconds(at(0.5))}, {"p99", in_microseconds(at(0.99))}};
  }
  static double in_microseconds(double seconds) { return rounded(seconds * 1e6, 2); }

 private:
  std::vector<double> all_;
};

}  // namespace limber
