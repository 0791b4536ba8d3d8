// The program's OutputWriter, results of commands, and direct output before the writer is started.
#include "base/log/output.h"

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

#include "base/log/log.h"
#include "base/log/output_writer.h"
#include "base/plural.h"
#include "base/system/clock.h"
#include "base/system/service_manager.h"
#include "base/text.h"

namespace limber {

namespace {

using namespace std::chrono_literals;

constexpr auto kExitTimeout = 1s;           // at exit, for a device that accepts nothing
constexpr auto kResultPollInterval = 50ms;  // interval at which a waiting result checks for signals
constexpr auto kResultGrace = 500ms;        // time to write a result after a signal

struct DescriptorDevice : OutputDevice {
  explicit DescriptorDevice(int number) : fd(number) {}
  system::Written write(std::string_view bytes, std::chrono::nanoseconds limit) override {
    return system::write_within(fd, bytes, limit);
  }
  int fd;
};

// Never destroyed, because its thread may be writing when the program exits.
std::atomic<OutputWriter*> the_writer{nullptr};
std::atomic<OutputMode> the_mode{OutputMode::batch};
std::atomic<bool> is_quiet{false};
std::atomic<bool> has_log{false};
std::atomic<int> the_result_error{0};

constexpr std::size_t stream_index(OutputTo to) { return static_cast<std::size_t>(to); }
constexpr std::size_t kLogStream = 2;

const char* stream_name(OutputTo to) { return to == OutputTo::out ? "standard output" : "standard error"; }

// Standard error contains the numbers of lost lines. Standard output does not, since they would mix with a script's
// data.
OutputStream stream_of(OutputTo to, OutputMode mode) {
  OutputStream stream;
  stream.device =
      std::make_unique<DescriptorDevice>(to == OutputTo::out ? system::kStandardOutput : system::kStandardError);
  const bool live = mode == OutputMode::live;
  stream.full = live                  ? OutputStream::Full::drop
                : to == OutputTo::out ? OutputStream::Full::wait
                                      : OutputStream::Full::wait_while;
  stream.inserts_notice = to == OutputTo::error;
  stream.on_loss = [to, live](int error) {
    if (error == EPIPE && !live) return;  // as in `| head`
    log_warning("{} {}; lines are dropped until it accepts them", stream_name(to),
                error == 0 ? "is not read" : fmt::format("fails: {}", std::generic_category().message(error)));
  };
  if (to == OutputTo::out) {
    stream.on_gap = [](std::uint64_t lines) {
      log_warning("standard output accepts text again; {} lost", counted(lines, "line is", "lines are"));
    };
  }
  return stream;
}

OutputStream log_stream(std::unique_ptr<OutputDevice> device, const std::string& name) {
  OutputStream stream;
  stream.device = std::move(device);
  stream.on_loss = [name](int error) {
    log_warning("the log file {} {}; lines are dropped until it accepts them", name,
                error == 0 ? "is too slow" : fmt::format("fails: {}", std::generic_category().message(error)));
  };
  stream.on_gap = [name](std::uint64_t lines) {
    log_warning("the log file {} accepts text again; {} lost", name, counted(lines, "line is", "lines are"));
  };
  return stream;
}

// Adds the level to each line: "<4>warning: a line".
std::string journal_text(MessageLevel severity, std::string_view text) {
  std::string out;
  for (const std::string_view line : split(text, '\n'))
    out += fmt::format("{}<{}>{}", out.empty() ? "" : "\n", static_cast<int>(severity), line);
  return out;
}

void write_log(std::string_view kind, std::string_view text) {
  OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  if (writer == nullptr || !has_log.load()) return;
  writer->write(kLogStream, fmt::format("{} {}{}\n", system::local_time_text(), kind, text));
}

void write_directly(int fd, std::string_view text) {
  static std::mutex& mutex = *new std::mutex;  // never destroyed: threads may outlive main()
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
      writer->write(stream_index(to), text);
    } else {
      write_directly(to == OutputTo::out ? system::kStandardOutput : system::kStandardError, text);
    }
  } catch (...) {  // no memory for it
  }
}

void write_message(MessageLevel severity, std::string_view text, std::string_view prefix) noexcept {
  static const bool journal = system::standard_error_is_journal();
  try {
    write_log("", text);
    if (is_quiet.load() && severity == MessageLevel::info) return;
    write_line(OutputTo::error, journal ? journal_text(severity, text) : fmt::format("{}{}", prefix, text));
  } catch (...) {  // no memory for it
  }
}

void write_print(OutputTo to, std::string_view line) noexcept {
  try {
    write_log("print: ", line);
  } catch (...) {  // no memory for it
  }
  write_line(to, line);
}

void start_output(OutputSetup setup) {
  const OutputMode mode = setup.mode;
  std::vector<OutputStream> streams;
  streams.push_back(stream_of(OutputTo::out, mode));
  streams.push_back(stream_of(OutputTo::error, mode));
  has_log.store(setup.log != nullptr);
  if (setup.log != nullptr) streams.push_back(log_stream(std::move(setup.log), setup.log_name));
  is_quiet.store(setup.quiet);
  auto writer = std::make_unique<OutputWriter>(std::move(streams));
  if (!writer->start()) return;
  writer->detach();
  the_mode.store(mode);
  the_writer.store(writer.release(), std::memory_order_release);
}

void start_output(OutputMode mode) {
  OutputSetup setup;
  setup.mode = mode;
  start_output(std::move(setup));
}

bool output_is_live() {
  return the_writer.load(std::memory_order_acquire) != nullptr && the_mode.load() == OutputMode::live;
}

void begin_output_shutdown() {
  if (OutputWriter* const writer = the_writer.load(std::memory_order_acquire)) writer->begin_shutdown();
}

void finish_output() {
  OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  if (writer == nullptr) return;
  const bool live = the_mode.load() == OutputMode::live;
  (void)writer->drain(stream_index(OutputTo::out),
                      live ? std::optional<std::chrono::nanoseconds>(kExitTimeout) : std::nullopt);
  (void)writer->drain(stream_index(OutputTo::error), kExitTimeout);
  if (has_log.load()) (void)writer->drain(kLogStream, kExitTimeout);
}

std::uint64_t lost_output_lines() {
  const OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  if (writer == nullptr) return 0;
  const std::uint64_t lines = writer->lost(stream_index(OutputTo::out)) + writer->lost(stream_index(OutputTo::error));
  return lines + (has_log.load() ? writer->lost(kLogStream) : 0);
}

bool write_result(std::string_view text) noexcept {
  if (the_result_error.load() != 0) return false;
  OutputWriter* const writer = the_writer.load(std::memory_order_acquire);
  if (writer != nullptr) {  // both may be the same file
    (void)writer->drain(stream_index(OutputTo::error), kExitTimeout);
    (void)writer->drain(stream_index(OutputTo::out), std::nullopt);
  }
  std::optional<std::chrono::steady_clock::time_point> end;
  while (!text.empty()) {
    const system::Written written = system::write_within(system::kStandardOutput, text, kResultPollInterval);
    text.remove_prefix(written.count);
    if (written.count > 0) continue;
    const auto now = std::chrono::steady_clock::now();
    if (!end && ((writer != nullptr && writer->shutting_down()) || system::termination_is_pending()))
      end = now + kResultGrace;
    const int error = written.error == EAGAIN && end && now > *end ? ETIMEDOUT : written.error;
    if (error == EAGAIN) continue;
    the_result_error.store(error);
    return false;
  }
  return true;
}

int result_error() { return the_result_error.load(); }

}  // namespace limber
