// Presets: the ordered list of presets of a session, and the commands on them: store, recall, morph, rename, delete.
// Presets survive resets; a PresetSaver writes them to the disk. [sim]
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "engine/commands/outcome.h"
#include "engine/edits/overrides.h"
#include "engine/presets/capturer.h"
#include "engine/presets/file.h"
#include "engine/presets/morph.h"
#include "sim/world/world.h"

namespace limber::engine {

class Presets {
 public:
  static constexpr std::size_t kMax = 10000;
  static constexpr double kMaxMorphSeconds = 86400;  ///< Longest duration of a morph, s.

  /// `overrides`: records recalls.
  explicit Presets(Overrides& overrides) : overrides_(overrides) {}

  /// The presets of a scene, and the writer of their file.
  struct Bank {
    PresetList list;
    std::unique_ptr<PresetSaver> saver;
    std::string file;  ///< Canonical path of the file.
  };
  /// Loads the presets of a file (none if the path is empty); logs problems. `writer` must outlive the bank.
  /// `on_failure` is called with the reason when a save fails. May wait for the disk. [any]
  static Bank read(BackgroundWriter& writer, const std::string& path, PresetFile::WriteAccess access,
                   std::function<void(const std::string&)> on_failure);
  /// Replaces the bank, unless the same file is open already. Returns the bank that isn't used, which must be destroyed
  /// on a thread that may wait for the disk. [sim]
  Bank open(Bank bank);
  /// Replaces the bank in any case and returns the previous one. [sim]
  Bank exchange(Bank bank);
  /// Sets the preset "script": all values as the last successful run of the scene left them.
  void set_script_preset(std::shared_ptr<const Preset> script) { script_ = std::move(script); }
  /// Prepares for another store; ends running morphs.
  void forget_store();

  /// Canonical path of the preset file; empty: none.
  const std::string& file() const { return bank_.file; }

  /// Executes /preset/store, recall, morph, rename, delete or /list/presets, selected by the last word of the address.
  Outcome execute(std::string_view command, const Message& message, sim::World& world);
  /// Checks whether a message would succeed after the messages in `before`.
  Result<void> check(const Message& message, std::span<const Message> before) const;
  /// Recalls a preset by its number, from 1, over `seconds`; a fractional number is a blend of its two neighbors.
  Result<void> recall_number(sim::World& world, double number, double seconds);
  /// Stops running morphs at their current values.
  void stop() { morphs_.clear(); }
  /// Advances running morphs to the world's time.
  void advance(sim::World& world);
  /// Prepares for the next /preset/store in slices; call once per tick.
  void prepare(const sim::World& world) { capturer_.prepare(world.store()); }
  /// Completes that preparation at once, when no tick waits.
  void finish_planning(const sim::World& world) { capturer_.finish_planning(world.store()); }
  /// Applies recovered values like a recall; returns a description of values that were skipped.
  Result<std::string> restore(sim::World& world, const std::shared_ptr<const Preset>& values) {
    return apply(world, Blend::of(values), 0, Easing::linear);
  }
  /// Captures all properties.
  std::shared_ptr<const Preset> capture_all(const Store& store) { return *capturer_.capture(store, "everything", {}); }
  /// True if capture_all() costs no more than copying the values.
  bool ready(const Store& store) const { return capturer_.ready(store); }
  /// True if all stored presets are on the disk.
  bool saved() const { return bank_.saver == nullptr || bank_.saver->saved(); }
  /// Applies a recall again that was recorded as an override, after a reset.
  void reapply(sim::World& world, const Blend& blend);

  const PresetList& list() const { return bank_.list; }
  /// Names, one per line.
  std::string_view names() const { return names_; }
  /// Progress of the running morph that is least advanced, 0 to 1; 1 if none runs.
  double progress(const sim::World& world) const { return morphs_.progress(world.time()); }
  /// Waits until all presets are on the disk. [any but sim]
  void finish_saving() {
    if (bank_.saver != nullptr) bank_.saver->finish();
  }

  /// The part of the state that messages can change, for checkpoints.
  struct State {
    PresetList list;
    Morphs morphs;
  };
  void capture(State& state) const {
    state.list = bank_.list;
    state.morphs = morphs_;
  }
  void restore(const State& state);
  /// Replaces the list of presets.
  void set_list(PresetList list);
  /// While `on` (recorded inputs are replayed), nothing is saved to the disk.
  void suspend_saving(bool on) { saving_suspended_ = on; }

  /// Removes a property from running morphs, because a controller has set it.
  void release(NodeId id, const Property& property) { morphs_.release(id, property); }

 private:
  Outcome store(const Message& message, sim::World& world);
  Outcome recall(const Message& message, sim::World& world);
  Outcome morph(const Message& message, sim::World& world);
  Outcome erase(const Message& message);
  Outcome rename(const Message& message);
  Outcome list_names(const Message& message) const;

  const std::shared_ptr<const Preset>* find(std::string_view name) const;
  Result<std::shared_ptr<const Preset>> resolve(const Arg& arg) const;
  Result<Blend> blend_at(double number);
  Blend blend_of(const std::shared_ptr<const Preset>& a, const std::shared_ptr<const Preset>& b, double amount);
  Result<std::string> apply(sim::World& world, const Blend& blend, double seconds, Easing easing);
  Result<std::shared_ptr<const PresetBinding>> bind(const Store& store, const Blend& blend);
  Error not_found(std::string_view name) const;
  void update_names();
  void save();

  Overrides& overrides_;
  bool saving_suspended_ = false;
  Bank bank_;
  std::string names_;
  std::shared_ptr<const Preset> script_;
  PresetCapturer capturer_;
  Morphs morphs_;
  std::vector<std::shared_ptr<const PresetBinding>> bindings_;  // recently used
  struct Pair {
    std::shared_ptr<const Preset> a, b;
    Blend aligned;
  };
  std::vector<Pair> pairs_;  // recently blended
};

}  // namespace limber::engine
