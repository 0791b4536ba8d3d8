// Which checkpoints are captured, discarded and restored, and the recorded inputs between them.
#include "engine/history/history.h"

#include <algorithm>
#include <utility>

#include "base/log/log.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxInputBytes = std::size_t{4} << 20;  // bytes of inputs after one checkpoint
constexpr std::uint64_t kTicksBetweenStops = 15;  // ticks: limits checkpoints caused by repeatedly stopped calls

}  // namespace

std::size_t History::bytes() const {
  std::size_t total = store_.bytes();
  const UndoStack::State* last_undo = nullptr;
  for (const auto& checkpoint : checkpoints_) {
    total += checkpoint->passes.capacity() + checkpoint->handler_queue.bytes();
    if (checkpoint->undo.get() != last_undo) total += checkpoint->undo->size();
    last_undo = checkpoint->undo.get();
  }
  return total;
}

void History::clear(std::string_view why) {
  clears_++;
  while (!checkpoints_.empty()) drop(checkpoints_.size() - 1);
  if (pinned_ != nullptr) store_.recycle(std::move(pinned_));
  pinned_tick_ = kNoTick;
  limit_reason_ = why;
  too_large_ = false;
}

// a checkpoint lists nodes in order, so it fits only the structure that it was captured from
bool History::validate(const Session& session) {
  const std::uint64_t structure = session.store.structure_version();
  if (std::exchange(structure_version_, structure) != structure && !checkpoints_.empty())
    clear("objects were added or removed");
  return !checkpoints_.empty();
}

void History::drop(std::size_t index) {
  std::unique_ptr<Checkpoint> checkpoint = std::move(checkpoints_[index]);
  checkpoints_.erase(checkpoints_.begin() + static_cast<std::ptrdiff_t>(index));
  store_.recycle(std::move(checkpoint));
}

void History::drop_oldest() {
  if (checkpoints_.front()->tick != pinned_tick_) return drop(0);
  pinned_ = std::move(checkpoints_.front());
  pinned_->passes.clear();
  checkpoints_.erase(checkpoints_.begin());
}

void History::pin() {
  if (pinned_ != nullptr) store_.recycle(std::move(pinned_));
  pinned_tick_ = checkpoints_.empty() ? kNoTick : checkpoints_.back()->tick;
}

void History::record_input(const Message& message, const CommandOrigin& origin, bool evaluate) {
  if (!checkpoints_.empty()) inputs_.record(message, origin, evaluate);
}

void History::end_pass(Session& session, const script::CallLog& calls, bool running, double seconds) {
  if (seconds <= 0) {
    if (!checkpoints_.empty()) clear("history is switched off");
    limit_reason_ = "history is switched off";
    store_.free_memory();
    release_ended_runs(session);
    return;
  }
  if (validate(session)) append_pass(calls, running);
  inputs_.clear();
  if (checkpoint_due(session.world, !calls.stopped().empty())) capture_checkpoint(session);
  trim(session.world, seconds);
  release_ended_runs(session);
}

void History::append_pass(const script::CallLog& calls, bool running) {
  pass_.running = running;
  pass_.stopped_calls = calls.stopped_since_rewind();
  if (!running && inputs_.empty() && pass_.stopped_calls.empty()) return;
  checkpoints_.back()->passes.append(inputs_, pass_);
}

// Releases scene runs with no timer that was active at or after the oldest checkpoint.
void History::release_ended_runs(Session& session) const {
  if (session.scene == nullptr) return;
  session.scene->release_ended(pinned_ != nullptr ? pinned_->tick : empty() ? kNoTick : oldest_tick());
}

bool History::checkpoint_due(const sim::World& world, bool stopped) const {
  if (too_large_) return false;
  const bool interval_over =
      world.time() >= checkpoint_time_ + kCheckpointInterval - 1e-9 || world.tick() < checkpoint_tick_;
  if (checkpoints_.empty()) return interval_over || checkpoint_tick_ == 0;
  if (interval_over) return true;
  // changes that a call made in Lua before it was stopped can't be reproduced from inputs
  if (stopped && world.tick() >= checkpoint_tick_ + kTicksBetweenStops) return true;
  return checkpoints_.back()->passes.size() > kMaxInputBytes;
}

void History::capture_checkpoint(Session& session) {
  checkpoints_.push_back(store_.capture(session, checkpoints_.empty() ? nullptr : checkpoints_.back().get()));
  checkpoint_tick_ = session.world.tick();
  checkpoint_time_ = session.world.time();
}

void History::trim(const sim::World& world, double seconds) {
  while (checkpoints_.size() > 1 && checkpoints_[1]->time <= world.time() - seconds + 1e-9) {
    drop_oldest();
    limit_reason_ = "history is limited by /physics/sim/history";
  }
  bool shortage = false;
  while (checkpoints_.size() > 1 && bytes() > max_bytes_) {
    drop_oldest();
    shortage = true;
    limit_reason_ = "history is limited to 256 MB";
  }
  if (checkpoints_.size() == 1 && bytes() > max_bytes_) {
    clear("one checkpoint of this scene takes more than 256 MB");
    too_large_ = shortage = true;
  }
  if (!shortage || std::exchange(shortage_reported_, true)) return;
  log_info("history: {:.0f} s instead of {:.0f} s: {} (reported once)",
           checkpoints_.empty() ? 0 : world.time() - oldest_time(), seconds, limit_reason_);
}

void History::restore_checkpoint(Session& session, std::size_t index) {
  while (checkpoints_.size() > index + 1) drop(checkpoints_.size() - 1);
  Checkpoint& checkpoint = *checkpoints_[index];
  store_.restore(session, checkpoint);
  checkpoint_tick_ = checkpoint.tick;
  checkpoint_time_ = checkpoint.time;
  checkpoint.passes.begin_reading();
  inputs_.clear();  // they belong to the discarded future
}

void History::restore(Session& session, const RewindTarget& target) {
  const double half_tick = session.world.timestep() / 2;
  std::size_t index = checkpoints_.size();
  while (--index > 0) {
    const Checkpoint& checkpoint = *checkpoints_[index];
    if (target.time ? checkpoint.time <= *target.time + half_tick : checkpoint.tick <= target.tick) break;
  }
  restore_checkpoint(session, index);
}

bool History::restore_before(Session& session, std::uint64_t tick) {
  std::size_t index = checkpoints_.size();
  while (index > 0 && checkpoints_[index - 1]->tick >= tick) index--;
  if (index == 0) {
    if (pinned_ == nullptr || pinned_->tick >= tick) return false;
    checkpoints_.insert(checkpoints_.begin(), std::move(pinned_));
    index = 1;
  }
  restore_checkpoint(session, index - 1);
  truncate();
  return true;
}

}  // namespace limber::engine
