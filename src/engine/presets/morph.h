// Morph: interpolates values from their current state to a preset over time, at each tick. A property that is set by a
// controller meanwhile leaves the morph. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/presets/binding.h"
#include "engine/presets/preset.h"

namespace limber::engine {

/// Easing curve: constant speed; slow at both ends; slow at the start; slow at the end.
enum class Easing : std::uint8_t { linear, smooth, in, out };
std::optional<Easing> easing_of(std::string_view name);
/// Returns "linear, smooth, in, out".
std::string_view easing_names();
/// The same as a list, in the order of Easing. [any]
std::vector<std::string> easings();
/// Returns the eased fraction, 0 to 1, for a fraction of the time, 0 to 1.
double ease(Easing easing, double fraction);

class Morph {
 public:
  /// Starts from the current values at simulated time `time`, s. Includes only properties that differ from the preset,
  /// and those of all members of a behavior group that changes, because writes to a group are forwarded to its members.
  Morph(const Store& store, const PresetBinding& binding, Blend goal, double time, double seconds, Easing easing);

  /// Writes the values for simulated time `time`. False at the end, where every value equals the preset's bit by bit.
  /// Doesn't allocate unless nodes were added or removed.
  bool advance(Store& store, double time);
  /// Reports the properties of this morph to the listener of the store, which then releases them from older morphs.
  /// Call before this morph is added to them.
  void announce(Store& store) const;
  /// Removes a property from the morph, because something else has set it.
  void release(NodeId id, const Property& property);
  /// Returns the elapsed fraction of the time, 0 to 1.
  double progress(double time) const;
  /// True if any property is left in the morph.
  bool active() const { return active_tracks_ > 0; }

 private:
  struct Track {
    const Property* property = nullptr;
    std::uint32_t offset = 0;  // offset in values_ of its start values, followed by its end values
    bool missing = false;      // its node or property doesn't exist at present
    bool released = false;
  };
  struct Target {
    NodeId id;                       // null: the node doesn't exist at present
    std::uint32_t node = 0;          // index of the node in the preset
    std::uint32_t tracks_begin = 0;  // range of its tracks
    std::uint32_t tracks_end = 0;
  };
  void index_targets(const Store& store);
  std::uint64_t write_track(Store& store, NodeId id, const Track& track, double amount) const;
  void rebind(const Store& store);
  bool rebind(const Store& store, const PresetBinding::LayoutBinding& layout, NodeId id, Track& track);
  bool validate_track(const Store& store, NodeId id, const Track& track);

  Blend goal_;
  std::vector<std::string> except_;
  double begin_ = 0;
  double seconds_ = 0;
  Easing easing_ = Easing::smooth;
  std::uint64_t structure_version_ = 0;
  std::vector<Target> targets_;
  std::vector<Track> tracks_;
  std::vector<double> values_;
  std::vector<std::uint32_t> target_of_slot_;  // by slot of the store; number of targets: none
  std::size_t active_tracks_ = 0;
};

/// The running morphs.
class Morphs {
 public:
  static constexpr std::size_t kMax = 64;

  bool full() const { return morphs_.size() >= kMax; }
  bool empty() const { return morphs_.empty(); }
  void begin(Morph morph) { morphs_.push_back(std::move(morph)); }
  /// Advances all morphs to simulated time `time` and removes those that have ended.
  void advance(Store& store, double time);
  /// Removes a property from all morphs, because something else has set it.
  void release(NodeId id, const Property& property);
  /// Removes all properties of the binding from the morphs.
  void release(const PresetBinding& binding);
  void clear() { morphs_.clear(); }
  /// Returns the progress of the morph that is least advanced, 0 to 1; 1 if none runs.
  double progress(double time) const;

 private:
  std::vector<Morph> morphs_;
};

}  // namespace limber::engine
