// Capture, restore and disposal of checkpoints.
#include "engine/history/checkpoint.h"

#include <cstring>
#include <utility>

namespace limber::engine {

void PassLog::append(InputLog& inputs, const RecordedPass& pass) {
  std::uint32_t length = 0;
  const std::size_t start = bytes_.size() + sizeof length;
  bytes_.resize(start);
  inputs.append_pass(bytes_, pass);
  length = static_cast<std::uint32_t>(bytes_.size() - start);
  std::memcpy(bytes_.data() + start - sizeof length, &length, sizeof length);
}

bool PassLog::next(RecordedPass& pass) {
  last_start_ = next_;
  if (next_ >= bytes_.size()) return false;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes_.data() + next_, sizeof length);
  const std::string_view encoded = std::string_view(bytes_).substr(next_ + sizeof length, length);
  next_ += sizeof length + length;
  InputCodec codec(0);
  return read_pass(encoded, codec, pass);
}

std::unique_ptr<Checkpoint> CheckpointStore::capture(Session& session, const Checkpoint* previous) {
  if (free_.empty()) free_.push_back(std::make_unique<Checkpoint>());
  std::unique_ptr<Checkpoint> checkpoint = std::move(free_.back());
  free_.pop_back();
  checkpoint->tick = session.world.tick();
  checkpoint->time = session.world.time();
  checkpoint->world.capture(session.world, pages_, previous == nullptr ? nullptr : &previous->world, scratch_);
  checkpoint->has_scene = session.scene != nullptr;
  if (checkpoint->has_scene)
    checkpoint->scene.capture(*session.scene, pages_, previous == nullptr ? nullptr : &previous->scene, scratch_);
  if (const std::uint64_t now = overrides_.version();
      shared_overrides_.copy == nullptr || shared_overrides_.version != now)
    shared_overrides_ = {std::make_shared<const Overrides>(overrides_), now};
  if (const std::uint64_t now = undo_.version(); shared_undo_.copy == nullptr || shared_undo_.version != now)
    shared_undo_ = {undo_.state(), now};
  checkpoint->overrides = shared_overrides_.copy;
  checkpoint->undo = shared_undo_.copy;
  presets_.capture(checkpoint->presets);
  checkpoint->cue = cues_.state();
  checkpoint->mouse_springs = session.dispatcher.mouse_springs();
  checkpoint->handler_queue = handler_queue_;
  return checkpoint;
}

void CheckpointStore::restore(Session& session, const Checkpoint& checkpoint) {
  checkpoint.world.restore(session.world, pages_, scratch_);
  if (checkpoint.has_scene) checkpoint.scene.restore(*session.scene, pages_, scratch_);
  overrides_.restore(*checkpoint.overrides);
  undo_.restore(*checkpoint.undo);
  presets_.restore(checkpoint.presets);
  cues_.set_state(checkpoint.cue);
  shared_overrides_ = {checkpoint.overrides, overrides_.version()};
  shared_undo_ = {checkpoint.undo, undo_.version()};
  session.dispatcher.mouse_springs() = checkpoint.mouse_springs;
  handler_queue_ = checkpoint.handler_queue;
}

void CheckpointStore::recycle(std::unique_ptr<Checkpoint> checkpoint) {
  checkpoint->world.release(pages_);
  checkpoint->scene.release(pages_);
  checkpoint->handler_queue.clear();
  checkpoint->passes.clear();
  free_.push_back(std::move(checkpoint));
}

void CheckpointStore::free_memory() {
  free_.clear();
  if (pages_.bytes() == 0) pages_.clear();
}

}  // namespace limber::engine
