// The log's ring and its line to stderr.
#include "base/log.h"

#include <array>
#include <cstdio>
#include <mutex>

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
};

thread_local int silences = 0;

Log& the_log() {
  static Log log;
  return log;
}

}  // namespace

LogSilence::LogSilence() { silences++; }
LogSilence::~LogSilence() { silences--; }

void log_line(LogLevel level, std::string_view text) {
  if (silences > 0) return;
  const std::string shown = printable(text);
  Log& log = the_log();
  const std::scoped_lock lock(log.mutex);
  log.count++;
  log.per_level[static_cast<std::size_t>(level)]++;
  log.ring[log.count % kRing] = {log.count, level, shortened(shown, kMostText)};
  if (!log.to_stderr || level == LogLevel::print) return;
  const char* mark = level == LogLevel::error ? "error: " : level == LogLevel::warning ? "warning: " : "";
  std::fprintf(stderr, "limber: %s%s\n", mark, shown.c_str());
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
