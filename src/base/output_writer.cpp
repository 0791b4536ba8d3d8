// One thread serves all devices: the oldest text first, unless its device is not ready.
#include "base/output_writer.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fmt/format.h>

#include "base/system/thread.h"
#include "base/text.h"

namespace limber {

namespace {

using namespace std::chrono_literals;

constexpr auto kWriterLook = 20ms;   // how often waiting threads look for hurry() and signals
constexpr auto kDeviceLimit = 50ms;  // a device that is not ready delays text of the others by this
constexpr auto kStallLimit = 1s;
constexpr auto kHurryLimit = 500ms;

// what this thread writes for: hooks run there, and must not wait for it
thread_local const OutputWriter* writer_of_thread = nullptr;

}  // namespace

OutputWriter::OutputWriter(std::vector<OutputStream> streams, std::size_t bytes, std::size_t texts) {
  for (OutputStream& stream : streams) lanes_.push_back(std::make_unique<Lane>(std::move(stream), bytes, texts));
}

OutputWriter::~OutputWriter() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool OutputWriter::start() {
  return system::start_thread(thread_, [this] { run(); });
}

void OutputWriter::write(std::size_t stream, std::string_view text) noexcept {
  Lane& lane = *lanes_[stream];
  try {
    if (lane.stream.full == OutputStream::Full::drop || writer_of_thread == this) {
      if (text.size() <= kLongest) {
        const std::scoped_lock lock(mutex_);
        return push(lane, text);
      }
      if (text.ends_with('\n')) text.remove_suffix(1);
      const std::string cut = shortened(text, kLongest - 1) + "\n";
      const std::scoped_lock lock(mutex_);
      return push(lane, cut);
    }
    const std::scoped_lock turn(lane.turn);
    while (!text.empty()) {
      const std::string_view piece = text.substr(0, kLongest);
      text.remove_prefix(piece.size());
      std::unique_lock lock(mutex_);
      wait_for_room(lock, lane, piece.size());
      push(lane, piece);
    }
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    lane.lost++;  // no memory for it
  }
}

bool OutputWriter::has_room(const Lane& lane, std::size_t size) {
  return lane.queue.fits(size) && (!lane.dropping || lane.queue.half_empty());
}

// gaps are few and large: once a text is dropped, all are, until the queue is half empty
void OutputWriter::push(Lane& lane, std::string_view text) {
  if (!has_room(lane, text.size())) {
    lane.dropping = true;
    lane.dropped++;
    lane.lost++;
    return;
  }
  lane.dropping = lane.told = false;
  if (!lane.writing && lane.queue.empty()) lane.moved = Clock::now();
  lane.queue.push(text, order_++, std::exchange(lane.dropped, 0));
  changed_.notify_one();
}

void OutputWriter::wait_for_room(std::unique_lock<std::mutex>& lock, Lane& lane, std::size_t size) {
  const Clock::time_point begin = Clock::now();
  while (!has_room(lane, size)) {
    if (hurried() || system::end_is_pending()) return;
    if (lane.stream.full == OutputStream::Full::wait_while) {
      lane.stalled = lane.stalled || Clock::now() - std::max(begin, lane.moved) > kStallLimit;
      if (lane.stalled) return;
    }
    progress_.wait_for(lock, kWriterLook);
  }
}

bool OutputWriter::drain(std::size_t stream, std::optional<std::chrono::nanoseconds> patience) {
  Lane& lane = *lanes_[stream];
  std::unique_lock lock(mutex_);
  Clock::time_point begin = Clock::now();
  while (busy(lane)) {
    if (hurried() || system::end_is_pending()) {
      if (!patience) begin = Clock::now();
      patience = patience ? std::min<std::chrono::nanoseconds>(*patience, kHurryLimit) : kHurryLimit;
    }
    const Clock::time_point now = Clock::now();
    if (patience && (now - std::max(begin, lane.moved) > *patience || now - begin > 4 * *patience)) return false;
    progress_.wait_for(lock, kWriterLook);
  }
  return true;
}

std::uint64_t OutputWriter::lost(std::size_t stream) const {
  const std::scoped_lock lock(mutex_);
  return lanes_[stream]->lost;
}

void OutputWriter::run() {
  system::name_this_thread("limber-output");
  system::block_every_signal();
  writer_of_thread = this;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || std::ranges::any_of(lanes_, [](auto& l) { return busy(*l); }); });
    if (ending_) return;
    std::vector<Lane*> overflowing;
    for (const auto& lane : lanes_) {
      if (load(*lane)) progress_.notify_all();
      if (lane->dropping && !std::exchange(lane->told, true)) overflowing.push_back(lane.get());
    }
    lock.unlock();
    for (const Lane* lane : overflowing) {
      if (lane->stream.on_loss) lane->stream.on_loss(0);
    }
    const Step step = advance();
    lock.lock();
    // a device that is ready and still takes nothing is asked again a little later
    if (step == Step::none && !ending_) changed_.wait_for(lock, 1ms);
  }
}

