// EditScope: during its lifetime, writes to properties are edits of a controller: they release the property from
// running morphs, and after begin() they are recorded for undo and in the change log. [sim]
#pragma once

#include "base/system/clock.h"
#include "engine/edits/change_recorder.h"
#include "engine/edits/undo_stack.h"
#include "engine/presets/presets.h"

namespace limber::engine {

class EditScope {
 public:
  EditScope(sim::World& world, Presets& presets, UndoStack& undo_stack, ChangeRecorder& change_recorder)
      : world_(world), presets_(presets), undo_stack_(undo_stack), change_recorder_(change_recorder) {
    const auto on_write = [](void* self, NodeId id, const Property& property, bool over_time,
                             const double* old_values) {
      static_cast<EditScope*>(self)->on_write(id, property, over_time, old_values);
    };
    previous_ = world.store().set_listener({on_write, this});
  }
  ~EditScope() { world_.store().set_listener(previous_); }
  EditScope(const EditScope&) = delete;
  EditScope& operator=(const EditScope&) = delete;

  /// Attributes the following writes to this controller. Writes before the first call belong to the scene and are not
  /// recorded.
  void begin(const CommandOrigin& source) {
    begun_ = true;
    undo_stack_.begin(source, world_);
    change_recorder_.begin(source, now_);
  }

 private:
  void on_write(NodeId id, const Property& property, bool over_time, const double* old_values) {
    presets_.release(id, property);
    if (!begun_) return;
    undo_stack_.on_write(world_.store(), id, property, over_time, old_values);
    if (!over_time) change_recorder_.on_write(id, property, old_values);
  }

  sim::World& world_;
  Presets& presets_;
  UndoStack& undo_stack_;
  ChangeRecorder& change_recorder_;
  Store::Listener previous_;
  const double now_ = system::clock_seconds();
  bool begun_ = false;
};

}  // namespace limber::engine
