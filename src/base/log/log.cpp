// The ring buffer of log lines, and the rate-limited output to stderr.
#include "base/log/log.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "base/hash.h"
#include "base/log/log_sink.h"
#include "base/log/log_throttle.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kRingSize = 1000;
constexpr std::size_t kMaxLineBytes = 4096;  // maximum length of a line in the ring, bytes

struct Log {
  std::mutex mutex;
  std::array<LogLine, kRingSize> ring;
  std::uint64_t count = 0;
  std::array<std::uint64_t, 4> per_level{};
  bool to_stderr = true;
  LogThrottle throttle;
  TokenBucket printed{kMaxPrintBurst, 1'000'000'000 / kMaxPrintsPerSecond};
  std::uint64_t suppressed_prints = 0;       // total
  std::uint64_t suppressed_since_print = 0;  // since the last line that was printed
};

thread_local int silence_depth = 0;
thread_local LogSink* sink_of_thread = nullptr;

// Never destroyed, because threads that still run when the program exits may write.
Log& the_log() {
  static Log& log = *new Log;
  return log;
}

std::int64_t log_time() { return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1); }

void add_to_ring(Log& log, LogLevel level, std::string_view shown) {
  log.count++;
  log.per_level[static_cast<std::size_t>(level)]++;
  log.ring[log.count % kRingSize] = {log.count, level, shortened(shown, kMaxLineBytes)};
}

}  // namespace

LogSilence::LogSilence() { silence_depth++; }
LogSilence::~LogSilence() { silence_depth--; }

LogSink::Scope::Scope(LogSink& sink) : previous_(std::exchange(sink_of_thread, &sink)) {}
LogSink::Scope::~Scope() { sink_of_thread = previous_; }

void log_line(LogLevel level, std::string_view text, std::string_view source) {
  if (silence_depth > 0) return;
  const std::string shown = printable(text);
  if (sink_of_thread != nullptr) return sink_of_thread->add(level, shown);
  const auto level_index = static_cast<unsigned char>(level);
  const std::uint64_t hash = (source.empty() ? log_source(shown) : hash_bytes(source)) ^ level_index;
  Log& log = the_log();
  std::optional<std::uint64_t> suppressed;
  {
    const std::scoped_lock lock(log.mutex);
    add_to_ring(log, level, shown);
    if (!log.to_stderr || level == LogLevel::print) return;
    suppressed = log.throttle.admit(hash, log_time(), output_is_live());
  }
  if (!suppressed) return;
  const bool is_error = level == LogLevel::error;
  const char* label = is_error ? "error: " : level == LogLevel::warning ? "warning: " : "";
  const MessageLevel severity = is_error                     ? MessageLevel::error
                                : level == LogLevel::warning ? MessageLevel::warning
                                                             : MessageLevel::info;
  const std::string more = *suppressed > 0 ? fmt::format(" (and {} more since the last one)", *suppressed) : "";
  write_message(severity, fmt::format("{}{}{}", label, shown, more));
}

void log_print(std::string_view text, OutputTo to) {
  if (silence_depth > 0) return;
  if (sink_of_thread != nullptr) return sink_of_thread->add(LogLevel::print, text);
  const std::string shown = printable(text);
  Log& log = the_log();
  std::uint64_t missing = 0;
  {
    const std::scoped_lock lock(log.mutex);
    add_to_ring(log, LogLevel::print, shown);
    if (output_is_live() && !log.printed.try_consume(log_time())) {
      log.suppressed_prints++;
      log.suppressed_since_print++;
      return;
    }
    missing = std::exchange(log.suppressed_since_print, 0);
  }
  if (missing > 0)
    log_warning("print: {} dropped; at most {} per second are printed", counted(missing, "line was", "lines were"),
                kMaxPrintsPerSecond);
  write_print(to, text);
}

void log_forget_sources() {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  log.throttle.forget_sources();
}

std::uint64_t log_suppressed() {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  return log.throttle.suppressed() + log.suppressed_prints;
}

std::vector<LogLine> log_since(std::uint64_t seen) {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  const std::uint64_t oldest = log.count > kRingSize ? log.count - kRingSize : 0;
  std::vector<LogLine> lines;
  for (std::uint64_t i = std::max(seen, oldest) + 1; i <= log.count; i++) lines.push_back(log.ring[i % kRingSize]);
  return lines;
}

std::uint64_t log_newest() {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  return log.count;
}

std::uint64_t log_count(LogLevel level) {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  return log.per_level[static_cast<std::size_t>(level)];
}

void log_to_stderr(bool on) {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  log.to_stderr = on;
}

}  // namespace limber
