// The program's OutputWriter, results, and text before there is a writer.
#include "base/output.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/log.h"
#include "base/output_writer.h"

namespace limber {

namespace {

using namespace std::chrono_literals;

constexpr auto kEndPatience = 1s;    // at the end, for a device that takes nothing
constexpr auto kResultLook = 50ms;   // how often a waiting result looks for signals
constexpr auto kLastMoment = 500ms;  // for a result once a signal has come

struct DescriptorDevice : OutputDevice {
  explicit DescriptorDevice(int number) : fd(number) {}
  system::Written write(std::string_view bytes, std::chrono::nanoseconds limit) override {
    return system::write_within(fd, bytes, limit);
  }
  int fd;
};

// never destroyed: its thread may be in a write when the program ends
std::atomic<OutputWriter*> the_writer{nullptr};
std::atomic<OutputMode> the_mode{OutputMode::batch};
std::atomic<int> the_result_error{0};

constexpr std::size_t lane_of(OutputTo to) { return static_cast<std::size_t>(to); }

const char* stream_name(OutputTo to) { return to == OutputTo::out ? "standard output" : "standard error"; }

// standard error counts its lost lines itself; those of standard output would be among a script's data
OutputStream stream_of(OutputTo to, OutputMode mode) {
  OutputStream stream;
  stream.device =
      std::make_unique<DescriptorDevice>(to == OutputTo::out ? system::kStandardOutput : system::kStandardError);
  const bool live = mode == OutputMode::live;
  stream.full = live                  ? OutputStream::Full::drop
                : to == OutputTo::out ? OutputStream::Full::wait
                                      : OutputStream::Full::wait_while;
  stream.counts = to == OutputTo::error;
  stream.on_loss = [to, live](int error) {
    if (error == EPIPE && !live) return;  // as in `| head`
    log_warning("{} {}; lines for it are lost until it takes them, the show goes on", stream_name(to),
                error == 0 ? "is not read" : fmt::format("fails: {}", std::generic_category().message(error)));
  };
  if (to == OutputTo::out) {
    stream.on_gap = [](std::uint64_t lines) {
      log_warning("standard output takes text again; {} line{} lost", lines, lines == 1 ? " is" : "s are");
    };
  }
  return stream;
}

void write_directly(int fd, std::string_view text) {
  static std::mutex& mutex = *new std::mutex;  // lines of several threads; it outlives them
  const std::scoped_lock lock(mutex);
  while (!text.empty()) {
    const system::Written written = system::write_within(fd, text, 1s);
    if (written.count == 0 && written.error != EAGAIN) return;
    text.remove_prefix(written.count);
  }
}

}  // namespace

void write_line(OutputTo to, std::string_view line) noexcept {
  try {
    std::string text;
    text.reserve(line.size() + 1);
    text.append(line).push_back('\n');
    if (OutputWriter* const writer = the_writer.load(std::memory_order_acquire)) {
      writer->write(lane_of(to), text);
    } else {
      write_directly(to == OutputTo::out ? system::kStandardOutput : system::kStandardError, text);
    }
  } catch (...) {  // no memory for it
  }
}

void start_output(OutputMode mode) {
  std::vector<OutputStream> streams;
  streams.push_back(stream_of(OutputTo::out, mode));
  streams.push_back(stream_of(OutputTo::error, mode));
  auto writer = std::make_unique<OutputWriter>(std::move(streams));
  if (!writer->start()) return;
  writer->detach();
  the_mode.store(mode);
  the_writer.store(writer.release(), std::memory_order_release);
}

bool output_is_live() {
  return the_writer.load(std::memory_order_acquire) != nullptr && the_mode.load() == OutputMode::live;
}

void hurry_output() {
  if (OutputWriter* const writer = the_writer.load(std::memory_order_acquire)) writer->hurry();
}

void finish_output() {
  OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  if (writer == nullptr) return;
  const bool live = the_mode.load() == OutputMode::live;
  (void)writer->drain(lane_of(OutputTo::out),
                      live ? std::optional<std::chrono::nanoseconds>(kEndPatience) : std::nullopt);
  (void)writer->drain(lane_of(OutputTo::error), kEndPatience);
}

std::uint64_t lost_output_lines() {
  const OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  return writer == nullptr ? 0 : writer->lost(lane_of(OutputTo::out)) + writer->lost(lane_of(OutputTo::error));
}

bool write_result(std::string_view text) noexcept {
  if (the_result_error.load() != 0) return false;
  OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  if (writer != nullptr) {  // one file may be both
    (void)writer->drain(lane_of(OutputTo::error), kEndPatience);
    (void)writer->drain(lane_of(OutputTo::out), std::nullopt);
  }
  std::optional<std::chrono::steady_clock::time_point> end;
  while (!text.empty()) {
    const system::Written written = system::write_within(system::kStandardOutput, text, kResultLook);
    text.remove_prefix(written.count);
    if (written.count > 0) continue;
    const auto now = std::chrono::steady_clock::now();
    if (!end && ((writer != nullptr && writer->hurried()) || system::end_is_pending())) end = now + kLastMoment;
    const int error = written.error == EAGAIN && end && now > *end ? ETIMEDOUT : written.error;
    if (error == EAGAIN) continue;
    the_result_error.store(error);
    return false;
  }
  return true;
}

int result_error() { return the_result_error.load(); }

}  // namespace limber
