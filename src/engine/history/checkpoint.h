// Checkpoint: the state of a show at the end of a tick, and the inputs of the passes after it. CheckpointStore
// captures, restores and recycles checkpoints. [sim]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/memory/archive.h"
#include "base/memory/page_store.h"
#include "engine/commands/handler_queue.h"
#include "engine/commands/mouse_springs.h"
#include "engine/cues/cue_player.h"
#include "engine/edits/overrides.h"
#include "engine/edits/undo_stack.h"
#include "engine/presets/presets.h"
#include "engine/session.h"
#include "engine/takes/encoding.h"
#include "script/scene/scene_checkpoint.h"
#include "sim/state/world_checkpoint.h"

namespace limber::engine {

/// Recorded passes, encoded. Doesn't allocate once its memory has grown.
class PassLog {
 public:
  /// Appends a pass with the inputs in the log, and clears the log.
  void append(InputLog& inputs, const RecordedPass& pass);
  /// Makes next() begin with the first pass.
  void begin_reading() { next_ = last_start_ = 0; }
  /// Reads the next pass. False at the end.
  bool next(RecordedPass& pass);
  /// Discards the passes that next() has not read yet. `last`: also the last one that it has read.
  void truncate(bool last) { bytes_.resize(last ? last_start_ : next_); }
  void clear() { bytes_.clear(); }
  std::size_t size() const { return bytes_.size(); }
  std::size_t capacity() const { return bytes_.capacity(); }

 private:
  std::string bytes_;           // of each pass: its length, then the encoded pass
  std::size_t next_ = 0;        // offset of the pass that next() will read
  std::size_t last_start_ = 0;  // offset of the pass that next() has read last
};

struct Checkpoint {
  std::uint64_t tick = 0;
  double time = 0;
  sim::WorldCheckpoint world;
  script::SceneCheckpoint scene;
  bool has_scene = false;
  std::shared_ptr<const Overrides> overrides;
  std::shared_ptr<const UndoStack::State> undo;
  Presets::State presets;
  CueState cue;
  MouseSprings mouse_springs;
  HandlerQueue handler_queue;
  PassLog passes;
};

class CheckpointStore {
 public:
  CheckpointStore(Overrides& overrides, UndoStack& undo, Presets& presets, CuePlayer& cues, HandlerQueue& handler_queue)
      : overrides_(overrides), undo_(undo), presets_(presets), cues_(cues), handler_queue_(handler_queue) {}

  /// Captures a checkpoint. Memory that equals that of `previous` is shared with it; null: none.
  std::unique_ptr<Checkpoint> capture(Session& session, const Checkpoint* previous);
  /// Restores the state of a checkpoint. It must have been captured from a session of the same structure.
  void restore(Session& session, const Checkpoint& checkpoint);
  /// Discards a checkpoint; a later one reuses its memory.
  void recycle(std::unique_ptr<Checkpoint> checkpoint);
  /// Frees the memory of discarded checkpoints.
  void free_memory();
  /// Memory of all checkpoints in bytes, without their passes.
  std::size_t bytes() const { return pages_.bytes(); }

 private:
  /// A shared copy and the version of the original, to avoid copying unchanged data.
  template <class T>
  struct Shared {
    std::shared_ptr<const T> copy;
    std::uint64_t version = 0;
  };

  Overrides& overrides_;
  UndoStack& undo_;
  Presets& presets_;
  CuePlayer& cues_;
  HandlerQueue& handler_queue_;
  PageStore pages_;
  std::vector<std::unique_ptr<Checkpoint>> free_;
  Shared<Overrides> shared_overrides_;
  Shared<UndoStack::State> shared_undo_;
  Archive scratch_;
};

}  // namespace limber::engine
