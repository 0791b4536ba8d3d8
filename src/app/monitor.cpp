// Lines of the console's socket, as a person reads them.
#include "app/monitor.h"

#include <csignal>

#include <fmt/format.h>

#include "app/exit_code.h"
#include "base/output.h"
#include "base/system/signals.h"
#include "console/console_link.h"

namespace limber {

namespace {

using Kind = ConsoleLine::Kind;

volatile std::sig_atomic_t told_to_end = 0;

void end_at_a_signal() {
  for (const int number : {SIGINT, SIGTERM}) system::handle_signal(number, [](int) { told_to_end = 1; });
}

// a line at a time: seconds since the beginning, which way, who
class Paper {
 public:
  explicit Paper(const MonitorCommand& command) : command_(command) {}

  /// False: that was the last one.
  bool show(const ConsoleLine& line) {
    if (line.kind == Kind::missed)
      write_line(OutputTo::error, fmt::format("({} lines are left out here: too much is going on)", line.count));
    const bool message = line.kind == Kind::in || line.kind == Kind::out;
    if (!message && line.kind != Kind::change) return true;
    if ((command_.only_in && line.kind == Kind::out) || (command_.only_out && line.kind == Kind::in)) return true;
    if (begin_ == 0) begin_ = line.time;
    const char* const way = line.kind == Kind::in ? "<" : line.kind == Kind::out ? ">" : "=";
    const std::string_view who = line.end.empty() ? std::string_view("the show") : line.end;
    print_result("{:9.3f} {} {:<21} {}\n", line.time - begin_, way, who, line.text);
    return !command_.count || ++shown_ < *command_.count;
  }

 private:
  const MonitorCommand& command_;
  double begin_ = 0;
  std::uint64_t shown_ = 0;
};

}  // namespace

int monitor_command(const MonitorCommand& command) {
  ConsoleLine hello;
  Result<ConsoleLink> link = choose_program(command.pid, hello);
  if (!link) return fail(kInput, "monitor: " + link.error());
  end_at_a_signal();
  const auto wish = command.changes ? ConsoleRequest::Wish::changes : ConsoleRequest::Wish::traffic;
  if (!link->send({1, wish, command.pattern})) return fail(kInput, "monitor: limber ended");
  Paper paper(command);
  while (told_to_end == 0) {
    const std::optional<ConsoleLine> line = link->next(-1);
    if (line && line->kind == Kind::error) return fail(kInput, "monitor: " + line->text);
    if (line && line->kind == Kind::refused) return fail(kInput, "monitor: " + line->text);
    if (line && line->kind == Kind::done && line->id == 1)
      print_notice("watching {} of {} ({})", command.changes ? "changes" : "what goes in (<) and out (>)", hello.pid,
                   hello.text);
    if ((line && !paper.show(*line)) || result_error() != 0) return kFine;
    if (!line && link->ended()) return kFine;
  }
  return kFine;
}

}  // namespace limber
