// The console's protocol: lines of JSON, one object each (docs/console.md). Both ends write and read them with these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/evaluation.h"
#include "base/log.h"
#include "base/result.h"

namespace limber {

/// Longest line of either side, bytes: the longest text with every byte escaped, and room for what stands around it.
inline constexpr std::size_t kMostLine = 8 * kMostEvaluated;

/// What a console asks for.
struct ConsoleRequest {
  enum class Wish : std::uint8_t {
    evaluate,
    complete,
    traffic,  ///< To be told of messages that come in and go out; `text`: of addresses that this pattern matches.
    changes,  ///< To be told of changed values; `text`: of what this pattern reaches, empty: of what hands set.
  };
  std::uint64_t id = 0;  ///< The console's own number, which the answer repeats.
  Wish wish = Wish::evaluate;
  std::string text;
};

/// What a program says. `id` is 0 in what answers nobody.
struct ConsoleLine {
  enum class Kind : std::uint8_t {
    hello,       ///< First of all: `text` is the scene, `version` and `pid` say who speaks.
    done,        ///< The answers, as in Evaluation.
    value,       //
    error,       //
    incomplete,  //
    names,       ///< `names`, `word`.
    print,       ///< A script printed `text`; with an id: while that request ran.
    warning,     ///< The log, in the same way.
    fault,       //
    missed,      ///< `count` lines of these three were too many.
    refused,     ///< `text` says why the connection ends.
    in,          ///< A message came: `text`, from `end`, at `time`.
    out,         ///< One went out to `end`.
    change,  ///< A value is another: `text` is its path, what it was and what it is; `end`: who set it, if a hand did.
  };
  Kind kind = Kind::done;
  std::uint64_t id = 0;
  std::string text;
  std::vector<std::string> names;
  std::size_t word = 0;
  std::uint64_t count = 0;
  std::string version;
  int pid = 0;
  std::string end;
  double time = 0;  ///< s, of a clock of the program's own.
};

/// Each with its line's end. Text from scripts has control characters escaped. [any]
std::string request_line(const ConsoleRequest& request);
std::string hello_line(std::string_view version, int pid, std::string_view scene);
std::string answer_line(std::uint64_t id, const Evaluation& said);
std::string log_line(std::uint64_t id, const LogLine& line);
std::string traffic_line(bool in, double time, std::string_view end, std::string_view text);
std::string change_line(double time, std::string_view who, std::string_view text);
std::string missed_line(std::uint64_t count);
std::string refused_line(std::string_view why);

/// A line without its end. Anything may stand in it; the error says what it should be. [any]
Result<ConsoleRequest> parse_request(std::string_view line);
Result<ConsoleLine> parse_line(std::string_view line);

}  // namespace limber
