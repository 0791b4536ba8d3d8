// Bindings: all entries of the MIDI map in a running show, and the messages that movements of controls send.
// [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "net/midi/binding.h"

namespace limber::midi {

class Bindings {
 public:
  static constexpr std::size_t kMaxPresses = 64;  ///< Messages of buttons in a batch; more are dropped.

  /// Replaces the map. Entries that stay keep the state of their control.
  void set_map(const MidiMap& map);
  /// Sets the present values.
  void update(const std::shared_ptr<const engine::ValueSnapshot>& snapshot);
  /// Adds the message of a movement to the batch. A later value of a control replaces an earlier one, so that a device
  /// can't flood the simulation. `now`: ns. Returns true if an entry is for this control.
  bool accept(std::string_view port, const ControlEvent& event, std::int64_t now);
  /// Releases the buttons of a device that was unplugged.
  void release(std::string_view port, std::int64_t now);
  /// Returns the messages of the batch, and begins a new one.
  std::vector<Message> drain();
  /// The messages of drain() were queued; `request`: see Binding::note_sent(); 0: they were lost.
  void note_sent(std::uint64_t request);

  const std::vector<Binding>& list() const { return bindings_; }
  bool empty() const { return bindings_.empty(); }

 private:
  struct Pending {
    std::size_t binding = 0;
    bool is_press = false;
    Message message;
  };
  void merge_components(std::size_t index, Message& message) const;
  void add(std::size_t index, Message message);

  std::vector<Binding> bindings_;
  std::shared_ptr<const engine::ValueSnapshot> snapshot_;
  std::vector<Pending> batch_;
  std::vector<std::size_t> sent_;  // indices of the bindings in the last batch
};

}  // namespace limber::midi
