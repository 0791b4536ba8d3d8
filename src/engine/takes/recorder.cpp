// Assembles the frame of each tick.
#include "engine/takes/recorder.h"

#include <algorithm>
#include <ctime>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"

namespace limber::engine {

namespace {

TakeHeader header_of(const TakeInitialState& initial_state) {
  // only information for people: the simulation never reads it
  const std::time_t now = std::time(nullptr);
  std::tm local_time{};
  localtime_r(&now, &local_time);
  char text[32] = {};
  (void)std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &local_time);
  return {kTakeVersion, fmt::format("{} ({})", version(), commit()), initial_state.scene, text};
}

}  // namespace

TakeRecorder::TakeRecorder(BackgroundWriter& writer, TakeWriter::Target target, TakeInitialState initial_state,
                           std::function<void(const std::string&)> on_failure)
    : writer_(
          std::make_unique<TakeWriter>(writer, std::move(target), header_of(initial_state), std::move(on_failure))) {
  writer_->write(std::move(initial_state));
}

std::size_t TakeRecorder::begin_run(TakeSceneRun run) {
  tick_.runs.push_back(std::move(run));
  return tick_.runs.size() - 1;
}

void TakeRecorder::run_succeeded(std::size_t run, TakeFiles files) {
  tick_.runs[run].succeeded = true;
  tick_.runs[run].files = ++files_;
  writer_->write(std::move(files));
}

void TakeRecorder::end_tick(bool running, sim::World& world, const script::CallLog& calls,
                            const std::function<std::uint64_t()>& state_hash, bool with_state_hash) {
  if (!running && !with_state_hash && tick_.runs.empty() && inputs_.empty() && calls.stopped().empty()) return;
  tick_.running = running;
  if (running) ticks_++;
  tick_.stopped_calls = calls.stopped();
  tick_.tick = world.tick();
  tick_.motion_hash = world.motion_hash().compute();
  const std::span<const std::uint64_t> bodies = world.motion_hash().body_hashes();
  tick_.state_hash.reset();
  state_hash_budget_ += kStateBytesPerTick;
  if (with_state_hash || state_hash_budget_ >= world.store().persistent_values().size() * sizeof(double)) {
    tick_.state_hash = state_hash();
    state_hash_budget_ = 0;
  }
  if (next_body_ >= bodies.size()) next_body_ = 0;
  const std::size_t end = std::min(next_body_ + kBodyHashesPerTick, bodies.size());
  tick_.first_body = static_cast<std::uint32_t>(next_body_);
  tick_.body_hashes.clear();
  for (; next_body_ < end; next_body_++) tick_.body_hashes.push_back(static_cast<std::uint16_t>(bodies[next_body_]));
  payload_.clear();
  inputs_.append_pass(payload_, tick_);
  frame_.clear();
  append_frame(frame_, TakeFrame::tick, payload_);
  writer_->write(frame_);
  tick_.runs.clear();
}

std::unique_ptr<TakeWriter> TakeRecorder::finish(const TakeEnd& end) {
  frame_.clear();
  append_frame(frame_, TakeFrame::end, text_of(end));
  writer_->write(frame_);
  writer_->close();
  return std::move(writer_);
}

std::unique_ptr<TakeWriter> TakeRecorder::abandon() {
  writer_->abandon();
  return std::move(writer_);
}

}  // namespace limber::engine
