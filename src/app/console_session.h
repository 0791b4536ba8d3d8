// ConsoleSession: what a console asks and shows, whoever types. Values, and what the asked text printed, go to stdout;
// errors and what the program says by itself go to stderr, so that a pipe gets what it asked for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "console/console_link.h"

namespace limber {

class ConsoleSession {
 public:
  enum class Answer : std::uint8_t {
    done,
    failed,      ///< The error was shown.
    incomplete,  ///< Nothing was run: more lines may make it whole.
    left,        ///< It was given up while the answer was awaited.
    ended,       ///< The program has ended.
  };

  /// `given_up` is asked after a signal: whether the person wants no answer any more.
  explicit ConsoleSession(
      ConsoleLink link, std::function<bool()> given_up = [] { return false; })
      : link_(std::move(link)), given_up_(std::move(given_up)) {}

  int fd() const { return link_.fd(); }
  bool ended() const { return link_.ended(); }
  /// Evaluates, and shows what comes of it.
  Answer evaluate(const std::string& text);
  /// Words that may stand at the end of a text; `word` gets how many bytes of it they replace.
  std::vector<std::string> complete(const std::string& text, std::size_t& word);
  /// Whether the program has said something by itself.
  bool has_news();
  void show_news();

 private:
  std::optional<ConsoleLine> ask(ConsoleRequest request);
  void show(const ConsoleLine& line) const;

  ConsoleLink link_;
  std::function<bool()> given_up_;
  std::uint64_t asked_ = 0;
  std::vector<ConsoleLine> news_;
};

}  // namespace limber
