// RunOutput: the numbers that a scene declares as output of its run: results, which are computed at the end, and the
// columns of sim:record, which are sampled while it plays. Plain data. [sim]
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace limber::script {

/// A result (`result("distance", function … end)`).
struct SceneResult {
  std::string name;
  double min = -std::numeric_limits<double>::infinity();  ///< Range, for searches that divide it into cells.
  double max = std::numeric_limits<double>::infinity();
  int cells = 0;  ///< Number of cells of the range; 0: the result has no range.
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string error = {};  ///< Why there is no value.
};

/// The columns of `sim:record { … }`, and the rows that were sampled and not consumed yet.
class RecordedRows {
 public:
  /// A row begins with the tick and the simulated time.
  static constexpr std::size_t kFixedColumns = 2;

  void declare(std::vector<std::string> columns) { columns_ = std::move(columns); }
  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t width() const { return columns_.size() + kFixedColumns; }
  /// Starts to store rows. Reserves the memory, so that a tick allocates nothing. Idempotent.
  void enable() {
    if (enabled_ || columns_.empty()) return;
    enabled_ = true;
    numbers_.reserve(kCapacity / width() * width());
  }
  /// While `on`, a rewind simulates recorded passes again: rows are not stored a second time.
  void set_muted(bool on) { muted_ = on; }
  /// Stores a row; drops and counts it if the buffer is full.
  void add(std::uint64_t tick, double time, const double* values) {
    if (!enabled_ || muted_) return;
    if (numbers_.size() + width() > numbers_.capacity()) {
      dropped_++;
      return;
    }
    numbers_.push_back(static_cast<double>(tick));
    numbers_.push_back(time);
    numbers_.insert(numbers_.end(), values, values + columns_.size());
  }
  /// The stored rows, one after the other.
  std::span<const double> rows() const { return numbers_; }
  void clear_rows() { numbers_.clear(); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  static constexpr std::size_t kCapacity = std::size_t{1} << 16;  // numbers

  std::vector<std::string> columns_;
  std::vector<double> numbers_;
  std::uint64_t dropped_ = 0;
  bool enabled_ = false;
  bool muted_ = false;
};

struct RunOutput {
  std::vector<SceneResult> results;
  RecordedRows rows;
};

}  // namespace limber::script
