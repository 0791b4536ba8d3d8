// A tick's part of a take.
#include "engine/take_recorder.h"

#include <algorithm>
#include <ctime>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/build_info.h"

namespace limber {

namespace {

TakeHeader header_of(const TakeBegin& begin) {
  // for people; no tick sees it
  const std::time_t now = std::time(nullptr);
  std::tm here{};
  localtime_r(&now, &here);
  char text[32] = {};
  (void)std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &here);
  return {kTakeVersion, fmt::format("{} ({})", version(), commit()), begin.scene, text};
}

}  // namespace

TakeRecorder::TakeRecorder(TakeWriter::Place place, TakeBegin begin, std::function<void(const std::string&)> failed)
    : writer_(std::make_unique<TakeWriter>(std::move(place), header_of(begin), std::move(failed))) {
  writer_->write(std::move(begin));
}

std::size_t TakeRecorder::begin_run(TakeRun run) {
  tick_.runs.push_back(std::move(run));
  return tick_.runs.size() - 1;
}

void TakeRecorder::run_was_good(std::size_t run, TakeFiles files) {
  tick_.runs[run].good = true;
  tick_.runs[run].files = ++files_;
  writer_->write(std::move(files));
}

void TakeRecorder::message(const Message& message, const Origin& origin) {
  TakeBytes out(messages_);
  forms_.write(out, message, origin);
  message_count_++;
}

void TakeRecorder::evaluation(const std::string& text, const Origin& origin) {
  console_.args.resize(1);
  console_.args[0].kind = Arg::Kind::text;
  console_.args[0].text = text;
  message(console_, origin);
}

void TakeRecorder::end_tick(bool running, World& world, const CallLedger& calls,
                            const std::function<std::uint64_t()>& state_hash, bool whole) {
  if (!running && !whole && tick_.runs.empty() && message_count_ == 0 && calls.stopped().empty()) return;
  tick_.running = running;
  if (running) ticks_++;
  tick_.stopped = calls.stopped();
  tick_.tick = world.tick();
  tick_.motion = world.motion_hash().now();
  const std::span<const std::uint64_t> bodies = world.motion_hash().bodies();
  tick_.state.reset();
  state_credit_ += kStateBytes;
  if (whole || state_credit_ >= world.store().kept().size() * sizeof(double)) {
    tick_.state = state_hash();
    state_credit_ = 0;
  }
  if (next_body_ >= bodies.size()) next_body_ = 0;
  const std::size_t end = std::min(next_body_ + kBodies, bodies.size());
  tick_.first_body = static_cast<std::uint32_t>(next_body_);
  tick_.bodies.clear();
  for (; next_body_ < end; next_body_++) tick_.bodies.push_back(static_cast<std::uint16_t>(bodies[next_body_]));
  payload_.clear();
  append_tick(payload_, tick_, message_count_, messages_);
  frame_.clear();
  append_frame(frame_, TakeFrame::tick, payload_);
  writer_->write(frame_);
  tick_.runs.clear();
  messages_.clear();
  message_count_ = 0;
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

}  // namespace limber
