// Which of the three ways, and the two that need no terminal.
#include "app/console.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/console_session.h"
#include "app/console_terminal.h"
#include "app/exit_code.h"
#include "base/output.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber {

namespace {

using Answer = ConsoleSession::Answer;

int evaluate_once(ConsoleSession& session, const std::string& text) {
  switch (session.evaluate(text)) {
    case Answer::done:
      return kFine;
    case Answer::incomplete:
      return fail(kInput, "console: the text is not complete: something that it opens is never closed");
    case Answer::ended:
      return fail(kInput, "console: limber ended before it answered");
    default:
      return kInput;
  }
}

// lines of a pipe, while what the program says by itself is shown
class PipeLines {
 public:
  explicit PipeLines(ConsoleSession& session) : session_(session) {}

  /// False at the end, of the pipe or of the program.
  bool next(std::string& line) {
    while (true) {
      const std::size_t end = in_.find('\n');
      if (end != std::string::npos || (over_ && !in_.empty())) {
        line = in_.substr(0, end);
        in_.erase(0, end == std::string::npos ? end : end + 1);
        if (line.ends_with('\r')) line.pop_back();
        return true;
      }
      if (over_ || session_.ended()) return false;
      wait();
    }
  }

 private:
  void wait() {
    system::Waiting waiting[2] = {{.fd = system::kStandardInput}, {.fd = session_.fd()}};
    if (!system::wait_ready(waiting, std::nullopt)) return;
    if (waiting[1].ready && session_.has_news()) session_.show_news();
    if (!waiting[0].ready) return;
    char bytes[16384];
    const std::ptrdiff_t got = system::read_some(system::kStandardInput, bytes, sizeof bytes);
    if (got > 0) {
      in_.append(bytes, static_cast<std::size_t>(got));
    } else {
      over_ = true;
    }
  }

  ConsoleSession& session_;
  std::string in_;
  bool over_ = false;
};

// one evaluation a line; lines that are not whole are joined with the next
int evaluate_lines(ConsoleSession& session) {
  PipeLines lines(session);
  bool failed = false;
  std::string chunk;
  for (std::string line; lines.next(line);) {
    chunk += line;
    if (chunk.empty()) continue;
    const Answer answer = session.evaluate(chunk);
    if (result_error() != 0) return kFine;  // its answers go nowhere
    if (answer == Answer::ended) return fail(kInput, "console: limber ended before it answered");
    if (answer == Answer::incomplete) {
      chunk += '\n';
      continue;
    }
    failed = failed || answer != Answer::done;
    chunk.clear();
  }
  if (!chunk.empty())
    return fail(kInput, "console: the input ends in the middle: something that it opens is never closed");
  return failed ? kInput : kFine;
}

}  // namespace

int console_command(const ConsoleCommand& command) {
  ConsoleLine hello;
  Result<ConsoleLink> link = choose_program(command.pid, hello);
  if (!link) return fail(kInput, "console: " + link.error());
  const bool typed = system::at_terminal();
  if (!command.expression && typed) return console_terminal(std::move(*link), hello);
  ConsoleSession session(std::move(*link));
  return command.expression ? evaluate_once(session, *command.expression) : evaluate_lines(session);
}

}  // namespace limber
