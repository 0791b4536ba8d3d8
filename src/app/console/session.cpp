// Sends requests, waits for the answers and prints them.
#include "app/console/session.h"

#include <utility>

#include <fmt/format.h>

#include "base/log/output.h"
#include "base/plural.h"

namespace limber::app {

namespace {

using Kind = console::ConsoleLine::Kind;

bool is_reply(Kind kind) { return kind >= Kind::done && kind <= Kind::names; }

}  // namespace

// Returns the reply; nullopt if the user canceled or the program has ended.
std::optional<console::ConsoleLine> ConsoleSession::send_request(console::ConsoleRequest request) {
  request.id = ++last_request_;
  if (!client_.send(request)) return {};
  while (true) {
    std::optional<console::ConsoleLine> line = client_.next(-1);
    if (line && line->id == last_request_ && is_reply(line->kind)) return line;
    if (line) {
      show(*line);
    } else if (client_.ended() || is_canceled_()) {
      return {};
    }
  }
}

ConsoleSession::EvaluationStatus ConsoleSession::evaluate(const std::string& text) {
  const std::optional<console::ConsoleLine> reply = send_request({0, console::ConsoleRequest::Kind::evaluate, text});
  if (!reply) return client_.ended() ? EvaluationStatus::program_ended : EvaluationStatus::canceled;
  if (reply->kind == Kind::incomplete) return EvaluationStatus::incomplete;
  show(*reply);
  return reply->kind == Kind::error ? EvaluationStatus::failed : EvaluationStatus::done;
}

std::vector<std::string> ConsoleSession::complete(const std::string& text, std::size_t& word) {
  std::optional<console::ConsoleLine> reply = send_request({0, console::ConsoleRequest::Kind::complete, text});
  if (!reply || reply->word > text.size()) return {};
  word = reply->word;
  return std::move(reply->names);
}

bool ConsoleSession::has_messages() {
  while (std::optional<console::ConsoleLine> line = client_.next(0)) messages_.push_back(std::move(*line));
  return !messages_.empty();
}

void ConsoleSession::show_messages() {
  for (const console::ConsoleLine& line : messages_) show(line);
  messages_.clear();
}

void ConsoleSession::show(const console::ConsoleLine& line) const {
  switch (line.kind) {
    case Kind::value:
      print_result("{}\n", line.text);
      break;
    case Kind::print:
      if (line.id == last_request_) {
        print_result("{}\n", line.text);
      } else {
        write_line(OutputTo::error, line.text);
      }
      break;
    case Kind::error:
    case Kind::rejected:
      write_line(OutputTo::error, line.text);
      break;
    case Kind::warning:
      print_notice("warning: {}", line.text);
      break;
    case Kind::fault:
      print_notice("error: {}", line.text);
      break;
    case Kind::missed:
      write_line(OutputTo::error, fmt::format("({} dropped: too much output)", counted(line.count, "line")));
      break;
    default:
      return;  // no output
  }
}

}  // namespace limber::app
