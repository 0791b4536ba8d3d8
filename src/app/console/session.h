// ConsoleSession: evaluates text in a running program and shows the results, for all front ends of the console. Values
// and the output of the evaluated text go to stdout; errors and messages that the program prints on its own go to
// stderr, so that a pipe receives only results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "net/console/console_client.h"

namespace limber::app {

/// [main]
class ConsoleSession {
 public:
  /// Outcome of an evaluation.
  enum class EvaluationStatus : std::uint8_t {
    done,
    failed,         ///< The error was shown.
    incomplete,     ///< Nothing was evaluated: the text needs more lines.
    canceled,       ///< The user canceled the evaluation while waiting for its result.
    program_ended,  ///< The program has ended.
  };

  /// `is_canceled` is called after a signal; it returns true if the user no longer waits for the answer.
  explicit ConsoleSession(
      console::ConsoleClient client, std::function<bool()> is_canceled = [] { return false; })
      : client_(std::move(client)), is_canceled_(std::move(is_canceled)) {}

  int fd() const { return client_.fd(); }
  bool ended() const { return client_.ended(); }
  /// Evaluates the text and shows the result.
  EvaluationStatus evaluate(const std::string& text);
  /// Returns the possible completions of the last word of `text`; sets `word` to the length of that word in bytes.
  std::vector<std::string> complete(const std::string& text, std::size_t& word);
  /// True if the program has printed messages on its own.
  bool has_messages();
  void show_messages();

 private:
  std::optional<console::ConsoleLine> send_request(console::ConsoleRequest request);
  void show(const console::ConsoleLine& line) const;

  console::ConsoleClient client_;
  std::function<bool()> is_canceled_;
  std::uint64_t last_request_ = 0;
  std::vector<console::ConsoleLine> messages_;
};

}  // namespace limber::app
