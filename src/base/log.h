// The log: lines to standard error, and the last thousand kept in a ring for the panel and consoles, with what scripts
// print. The ring gets every line; standard error gets ten of each source, then one a minute (LogThrottle),
// and in a show (OutputMode::live) all sources together 2000 lines at once and two a second.
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
  print,  ///< What a script printed: in the ring only, in the order of all that was said.
};

struct LogLine {
  std::uint64_t number = 0;  ///< Counts from 1 over the run, so that a reader knows what it has seen.
  LogLevel level = LogLevel::info;
  std::string text;
};

/// Writes one line to stderr and to the ring, `print` to the ring alone. Control characters are shown escaped; the ring
/// keeps the beginning and the end of a line of more than 4 KiB. `source`: the place that the line is about
/// ("scene.lua:12"); empty: log_source() of the text. [any]
void log_line(LogLevel level, std::string_view text, std::string_view source = {});

/// Writes a line that a script printed: unchanged to `to`, and to the ring. In a show (OutputMode::live), `to` gets at
/// most 2000 lines at once and 200 a second. [any]
void log_print(std::string_view text, OutputTo to);
inline constexpr int kMostPrintedAtOnce = 2000;
inline constexpr int kMostPrintedPerSecond = 200;

/// A file of the scene was saved: its faults are new, and are written even if they repeat themselves. [any]
void log_forget_sources();
/// Lines that `to` and stderr did not get because their source repeats itself. [any]
std::uint64_t log_left_out();

/// The lines after `seen`, oldest first; at most the last 1000. [any]
std::vector<LogLine> log_since(std::uint64_t seen);

/// The number of the newest line; 0 before the first. [any]
std::uint64_t log_newest();

/// How many warnings and errors were said so far: `--strict` and tests ask. [any]
std::uint64_t log_count(LogLevel level);

/// Behind a file's name: its faults that were said before are no more.
inline constexpr std::string_view kMended = ": mended";

/// Silences stderr (the ring still hears): for tests and `--quiet`. [any]
void log_to_stderr(bool on);

/// While one lives, this thread says nothing.
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
