// Selects the interactive terminal, one expression (-e), or lines from a pipe, and implements the last two.
#include "app/commands/commands.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/console/session.h"
#include "app/console/terminal.h"
#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/system/file.h"
#include "base/system/process.h"
#include "base/system/wait.h"
#include "base/text.h"

namespace limber::app {

namespace {

using EvaluationStatus = ConsoleSession::EvaluationStatus;

int evaluate_once(ConsoleSession& session, const std::string& text) {
  switch (session.evaluate(text)) {
    case EvaluationStatus::done:
      return kSuccess;
    case EvaluationStatus::incomplete:
      return fail(kInputError, "console: incomplete input: a block, bracket or string is not closed");
    case EvaluationStatus::program_ended:
      return fail(kInputError, "console: limber ended before it replied");
    default:
      return kInputError;
  }
}

// reads lines from a pipe and shows the program's own messages meanwhile
class PipeLines {
 public:
  explicit PipeLines(ConsoleSession& session) : session_(session) {}

  /// Returns false at the end of the pipe or of the program.
  bool next(std::string& line) {
    while (true) {
      const std::size_t end = in_.find('\n');
      if (end != std::string::npos || (at_end_ && !in_.empty())) {
        line = in_.substr(0, end);
        in_.erase(0, end == std::string::npos ? end : end + 1);
        if (line.ends_with('\r')) line.pop_back();
        return true;
      }
      if (at_end_ || session_.ended()) return false;
      wait();
    }
  }

 private:
  void wait() {
    system::PollEntry waiting[2] = {{.fd = system::kStandardInput}, {.fd = session_.fd()}};
    if (!system::wait_ready(waiting, std::nullopt)) return;
    if (waiting[1].ready && session_.has_messages()) session_.show_messages();
    if (!waiting[0].ready) return;
    char bytes[16384];
    const std::ptrdiff_t got = system::read_some(system::kStandardInput, bytes, sizeof bytes);
    if (got > 0) {
      in_.append(bytes, static_cast<std::size_t>(got));
    } else {
      at_end_ = true;
    }
  }

  ConsoleSession& session_;
  std::string in_;
  bool at_end_ = false;
};

// evaluates line by line; joins incomplete lines with the next
int evaluate_lines(ConsoleSession& session) {
  PipeLines lines(session);
  bool failed = false;
  std::string chunk;
  for (std::string line; lines.next(line);) {
    chunk += line;
    if (chunk.empty()) continue;
    const EvaluationStatus status = session.evaluate(chunk);
    if (result_error() != 0) return kSuccess;  // stdout is closed: the results have no reader
    if (status == EvaluationStatus::program_ended) return fail(kInputError, "console: limber ended before it replied");
    if (status == EvaluationStatus::incomplete) {
      chunk += '\n';
      continue;
    }
    failed = failed || status != EvaluationStatus::done;
    chunk.clear();
  }
  if (!chunk.empty())
    return fail(kInputError, "console: incomplete input at the end: a block, bracket or string is not closed");
  return failed ? kInputError : kSuccess;
}

}  // namespace

int console_command(const ConsoleCommand& command) {
  Result<console::ConnectedProgram> program = console::connect_to_program(command.pid);
  if (!program) return fail(kInputError, "console: " + program.error());
  const bool typed = system::at_terminal();
  if (!command.expression && typed) return console_terminal(std::move(*program));
  ConsoleSession session(std::move(program->client));
  return command.expression ? evaluate_once(session, *command.expression) : evaluate_lines(session);
}

}  // namespace limber::app
