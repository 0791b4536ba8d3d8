// MidiStatus: devices, entries and the last event of MIDI, for display. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace limber::engine {

/// A device with its state.
struct MidiDeviceRow {
  std::string name;
  bool present = false;  ///< False: it is unplugged.
  bool input = false;    ///< Its input is open.
  bool output = false;   ///< Its output is open.
  bool operator==(const MidiDeviceRow&) const = default;
};

/// An entry of the map.
struct MidiEntryRow {
  std::string control;  ///< "cc 7, channel 1, nanoKONTROL2"
  std::string address;
  std::string state;     ///< "follows", "move it past 0.5", or the problem.
  bool problem = false;  ///< `state` is an error.
  bool operator==(const MidiEntryRow&) const = default;
};

struct MidiReport {
  bool on = false;      ///< Devices are used; false: there is neither an option nor a map.
  std::string problem;  ///< Why there are no devices; empty: none.
  std::vector<MidiDeviceRow> devices;
  std::vector<MidiEntryRow> entries;
  std::string file;        ///< Of the map.
  std::string file_error;  ///< Its error; the earlier map stays.
  std::string learning;    ///< The address whose control is awaited; empty: none.
  std::string last_event;  ///< "cc 7 = 64, channel 1, nanoKONTROL2"
  bool operator==(const MidiReport&) const = default;
};

class MidiStatus {
 public:
  /// False if the program has no MIDI.
  bool available() const { return available_.load(); }
  void set_available(bool available) { available_.store(available); }
  void set(MidiReport report) {
    const std::scoped_lock lock(mutex_);
    if (report == report_) return;
    report_ = std::move(report);
    version_.fetch_add(1);
  }
  MidiReport report() const {
    const std::scoped_lock lock(mutex_);
    return report_;
  }
  /// Increases with each change of the report.
  std::uint64_t version() const { return version_.load(); }

 private:
  std::atomic<bool> available_{false};
  std::atomic<std::uint64_t> version_{0};
  mutable std::mutex mutex_;
  MidiReport report_;
};

}  // namespace limber::engine
