// The log: writes messages to standard error and keeps the last 1000 in a ring buffer for the panel and consoles,
// together with the output of scripts' print(). The ring gets every line. Standard error gets ten lines of each source,
// then one a minute (LogThrottle); in live mode (OutputMode::live), all sources together get at most 2000 lines at once
// and two a second.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace limber {

enum class OutputTo : std::uint8_t;

enum class LogLevel : std::uint8_t {
  info,
  warning,
  error,
  print,  ///< Output of a script's print(); goes to the ring only.
};

struct LogLine {
  std::uint64_t number = 0;  ///< Counts from 1 over the run, so that readers can ask for newer lines.
  LogLevel level = LogLevel::info;
  std::string text;
};

/// Writes one line to stderr and to the ring; level `print` goes to the ring only. Control characters are escaped; the
/// ring stores the beginning and the end of a line longer than 4 KiB. `source`: the place that the line is about
/// ("scene.lua:12"), for rate limiting; if empty, log_source() of the text. [any]
void log_line(LogLevel level, std::string_view text, std::string_view source = {});

/// Writes a line of a script's print(): unchanged to `to`, and to the ring. In live mode (OutputMode::live), `to` gets
/// at most 2000 lines at once and 200 a second. [any]
void log_print(std::string_view text, OutputTo to);
inline constexpr int kMaxPrintBurst = 2000;
inline constexpr int kMaxPrintsPerSecond = 200;

/// Resets the rate limits of all sources. Called when a scene file was saved, since its errors are new then. [any]
void log_forget_sources();
/// Returns the number of lines that the rate limits suppressed. [any]
std::uint64_t log_suppressed();

/// Returns the lines after number `seen`, oldest first, at most the last 1000. [any]
std::vector<LogLine> log_since(std::uint64_t seen);

/// Returns the number of the newest line, 0 before the first. [any]
std::uint64_t log_newest();

/// Returns the number of lines of that level so far, for `--strict` and tests. [any]
std::uint64_t log_count(LogLevel level);

/// Follows a file's name in the message that its earlier errors are resolved.
inline constexpr std::string_view kResolvedSuffix = ": errors resolved";

/// Enables or disables output to stderr, for tests and `--quiet`. The ring still gets all lines. [any]
void log_to_stderr(bool on);

/// While an object of this class exists, this thread neither logs nor prints.
class LogSilence {
 public:
  LogSilence();
  ~LogSilence();
  LogSilence(const LogSilence&) = delete;
  LogSilence& operator=(const LogSilence&) = delete;
};

template <class... A>
void log_info(fmt::format_string<A...> f, A&&... a) {
  log_line(LogLevel::info, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void log_warning(fmt::format_string<A...> f, A&&... a) {
  log_line(LogLevel::warning, fmt::format(f, std::forward<A>(a)...));
}
template <class... A>
void log_error(fmt::format_string<A...> f, A&&... a) {
  log_line(LogLevel::error, fmt::format(f, std::forward<A>(a)...));
}

}  // namespace limber
