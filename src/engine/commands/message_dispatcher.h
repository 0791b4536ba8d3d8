// MessageDispatcher: executes messages. Legacy addresses of ofxDabPhysics and paths are resolved to the same properties
// and set by the same setter. All addresses are derived from the property tables, except a few special addresses. A
// rejected message changes nothing. [sim]
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/message.h"
#include "engine/commands/coerce.h"
#include "engine/commands/mouse_springs.h"
#include "engine/commands/outcome.h"
#include "engine/commands/query_handler.h"
#include "engine/commands/selector.h"
#include "engine/commands/special_addresses.h"
#include "engine/cues/cue_player.h"
#include "engine/output/health.h"
#include "engine/presets/presets.h"
#include "properties/catalog.h"
#include "sim/world/world.h"

namespace limber::engine {

class MessageDispatcher {
 public:
  /// Work budget of all address patterns of a pass; see PatternBudget.
  static constexpr int kPassWork = 4 * PatternBudget::kStepsPerMessage;

  /// If `presets` is null, preset messages are rejected. `extra_classes`: more classes, with their objects in a group
  /// of that name in each body; their legacy addresses take precedence over those of the built-in classes.
  explicit MessageDispatcher(sim::World& world, Presets* presets = nullptr,
                             std::span<const PropertyTable* const> extra_classes = {});

  /// Sets the source of /list/health, which is empty without it.
  void set_health(const Health& health) { health_ = &health; }
  /// Sets the source of /list/cues, which is empty without it.
  void set_cues(const CuePlayer& cues) { cues_ = &cues; }

  /// Executes a message. Its effect on values is immediate.
  Outcome execute(const Message& message);
  /// Refills the work budgets of patterns and of "did you mean" hints. Call it once per pass.
  void begin_pass() {
    hints_.remaining = HintBudget::kPerPass;
    pass_budget_.remaining = kPassWork;
  }
  /// Applies the forces of the mouse springs. Call it before each step.
  void apply_mouse_springs() { mouse_springs_.apply_forces(world_); }
  /// Removes all mouse springs.
  void release_mouse_springs() { mouse_springs_.clear(); }
  /// The mouse springs, for checkpoints.
  MouseSprings& mouse_springs() { return mouse_springs_; }
  /// A value that is set by a message.
  struct Write {
    PropertyRef ref;
    PropertyValues values;
  };
  /// The values that the last message set.
  std::span<const Write> writes() const { return writes_; }

  /// Returns the legacy address of a property, such as "/physics/part/mass"; empty if the class has none or the
  /// property is read-only.
  static std::string legacy_address(const PropertyTable& table, const Property& property);
  /// The special addresses.
  static std::span<const SpecialAddress> special_addresses();

 private:
  /// A legacy or special address, with objects named by arguments.
  struct AddressEntry {
    const PropertyTable* table = nullptr;
    const Property* property = nullptr;
    Outcome (MessageDispatcher::*handler)(const Message&) = nullptr;
  };
  struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const { return std::hash<std::string_view>{}(text); }
  };
  template <class T>
  using StringMap = std::unordered_map<std::string, T, TextHash, std::equal_to<>>;

  void add_class(const PropertyTable& table);
  Outcome execute_one(const Message& message);
  /// Returns the object of a singleton class such as World; null for other classes.
  NodeId singleton(const PropertyTable& table) const;
  Outcome execute_named(const AddressEntry& entry, const Message& message);
  Outcome execute_path(const Message& message);
  Outcome execute_pattern(const Message& message);
  Outcome unknown_path(std::string_view address, const std::string& error);
  /// Sets all properties in `refs_` to the value. If `single` is false, objects that don't accept the value are
  /// skipped; the message is rejected if no object accepts it.
  Outcome apply(bool single, std::span<const Arg> value);
  Outcome collect_writes(bool single, std::span<const Arg> value);
  /// Sets the values in `writes_`.
  Outcome write_all();
  /// Executes all actions in `refs_`.
  Outcome execute_action(std::span<const Arg> value);
  Outcome part_force(const Message& message);
  Outcome part_hold(const Message& message);
  Outcome part_release(const Message& message);
  Outcome projection(const Message& message);
  Outcome behavior_parameter(const Message& message);
  Outcome answer_list(const Message& message);
  Outcome request_scene(const Message& message);
  Outcome answer_health(const Message& message);
  Outcome answer_cues(const Message& message);
  Outcome request_cue(const Message& message);
  Outcome request_cue_edit(const Message& message);
  Outcome answer_get(const Message& message);
  Outcome reject_unsupported(const Message& message);
  Outcome execute_preset(const Message& message);
  Outcome execute_route(const Message& message);
  Outcome request_take(const Message& message);
  Outcome request_service(const Message& message);

  sim::World& world_;
  Presets* presets_;
  const Health* health_ = nullptr;
  const CuePlayer* cues_ = nullptr;
  Store& store_;
  HintBudget hints_;
  PatternBudget pass_budget_{kPassWork};  // of this pass
  PatternBudget message_budget_;          // of this message
  Selector selector_{world_, hints_, message_budget_};
  QueryHandler query_handler_{world_, hints_, message_budget_};
  StringMap<AddressEntry> entries_;     // by normalized_address()
  std::vector<std::string> addresses_;  // keys of entries_, for "did you mean"
  StringMap<PropertyRef> paths_;        // cache of exact paths, cleared when the tree changes
  std::uint64_t paths_version_ = 0;     // structure version of paths_
  MouseSprings mouse_springs_;
  std::vector<PropertyRef> refs_;  // scratch: the properties that the message addresses
  std::vector<Write> writes_;      // the validated values of the message
};

}  // namespace limber::engine
