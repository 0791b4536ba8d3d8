// One thread writes to all devices: the oldest text first, unless its device is not ready.
#include "base/log/output_writer.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "base/plural.h"
#include "base/system/thread.h"
#include "base/text.h"

namespace limber {

namespace {

using namespace std::chrono_literals;

constexpr auto kPollInterval = 20ms;  // interval at which waiting threads check for shutdown and signals
constexpr auto kDeviceLimit = 50ms;   // a device that is not ready delays text of the others by this
constexpr auto kStallLimit = 1s;
constexpr auto kShutdownLimit = 500ms;

// The writer that runs in this thread. Its callbacks write from this thread and must not wait for it.
thread_local const OutputWriter* writer_of_thread = nullptr;

}  // namespace

OutputWriter::OutputWriter(std::vector<OutputStream> streams, std::size_t bytes, std::size_t texts) {
  for (OutputStream& stream : streams)
    streams_.push_back(std::make_unique<StreamState>(std::move(stream), bytes, texts));
}

OutputWriter::~OutputWriter() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool OutputWriter::start() {
  return system::start_thread(thread_, [this] { run(); });
}

void OutputWriter::write(std::size_t stream, std::string_view text) noexcept {
  StreamState& state = *streams_[stream];
  try {
    if (state.stream.full == OutputStream::Full::drop || writer_of_thread == this) {
      if (text.size() <= kMaxTextBytes) {
        const std::scoped_lock lock(mutex_);
        return push(state, text);
      }
      if (text.ends_with('\n')) text.remove_suffix(1);
      const std::string cut = shortened(text, kMaxTextBytes - 1) + "\n";
      const std::scoped_lock lock(mutex_);
      return push(state, cut);
    }
    const std::scoped_lock turn(state.pieces_mutex);
    while (!text.empty()) {
      const std::string_view piece = text.substr(0, kMaxTextBytes);
      text.remove_prefix(piece.size());
      std::unique_lock lock(mutex_);
      wait_for_space(lock, state, piece.size());
      push(state, piece);
    }
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    state.lost++;  // no memory for it
  }
}

bool OutputWriter::has_space(const StreamState& state, std::size_t size) {
  return state.queue.fits(size) && (!state.dropping || state.queue.half_empty());
}

// Once a text was dropped, drops all until the queue is half empty, so that gaps are few and large.
void OutputWriter::push(StreamState& state, std::string_view text) {
  if (!has_space(state, text.size())) {
    state.dropping = true;
    state.dropped++;
    state.lost++;
    return;
  }
  state.dropping = state.loss_reported = false;
  if (!state.writing && state.queue.empty()) state.last_progress = Clock::now();
  state.queue.push(text, order_++, std::exchange(state.dropped, 0));
  changed_.notify_one();
}

void OutputWriter::wait_for_space(std::unique_lock<std::mutex>& lock, StreamState& state, std::size_t size) {
  const Clock::time_point begin = Clock::now();
  while (!has_space(state, size)) {
    if (shutting_down() || system::termination_is_pending()) return;
    if (state.stream.full == OutputStream::Full::wait_while) {
      state.stalled = state.stalled || Clock::now() - std::max(begin, state.last_progress) > kStallLimit;
      if (state.stalled) return;
    }
    progress_.wait_for(lock, kPollInterval);
  }
}

bool OutputWriter::drain(std::size_t stream, std::optional<std::chrono::nanoseconds> timeout) {
  StreamState& state = *streams_[stream];
  std::unique_lock lock(mutex_);
  Clock::time_point begin = Clock::now();
  while (busy(state)) {
    if (shutting_down() || system::termination_is_pending()) {
      if (!timeout) begin = Clock::now();
      timeout = timeout ? std::min<std::chrono::nanoseconds>(*timeout, kShutdownLimit) : kShutdownLimit;
    }
    const Clock::time_point now = Clock::now();
    if (timeout && (now - std::max(begin, state.last_progress) > *timeout || now - begin > 4 * *timeout)) return false;
    progress_.wait_for(lock, kPollInterval);
  }
  return true;
}

std::uint64_t OutputWriter::lost(std::size_t stream) const {
  const std::scoped_lock lock(mutex_);
  return streams_[stream]->lost;
}

void OutputWriter::run() {
  system::name_this_thread("limber-output");
  system::block_all_signals();
  writer_of_thread = this;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock,
                  [this] { return stopping_ || std::ranges::any_of(streams_, [](auto& l) { return busy(*l); }); });
    if (stopping_) return;
    std::vector<StreamState*> overflowing;
    for (const auto& state : streams_) {
      if (load(*state)) progress_.notify_all();
      if (state->dropping && !std::exchange(state->loss_reported, true)) overflowing.push_back(state.get());
    }
    lock.unlock();
    for (const StreamState* state : overflowing) {
      if (state->stream.on_loss) state->stream.on_loss(0);
    }
    const Step step = advance();
    lock.lock();
    // Retry later if a device is ready but accepts nothing.
    if (step == Step::none && !stopping_) changed_.wait_for(lock, 1ms);
  }
}

