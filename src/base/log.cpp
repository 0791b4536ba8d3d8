// The log's ring and its line to stderr.
#include "base/log.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "base/hash.h"
#include "base/log_throttle.h"
#include "base/output.h"
#include "base/text.h"

namespace limber {

namespace {

constexpr std::size_t kRing = 1000;
constexpr std::size_t kMostText = 4096;  // of a line in the ring, bytes

struct Log {
  std::mutex mutex;
  std::array<LogLine, kRing> ring;
  std::uint64_t count = 0;
  std::array<std::uint64_t, 4> per_level{};
  bool to_stderr = true;
  LogThrottle throttle;
  TokenBucket printed{kMostPrintedAtOnce, 1'000'000'000 / kMostPrintedPerSecond};
  std::uint64_t unprinted = 0;         // in all
  std::uint64_t unprinted_lately = 0;  // since the last line that was printed
};

thread_local int silences = 0;

// never destroyed: threads that are still there when the program ends may write
Log& the_log() {
  static Log& log = *new Log;
  return log;
}

std::int64_t log_time() { return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1); }

void add_to_ring(Log& log, LogLevel level, std::string_view shown) {
  log.count++;
  log.per_level[static_cast<std::size_t>(level)]++;
  log.ring[log.count % kRing] = {log.count, level, shortened(shown, kMostText)};
}

}  // namespace

LogSilence::LogSilence() { silences++; }
LogSilence::~LogSilence() { silences--; }

void log_line(LogLevel level, std::string_view text, std::string_view source) {
  if (silences > 0) return;
  const std::string shown = printable(text);
  const auto of = static_cast<unsigned char>(level);
  const std::uint64_t hash = (source.empty() ? log_source(shown) : hash_bytes(source)) ^ of;
  Log& log = the_log();
  std::optional<std::uint64_t> silent;
  {
    const std::scoped_lock lock(log.mutex);
    add_to_ring(log, level, shown);
    if (!log.to_stderr || level == LogLevel::print) return;
    silent = log.throttle.ask(hash, log_time(), output_is_live());
  }
  if (!silent) return;
  const bool fault = level == LogLevel::error;
  const char* mark = fault ? "error: " : level == LogLevel::warning ? "warning: " : "";
  const MessageLevel severity = fault                        ? MessageLevel::error
                                : level == LogLevel::warning ? MessageLevel::warning
                                                             : MessageLevel::info;
  const std::string more = *silent > 0 ? fmt::format(" (and {} more since the last one)", *silent) : "";
  write_message(severity, fmt::format("{}{}{}", mark, shown, more));
}

void log_print(std::string_view text, OutputTo to) {
  const std::string shown = printable(text);
  Log& log = the_log();
  std::uint64_t missing = 0;
  {
    const std::scoped_lock lock(log.mutex);
    if (silences == 0) add_to_ring(log, LogLevel::print, shown);
    if (output_is_live() && !log.printed.spend(log_time())) {
      log.unprinted++;
      log.unprinted_lately++;
      return;
    }
    missing = std::exchange(log.unprinted_lately, 0);
  }
  if (missing > 0)
    log_warning("print: {} line{} left out; at most {} a second are printed", missing, missing == 1 ? " is" : "s are",
                kMostPrintedPerSecond);
  write_print(to, text);
}

void log_forget_sources() {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  log.throttle.forget_sources();
}

std::uint64_t log_left_out() {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  return log.throttle.left_out() + log.unprinted;
}

std::vector<LogLine> log_since(std::uint64_t seen) {
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  const std::uint64_t oldest = log.count > kRing ? log.count - kRing : 0;
  std::vector<LogLine> lines;
  for (std::uint64_t i = std::max(seen, oldest) + 1; i <= log.count; i++) lines.push_back(log.ring[i % kRing]);
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
