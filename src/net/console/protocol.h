// The console protocol: one JSON object per line (docs/howto/console.md), written and parsed here for both ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/evaluation.h"
#include "base/log/log.h"
#include "base/result.h"

namespace limber::console {

/// Longest line that either side accepts, bytes: the longest text with every byte escaped, plus the JSON around it.
inline constexpr std::size_t kMaxLine = 8 * kMaxEvaluatedBytes;

/// A request from a console.
struct ConsoleRequest {
  enum class Kind : std::uint8_t {
    evaluate,
    complete,
    traffic,  ///< Subscribe to incoming and outgoing messages; `text`: an address pattern, empty for all.
    changes,  ///< Subscribe to changed values; `text`: a pattern, empty for all values set by controllers.
  };
  std::uint64_t id = 0;  ///< Chosen by the console; repeated in the answer.
  Kind kind = Kind::evaluate;
  std::string text;
};

/// A line from the program. `id` is 0 in lines that do not answer a request.
struct ConsoleLine {
  enum class Kind : std::uint8_t {
    hello,       ///< First line: `text` is the scene; `version` and `pid` identify the program.
    done,        ///< Results of a request, as in Evaluation.
    value,       ///< Result of an expression: `text`.
    error,       ///< The request failed: `text`.
    incomplete,  ///< The request's text is an incomplete statement.
    names,       ///< Completions: `names`, `word`.
    print,       ///< A script printed `text`; `id` is the request that was running, if any.
    warning,     ///< A log line; `id` as for print.
    fault,       ///< An error of a script; `id` as for print.
    missed,      ///< `count` lines were dropped because the console did not read them in time.
    rejected,    ///< The connection is about to close; `text` is the reason.
    in,          ///< A message arrived from `origin` at `time`: `text`.
    out,         ///< A message was sent to `origin`.
    change,      ///< A value changed: `text` has path, old and new value; `origin`: the controller that set it, if any.
  };
  Kind kind = Kind::done;
  std::uint64_t id = 0;
  std::string text;
  std::vector<std::string> names;
  std::size_t word = 0;  ///< Number of bytes at the end of the text that a completion replaces.
  std::uint64_t count = 0;
  std::string version;
  int pid = 0;
  std::string origin;  ///< The other end of a message, or the controller that set a value.
  double time = 0;     ///< Seconds on the program's monotonic clock.
};

/// Each function returns one line with its line feed. Control characters in text from scripts are escaped. [any]
std::string request_line(const ConsoleRequest& request);
std::string hello_line(std::string_view version, int pid, std::string_view scene);
std::string result_line(std::uint64_t id, const Evaluation& result);
std::string log_line(std::uint64_t id, const LogLine& line);
std::string traffic_line(bool in, double time, std::string_view peer, std::string_view text);
std::string change_line(double time, std::string_view source, std::string_view text);
std::string missed_line(std::uint64_t count);
std::string rejected_line(std::string_view reason);

/// Parses one line without its line feed. The input is untrusted; the error describes the expected form. [any]
Result<ConsoleRequest> parse_request(std::string_view line);
Result<ConsoleLine> parse_line(std::string_view line);

}  // namespace limber::console
