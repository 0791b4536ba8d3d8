// Formats the messages of the console's socket for people.
#include "app/commands/commands.h"

#include <csignal>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/log/output.h"
#include "base/plural.h"
#include "base/system/signals.h"
#include "net/console/console_client.h"

namespace limber::app {

namespace {

using Kind = console::ConsoleLine::Kind;

volatile std::sig_atomic_t end_requested = 0;

void handle_end_signals() {
  for (const int number : {SIGINT, SIGTERM}) system::handle_signal(number, [](int) { end_requested = 1; });
}

// prints one line per message: seconds since the first, direction, sender or receiver
class MessagePrinter {
 public:
  explicit MessagePrinter(const MonitorCommand& command) : command_(command) {}

  /// Returns false after the last line (--count).
  bool show(const console::ConsoleLine& line) {
    if (line.kind == Kind::missed)
      write_line(OutputTo::error, fmt::format("({} dropped: too many messages)", counted(line.count, "line")));
    const bool message = line.kind == Kind::in || line.kind == Kind::out;
    if (!message && line.kind != Kind::change) return true;
    if ((command_.only_in && line.kind == Kind::out) || (command_.only_out && line.kind == Kind::in)) return true;
    if (begin_ == 0) begin_ = line.time;
    const char* const direction = line.kind == Kind::in ? "<" : line.kind == Kind::out ? ">" : "=";
    const std::string_view peer = line.origin.empty() ? std::string_view("the show") : line.origin;
    print_result("{:9.3f} {} {:<21} {}\n", line.time - begin_, direction, peer, line.text);
    return !command_.count || ++shown_ < *command_.count;
  }

 private:
  const MonitorCommand& command_;
  double begin_ = 0;
  std::uint64_t shown_ = 0;
};

}  // namespace

int monitor_command(const MonitorCommand& command) {
  Result<console::ConnectedProgram> program = console::connect_to_program(command.pid);
  if (!program) return fail(kInputError, "monitor: " + program.error());
  auto& [client, hello] = *program;
  handle_end_signals();
  const auto kind = command.changes ? console::ConsoleRequest::Kind::changes : console::ConsoleRequest::Kind::traffic;
  if (!client.send({1, kind, command.pattern})) return fail(kInputError, "monitor: limber ended");
  MessagePrinter printer(command);
  while (end_requested == 0) {
    const std::optional<console::ConsoleLine> line = client.next(-1);
    if (!line) {
      if (client.ended() || result_error() != 0) return kSuccess;
      continue;
    }
    if (line->kind == Kind::error || line->kind == Kind::rejected) return fail(kInputError, "monitor: " + line->text);
    if (line->kind == Kind::done && line->id == 1)
      print_notice("watching {} of {} ({})", command.changes ? "changes" : "messages in (<) and out (>)", hello.pid,
                   hello.text);
    if (!printer.show(*line) || result_error() != 0) return kSuccess;
  }
  return kSuccess;
}

}  // namespace limber::app