// gives a lane without a text its next one; true: the queue has more room
bool OutputWriter::load(Lane& lane) {
  if (lane.writing || !busy(lane)) return false;
  const bool queued = !lane.queue.empty();
  lane.text.clear();
  lane.at = 0;
  lane.order = queued ? lane.queue.front_order() : order_;
  lane.lines = queued ? 1 : 0;
  if (queued) {
    lane.missing += lane.queue.pop(lane.text);
  } else {
    lane.missing += std::exchange(lane.dropped, 0);
    lane.dropping = lane.told = false;
  }
  if (lane.missing > 0 && lane.stream.counts) {
    lane.text.insert(0, fmt::format("{}limber: warning: {} line{} missing here: nothing took text at that time\n",
                                    lane.open_line ? "\n" : "", lane.missing, lane.missing == 1 ? " is" : "s are"));
  }
  lane.writing = true;
  return queued;
}

OutputWriter::Step OutputWriter::advance() {
  writing_.clear();
  for (const auto& lane : lanes_) {
    if (lane->writing) writing_.push_back(lane.get());
  }
  std::ranges::sort(writing_, {}, &Lane::order);
  for (Lane* lane : writing_) {
    if (advance(*lane, 0ns) == Step::some) return Step::some;
  }
  return writing_.empty() ? Step::some : advance(*writing_.front(), kDeviceLimit);
}

OutputWriter::Step OutputWriter::advance(Lane& lane, std::chrono::nanoseconds limit) {
  if (lane.text.empty()) {  // lines are missing, and are counted elsewhere
    end_text(lane, 0);
    return Step::some;
  }
  const system::Written written = lane.stream.device->write(std::string_view(lane.text).substr(lane.at), limit);
  if (written.count == 0 && (written.error == EAGAIN || written.error == EINTR)) return Step::none;
  if (written.count == 0) {
    end_text(lane, written.error);
    return Step::some;
  }
  lane.at += written.count;
  lane.open_line = lane.text[lane.at - 1] != '\n';
  if (lane.at == lane.text.size()) {
    end_text(lane, 0);
    return Step::some;
  }
  const std::scoped_lock lock(mutex_);
  lane.moved = Clock::now();
  lane.stalled = false;
  return Step::some;
}

// the text is written, or lost by an error
void OutputWriter::end_text(Lane& lane, int error) {
  const bool fails_now = error != 0 && !std::exchange(lane.failing, error != 0);
  const std::uint64_t gap = error == 0 ? std::exchange(lane.missing, 0) : 0;
  if (error == 0) lane.failing = false;
  if (error != 0) lane.missing += lane.lines;
  // before the lane is idle, so that who waits for it finds the reports queued
  if (fails_now && lane.stream.on_loss) lane.stream.on_loss(error);
  if (gap > 0 && lane.stream.on_gap) lane.stream.on_gap(gap);
  const std::scoped_lock lock(mutex_);
  if (error != 0) lane.lost += lane.lines;
  lane.moved = Clock::now();
  lane.stalled = false;
  lane.writing = false;
  progress_.notify_all();
}

}  // namespace limber
