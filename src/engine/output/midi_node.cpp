// The readouts of /midi.
#include "engine/output/midi_node.h"

#include <fmt/format.h>

namespace limber::engine {

const PropertyTable& MidiNode::table() {
  using namespace properties;
  static const PropertyTable table(
      "midi", "/midi", "",
      {
          text_from<&MidiNode::read_devices>(
              text("devices", "MIDI devices, one per line: name and state, separated by a tab.")),
          text_from<&MidiNode::read_entries>(
              text("entries", "Entries of the MIDI map, one per line: address, control and state, separated by tabs.")),
          text_from<&MidiNode::read_learning>(
              text("learning", "Address that the next MIDI control that moves will set; empty: none.")),
          text_from<&MidiNode::read_last_event>(text("last_event", "The last movement of a MIDI control.")),
          text_from<&MidiNode::read_problem>(
              text("problem", "Why there are no MIDI devices, or the error of the map; empty: none.")),
      });
  return table;
}

MidiNode::MidiNode(Store& store, const MidiStatus& status) : status_(status) {
  store.add(table(), store.root(), "midi", this);
}

void MidiNode::update() const {
  const std::uint64_t version = status_.version();
  if (version == version_) return;
  version_ = version;
  const MidiReport report = status_.report();
  devices_.clear();
  for (const MidiDeviceRow& device : report.devices) {
    const char* const state = !device.present ? "unplugged" : device.output ? "in and out" : "in";
    devices_ += fmt::format("{}{}\t{}", devices_.empty() ? "" : "\n", device.name, state);
  }
  entries_.clear();
  for (const MidiEntryRow& entry : report.entries)
    entries_ += fmt::format("{}{}\t{}\t{}", entries_.empty() ? "" : "\n", entry.address, entry.control, entry.state);
  learning_ = report.learning;
  last_event_ = report.last_event;
  problem_ = report.file_error.empty() ? report.problem : report.file_error;
}

}  // namespace limber::engine
