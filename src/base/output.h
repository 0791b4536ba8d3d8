// Output: all text that the program writes for people, and the results of its commands. Nothing here throws.
//
// Text for people (the log, notices, what scripts print) never holds a show up: after start_output() it is queued, and
// lost and counted where a device does not take it. Results (write_result) are never dropped.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace limber {

enum class OutputTo : std::uint8_t { out, error };  ///< Standard output, standard error.

/// Writes a line. Before start_output() this thread waits for the device; a failure is ignored. [any]
void write_line(OutputTo to, std::string_view line) noexcept;

/// The levels of syslog and of systemd's journal.
enum class MessageLevel : std::uint8_t { error = 3, warning = 4, info = 6 };

/// Writes a message to standard error, with the prefix, and to the log file. Where standard error is systemd's journal,
/// each of its lines has the level in front instead. [any]
void write_message(MessageLevel severity, std::string_view text, std::string_view prefix = "limber: ") noexcept;
template <class... A>
void print_notice(fmt::format_string<A...> f, A&&... a) noexcept {
  try {
    write_message(MessageLevel::info, fmt::format(f, std::forward<A>(a)...));
  } catch (...) {  // no memory for it
  }
}
/// Writes a line that a script printed, to the log file too. [any]
void write_print(OutputTo to, std::string_view line) noexcept;

enum class OutputMode : std::uint8_t {
  live,   ///< A show: what a device does not take in time is lost and counted.
  batch,  ///< Nobody watches: standard output is waited for, standard error for up to a second.
};
class OutputDevice;
struct OutputSetup {
  OutputMode mode = OutputMode::live;
  bool quiet = false;                 ///< Messages to standard error are warnings and errors only.
  std::unique_ptr<OutputDevice> log;  ///< Gets every message, with its time; null: none.
  std::string log_name;               ///< For messages about it.
};
/// From here on a thread of its own writes the text for people. Signals are blocked (system::block_signals). Without a
/// thread left, text is written as before. [main, once]
void start_output(OutputSetup setup);
void start_output(OutputMode mode);
bool output_is_live();
/// Somebody has asked the program to end: from here on, no device is waited for longer than half a second. [any]
void hurry_output();
/// Waits for the text that is queued, as long as the devices take it. [main, at the end]
void finish_output();
/// Lines for people that were not written so far. [any]
std::uint64_t lost_output_lines();

/// Writes a command's result, behind the text that is queued for standard output, and waits for it until a signal that
/// ends the program. False: it is not written, and later ones won't be (result_error). [main]
bool write_result(std::string_view text) noexcept;
template <class... A>
bool print_result(fmt::format_string<A...> f, A&&... a) {
  return write_result(fmt::format(f, std::forward<A>(a)...));
}
/// The errno of the first result that was not written; ETIMEDOUT: nothing read it when the program ended; 0: none.
/// [main]
int result_error();

}  // namespace limber
