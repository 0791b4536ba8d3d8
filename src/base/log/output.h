// Output: all text that the program writes to standard output, standard error and the log file. Nothing here throws.
//
// Messages (the log, notices, scripts' print()) are queued after start_output(). In live mode they never block the
// simulation, and are dropped and counted if a device does not accept them; in batch mode it waits
// (OutputMode). Results of commands (write_result()) are never dropped.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace limber {

enum class OutputTo : std::uint8_t { out, error };  ///< Standard output, standard error.

/// Writes a line. Before start_output() this blocks until the device accepts it; errors are ignored. [any]
void write_line(OutputTo to, std::string_view line) noexcept;

/// Severity levels as in syslog and systemd's journal.
enum class MessageLevel : std::uint8_t { error = 3, warning = 4, info = 6 };

/// Writes a message with the prefix to standard error, and to the log file. If standard error is systemd's journal,
/// each line gets the level instead of the prefix. [any]
void write_message(MessageLevel severity, std::string_view text, std::string_view prefix = "limber: ") noexcept;
/// Formats a notice and writes it with write_message(). [any]
template <class... A>
void print_notice(fmt::format_string<A...> f, A&&... a) noexcept {
  try {
    write_message(MessageLevel::info, fmt::format(f, std::forward<A>(a)...));
  } catch (...) {  // no memory for it
  }
}
/// Writes a line of a script's print(), also to the log file. [any]
void write_print(OutputTo to, std::string_view line) noexcept;

enum class OutputMode : std::uint8_t {
  live,   ///< Never blocks: text that a device does not accept in time is dropped and counted.
  batch,  ///< Waits for standard output, and up to a second for standard error.
};
class OutputDevice;
struct OutputSetup {
  OutputMode mode = OutputMode::live;
  bool quiet = false;                 ///< Messages to standard error are warnings and errors only.
  std::unique_ptr<OutputDevice> log;  ///< Gets every message with its time; may be null.
  std::string log_name;               ///< Name of the log for messages.
};
/// Starts a thread that writes the queued text. Call system::block_signals() first. If no thread can be started, text
/// is written directly as before. [main, once]
void start_output(OutputSetup setup);
void start_output(OutputMode mode);
bool output_is_live();
/// Limits further waits for a device to half a second. Called when the program was asked to exit. [any]
void begin_output_shutdown();
/// Waits until the queued text is written, as long as the devices accept it. [main, at the end]
void finish_output();
/// Returns the number of dropped lines so far. [any]
std::uint64_t lost_output_lines();

/// Writes a command's result to standard output, after the queued text, and waits until it is written or a signal ends
/// the program. False if it was not written; later results fail too (see result_error()). [main]
bool write_result(std::string_view text) noexcept;
template <class... A>
bool print_result(fmt::format_string<A...> f, A&&... a) {
  return write_result(fmt::format(f, std::forward<A>(a)...));
}
/// Returns the errno of the first result that was not written, 0 if there is none. ETIMEDOUT: nothing read the result
/// until the program ended. [main]
int result_error();

}  // namespace limber
