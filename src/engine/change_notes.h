// ChangeNotes: what hands set in this tick, on its way to the log. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/message.h"
#include "engine/change_log.h"
#include "params/store.h"

namespace limber {

class ChangeNotes {
 public:
  static constexpr std::size_t kMostATick = 64;  ///< Values; of the others the log has only how many they were.
  static constexpr double kGesture = 0.5;        ///< s: who sets a value again within it goes on.

  explicit ChangeNotes(ChangeLog& log) : log_(log) {}

  /// What is set from here on is set by this hand, at that time (system::clock_seconds()).
  void begin(const Origin& who, double time);
  /// The row was `before`, and is written. Allocates nothing.
  void heard(NodeId id, const Row& row, const double* before);
  /// The tick's values are what they are: the log is told.
  void tell(const Store& store);

 private:
  struct Note {
    Origin who;
    NodeId id;
    const Row* row = nullptr;
    std::array<double, 4> from{};
    std::uint64_t line = 0;  // in the log; 0: not yet
    double time = 0;
    bool touched = false;  // in this tick
  };
  void tell(const Store& store, Note& note);

  ChangeLog& log_;
  Origin who_;
  double time_ = 0;
  std::array<Note, 256> notes_{};  // lately; each has one place that it may be at
  std::vector<std::uint8_t> touched_;
  std::size_t more_ = 0;
};

}  // namespace limber
