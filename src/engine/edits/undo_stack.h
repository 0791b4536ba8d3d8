// UndoStack: undo and redo of the values that controllers (OSC, panel, console) set, as steps in one common stack.
// Values that callbacks and behaviors of the scene set are part of the performance and can't be undone. [sim]
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/edits/overrides.h"
#include "properties/store.h"
#include "sim/world/world.h"

namespace limber::engine {

class UndoStack {
 public:
  static constexpr std::size_t kMaxSteps = 1000;
  static constexpr std::size_t kMaxValues = std::size_t{1} << 20;  ///< Of all steps; beyond it the oldest are dropped.
  /// Simulated seconds within which writes of a controller to the same property are merged into one step.
  static constexpr double kMergeSeconds = 0.5;

  /// Undo also restores the overrides.
  explicit UndoStack(Overrides& overrides) : overrides_(overrides) {}

  /// Attributes the following writes to this controller. Its writes within one pass form one step.
  void begin(const CommandOrigin& source, const sim::World& world);
  /// Records a write. `old_values`: the previous value. `over_time`: a morph will write values to the property.
  void on_write(const Store& store, NodeId id, const Property& property, bool over_time, const double* old_values);
  /// Ends the pass: completes its steps and drops those that have changed nothing.
  void end(const Store& store);

  /// Undoes the newest step. Skips a step that another controller is still extending, and steps that can't be undone
  /// any more. Returns an error if there is nothing to undo.
  Result<void> undo(sim::World& world);
  /// Redoes the step that was undone last.
  Result<void> redo(sim::World& world);
  /// Readable description of the next step to undo or redo, such as "/physics/body/arm/part/tip/mass (console)"; empty:
  /// none.
  std::string_view undo_text() const { return undo_text_; }
  std::string_view redo_text() const { return redo_text_; }

  /// Makes all steps refer to the objects with the same paths in another store.
  void rebind(const Store& before, const Store& now);
  void clear();

 private:
  struct Edit {
    NodeId id;
    const Property* property = nullptr;
    std::size_t offset = 0;  // index in Step::values
  };
  struct Step {
    CommandOrigin source;
    std::uint64_t pass = 0;
    double time = 0;  // of the last write, simulated seconds
    std::vector<Edit> edits;
    std::vector<double> values;  // the values to exchange: those before the step, or after it once it is undone
    Overrides::Backup overrides;
    bool complete = false;       // the pass that began it has ended: it can be undone
    bool over_time = false;      // a morph writes its values
    std::size_t purge_at = 256;  // number of edits at which edits of removed objects are purged
  };
  // a step that may be extended, with an index of its properties
  struct OpenStep {
    struct SlotMask {
      std::uint32_t generation = 0;
      std::uint64_t step = 0;  // OpenStep::number of the step that `mask` belongs to
      std::uint64_t mask = 0;  // properties of the node that the step contains, one bit each
    };
    Step* step = nullptr;
    std::uint64_t number = 0;     // unique number of the step
    std::vector<SlotMask> masks;  // by slot
    std::uint64_t last_use = 0;   // of uses_, for replacement of the least recently used
    bool has(NodeId id, const Property& property) const;
    bool add(NodeId id, const Property& property);
  };
  using Steps = std::deque<std::unique_ptr<Step>>;

 public:
  /// A copy of the whole stack, for checkpoints.
  struct State {
    struct OpenRef {
      std::size_t step = 0;  ///< Index in undo_steps.
      std::uint64_t number = 0, last_use = 0;
    };
    std::vector<Step> undo_steps, redo_steps;
    std::vector<std::optional<OpenRef>> open_steps;
    std::uint64_t uses = 0, pass = 0;
    std::size_t value_count = 0;  ///< Of all steps.
    std::string undo_text, redo_text;

    /// Approximate size in bytes.
    std::size_t size() const {
      return value_count * 2 * sizeof(double) + (undo_steps.size() + redo_steps.size()) * sizeof(Step);
    }
  };
  std::shared_ptr<const State> state() const;
  void restore(const State& state);
  /// Changes whenever state() may have changed.
  std::uint64_t version() const { return version_; }

 private:
  OpenStep& open_step_for(NodeId id, const Property& property);
  OpenStep& open_step();
  void complete_steps(const Store& store);
  void purge_removed(Step& step, const Store& store);
  void trim();
  void drop(const Step* step);
  bool extended_by_other(const Step& step, const sim::World& world) const;
  Result<void> exchange(Steps& from, Steps& to, sim::World& world, const char* verb);
  static void exchange(Step& step, Store& store, std::size_t& changed, std::size_t& removed);
  static bool differs(const Step& step, const Store& store);
  void update_texts(const Store& store);

  Overrides& overrides_;
  Steps undo_steps_, redo_steps_;
  std::array<OpenStep, 8> open_steps_;
  std::uint64_t uses_ = 0;
  std::size_t value_count_ = 0;  // of all steps
  // of the controller that writes now
  CommandOrigin source_;
  std::uint64_t pass_ = 0;               // counts passes, with and without a time step
  std::uint64_t structure_version_ = 0;  // structure version of the store at begin()
  double time_ = 0;
  bool running_ = false;
  OpenStep* current_ = nullptr;  // the step of this controller in this pass
  bool exchanging_ = false;      // during undo and redo: their writes are not recorded
  bool texts_valid_ = true;      // undo_text_ and redo_text_ are up to date
  std::uint64_t version_ = 0;
  std::string undo_text_, redo_text_;
};

}  // namespace limber::engine
