// SavedStates: copies of the state of a show in memory, made and restored between two passes, for programs that contain
// the simulation. [sim]
#pragma once

#include <cstdint>
#include <memory>

#include "engine/show_state.h"

namespace limber::engine {

struct SavedState {
  std::unique_ptr<Checkpoint> checkpoint;
  std::uint64_t structure_version = 0;  ///< Of the store.
  std::uint64_t history_clears = 0;     ///< History::clears(): changes with each run of the scene.
};

class SavedStates {
 public:
  explicit SavedStates(ShowState& show)
      : show_(show), store_(show.overrides, show.undo_stack, show.presets, show.cues, show.handler_queue) {}

  /// Copies the state. Memory that equals that of `previous` is shared with it; null: none.
  SavedState save(const SavedState* previous = nullptr);
  /// Restores a state; presets stay as they are. Error, without a change: the scene has run again since, or has added
  /// or removed objects.
  Result<void> restore(const SavedState& state);
  /// Discards a state; a later one reuses its memory.
  void discard(SavedState& state) { store_.recycle(std::move(state.checkpoint)); }

 private:
  ShowState& show_;
  CheckpointStore store_;
};

}  // namespace limber::engine
