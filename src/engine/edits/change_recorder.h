// ChangeRecorder: collects the changes of controllers in a tick and writes them to the change log. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/message.h"
#include "engine/edits/change_log.h"
#include "properties/store.h"

namespace limber::engine {

class ChangeRecorder {
 public:
  static constexpr std::size_t kMaxPerTick = 64;  ///< Values logged per tick; of the others only the number is logged.
  static constexpr double kMergeSeconds = 0.5;    ///< s, within which changes of a value by one source are merged.

  explicit ChangeRecorder(ChangeLog& log) : log_(log) {}

  /// Attributes the following writes to this controller, at this time (system::clock_seconds()).
  void begin(const CommandOrigin& source, double time);
  /// Records a write. `old_values`: the previous value. Does not allocate.
  void on_write(NodeId id, const Property& property, const double* old_values);
  /// Writes the changes of the tick to the log, with the current values.
  void flush(const Store& store);

 private:
  struct Note {
    CommandOrigin source;
    NodeId id;
    const Property* property = nullptr;
    std::array<double, 4> old_value{};
    std::uint64_t entry_number = 0;  // number of its line in the log; 0: none
    double time = 0;
    bool touched = false;  // written in this tick
  };
  void flush(const Store& store, Note& note);

  ChangeLog& log_;
  CommandOrigin source_;
  double time_ = 0;
  std::array<Note, 256> notes_{};      // direct-mapped cache, by a hash of source, node and property
  std::vector<std::uint8_t> touched_;  // indices of the notes written in this tick
  std::size_t omitted_ = 0;            // number of writes that are not noted
};

}  // namespace limber::engine