// If the stream has no text to write, loads the next one from its queue, preceded by the number of lost lines. True if
// the queue has more space now.
bool OutputWriter::load(StreamState& state) {
  if (state.writing || !busy(state)) return false;
  const bool queued = !state.queue.empty();
  state.text.clear();
  state.at = 0;
  state.order = queued ? state.queue.front_order() : order_;
  state.lines = queued ? 1 : 0;
  if (queued) {
    state.missing += state.queue.pop(state.text);
  } else {
    state.missing += std::exchange(state.dropped, 0);
    state.dropping = state.loss_reported = false;
  }
  if (state.missing > 0 && state.stream.inserts_notice) {
    state.text.insert(0, fmt::format("{}limber: warning: {} missing here: the output was blocked\n",
                                     state.open_line ? "\n" : "", counted(state.missing, "line is", "lines are")));
  }
  state.writing = true;
  return queued;
}

OutputWriter::Step OutputWriter::advance() {
  writing_.clear();
  for (const auto& state : streams_) {
    if (state->writing) writing_.push_back(state.get());
  }
  std::ranges::sort(writing_, {}, &StreamState::order);
  for (StreamState* state : writing_) {
    if (advance(*state, 0ns) == Step::some) return Step::some;
  }
  return writing_.empty() ? Step::some : advance(*writing_.front(), kDeviceLimit);
}

OutputWriter::Step OutputWriter::advance(StreamState& state, std::chrono::nanoseconds limit) {
  if (state.text.empty()) {  // only a count of lost lines, which on_gap reports
    end_text(state, 0);
    return Step::some;
  }
  const system::Written written = state.stream.device->write(std::string_view(state.text).substr(state.at), limit);
  if (written.count == 0 && (written.error == EAGAIN || written.error == EINTR)) return Step::none;
  if (written.count == 0) {
    end_text(state, written.error);
    return Step::some;
  }
  state.at += written.count;
  state.open_line = state.text[state.at - 1] != '\n';
  if (state.at == state.text.size()) {
    end_text(state, 0);
    return Step::some;
  }
  const std::scoped_lock lock(mutex_);
  state.last_progress = Clock::now();
  state.stalled = false;
  return Step::some;
}

// Finishes a text that was written, or lost because of an error.
void OutputWriter::end_text(StreamState& state, int error) {
  const bool fails_now = error != 0 && !std::exchange(state.failing, error != 0);
  const std::uint64_t gap = error == 0 ? std::exchange(state.missing, 0) : 0;
  if (error == 0) state.failing = false;
  if (error != 0) state.missing += state.lines;
  // Called before the stream is idle, so that the reports are queued before drain() returns.
  if (fails_now && state.stream.on_loss) state.stream.on_loss(error);
  if (gap > 0 && state.stream.on_gap) state.stream.on_gap(gap);
  const std::scoped_lock lock(mutex_);
  if (error != 0) state.lost += state.lines;
  state.last_progress = Clock::now();
  state.stalled = false;
  state.writing = false;
  progress_.notify_all();
}

}  // namespace limber
