// Mapping: the MIDI map of the show with its file, what its entries do, and the entries that are learned. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/output/midi_status.h"
#include "net/midi/bindings.h"
#include "net/midi/feedback.h"
#include "net/midi/learner.h"
#include "net/midi/map_file.h"

namespace limber::midi {

class Mapping {
 public:
  /// True if devices are needed: there are entries, or a control is to be learned.
  bool needs_devices() const { return !map_.empty() || learner_.request(); }
  /// Reads the map of a scene from now on.
  void open(const std::string& scene);
  /// Reads the file again if it was saved. An error is logged, and the map stays.
  void poll_file(std::int64_t now);
  std::int64_t next_poll() const { return file_.next_poll(); }

  /// Begins to learn the control of an address: `address [component] [mode]`; without arguments: cancels. Returns the
  /// answer.
  Result<std::string> learn(const std::vector<Arg>& args);
  /// Removes the entries of an address, and saves the file. Returns the answer.
  Result<std::string> forget(const std::vector<Arg>& args);
  /// Returns the control that was learned, or why the file can't be saved.
  std::optional<Result<std::string>> finish_learning(std::int64_t now);

  /// Sets the present values.
  void update(const std::shared_ptr<const engine::ValueSnapshot>& snapshot);
  /// A control has moved.
  void accept(std::string_view port, const ControlEvent& event, std::int64_t now);
  /// Devices were plugged in or out: feedback is sent again.
  void reset_feedback() { feedback_.reset(); }
  /// Releases the buttons of a device that was unplugged.
  void release(std::string_view port, std::int64_t now) { bindings_.release(port, now); }
  /// Sends values to the devices.
  void send_feedback(const std::vector<std::string>& ports, std::int64_t now, const Feedback::Send& send) {
    feedback_.update(bindings_, ports, now, send);
  }
  Bindings& bindings() { return bindings_; }
  const Learner& learner() const { return learner_; }
  /// Fills the parts of the report about the map.
  void report(engine::MidiReport& report) const;

 private:
  void use(MidiMap map);
  Result<void> add(MidiEntry entry);
  void choose_range(MidiEntry& entry) const;

  MapFile file_;
  MidiMap map_;
  std::string file_error_;
  Bindings bindings_;
  Learner learner_;
  Feedback feedback_;
  std::shared_ptr<const engine::ValueSnapshot> snapshot_;
};

}  // namespace limber::midi
