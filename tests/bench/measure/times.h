// Helpers to sample and round the measured times.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/system/clock.h"

namespace limber {

/// Rounds to this many decimals, the significant ones.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

/// Samples of one duration, seconds.
class TimeSamples {
 public:
  void add(double seconds) { samples_.push_back(seconds); }
  /// For repeated identical runs: keeps the minimum of the i-th sample over all runs.
  void add_min(std::size_t i, double seconds) {
    if (i == samples_.size()) {
      samples_.push_back(seconds);
    } else {
      samples_[i] = std::min(samples_[i], seconds);
    }
  }
  bool empty() const { return samples_.empty(); }
  std::size_t count() const { return samples_.size(); }
  /// Returns a quantile. 0: the minimum, 0.5: the median, 0.99: exceeded by one in a hundred.
  double quantile(double fraction) const {
    std::vector<double> sorted = samples_;
    const auto index = static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(index), sorted.end());
    return sorted[index];
  }
  /// {"min", "median", "p99"} in microseconds.
  nlohmann::ordered_json microseconds() const {
    return {{"min", in_microseconds(quantile(0))},
            {"median", in_microseconds(quantile(0.5))},
            {"p99", in_microseconds(quantile(0.99))}};
  }
  static double in_microseconds(double seconds) { return rounded(seconds * 1e6, 2); }

 private:
  std::vector<double> samples_;
};

}  // namespace limber
