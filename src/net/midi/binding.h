// Binding: one entry of the MIDI map in a running show: its property, the values that its control sends, and soft
// takeover. [one thread]
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/output/value_snapshot.h"
#include "net/midi/map.h"

namespace limber::midi {

/// The property of an entry in the tree of a snapshot.
struct BoundProperty {
  std::string path;  ///< Of the first property that the address matches.
  const Property* property =
      nullptr;  ///< Null: the address is not a property, for example one of the scene's handlers.
  ValueLocation location;
  std::size_t component = 0;
  double low = 0, high = 1;  ///< The ends of the control's range.
  std::string problem;       ///< Why the entry can't set it; empty: it can.

  bool is_action() const { return property != nullptr && property->kind == PropertyKind::action; }
  bool is_boolean() const { return property != nullptr && property->type == PropertyType::boolean; }
  /// True if the property accepts whole numbers only.
  bool is_whole() const;
};

/// Finds the property of an entry. Errors are in `problem`.
BoundProperty bind(const MidiEntry& entry, const TreeSnapshot& tree);
/// The mode of an entry that gives none.
ControlMode default_mode(const MidiEntry& entry, const BoundProperty& property);

class Binding {
 public:
  static constexpr double kPickupDistance = 0.012;  ///< Of positions that count as equal: more than one step of 127.

  explicit Binding(MidiEntry entry) : entry_(std::move(entry)) {}

  /// Sets the present values: finds the property again if the tree has changed.
  void update(const engine::ValueSnapshot& snapshot);
  /// Returns the message that a movement of the control sends, if any. `now`: ns.
  std::optional<Message> accept(const ControlEvent& event, std::int64_t now);
  /// The message of accept() was queued; the value snapshot with this request number contains its effect.
  void note_sent(std::uint64_t request) { sent_request_ = request; }

  const MidiEntry& entry() const { return entry_; }
  const BoundProperty& property() const { return property_; }
  ControlMode mode() const { return entry_.mode.value_or(default_mode(entry_, property_)); }
  /// True if a snapshot has been seen.
  bool ready() const { return tree_ != nullptr; }
  /// The present value, or the one that was sent last if no snapshot contains its effect yet.
  std::optional<double> present() const;
  /// True if a value was sent that no snapshot contains yet.
  bool has_pending_value() const { return sent_ && snapshot_request_ < sent_request_; }
  /// Position of a value within the range, 0 .. 1.
  double position_of(double value) const;
  /// The position of the present value as a value of the control, 0 .. max_value(); nothing if it is unknown.
  std::optional<int> control_value() const;
  /// True if the control's position must pass the value before it changes it.
  bool awaits_pickup() const { return awaits_pickup_; }
  /// Time of its last movement, ns.
  std::int64_t moved_at() const { return moved_at_; }
  int last_channel() const { return last_channel_; }
  /// True while a button is held.
  bool is_pressed() const { return pressed_; }

 private:
  std::optional<Message> absolute(double position);
  std::optional<Message> relative(int value);
  std::optional<Message> press(bool pressed);
  bool picks_up(double position) const;
  std::optional<Message> send_value(double value);

  MidiEntry entry_;
  std::shared_ptr<const TreeSnapshot> tree_;
  BoundProperty property_;
  std::optional<double> snapshot_value_;
  std::array<double, 4> components_{};  // all numbers of a vector
  std::uint64_t snapshot_request_ = 0;

  std::optional<double> sent_;  // the last value that was sent
  std::uint64_t sent_request_ = 0;
  std::optional<double> control_;
  bool awaits_pickup_ = false;
  bool pressed_ = false;  // of a button
  bool flipped_ = false;  // state of a toggle whose address is not a property
  std::int64_t moved_at_ = 0;
  int last_channel_ = 0;
};

}  // namespace limber::midi
