// MidiNode: the node /midi, with the state of MIDI devices as texts. [sim]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/output/midi_status.h"
#include "properties/store.h"

namespace limber::engine {

class MidiNode {
 public:
  static const PropertyTable& table();

  MidiNode(Store& store, const MidiStatus& status);

 private:
  void update() const;
  std::string_view read_devices() const { return read(devices_); }
  std::string_view read_entries() const { return read(entries_); }
  std::string_view read_learning() const { return read(learning_); }
  std::string_view read_last_event() const { return read(last_event_); }
  std::string_view read_problem() const { return read(problem_); }
  std::string_view read(const std::string& text) const {
    update();
    return text;
  }

  const MidiStatus& status_;
  // texts of the report with this version, made when they are read: in value snapshots only
  mutable std::uint64_t version_ = 0;
  mutable std::string devices_, entries_, learning_, last_event_, problem_;
};

}  // namespace limber::engine
