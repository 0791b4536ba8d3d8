// Asking, waiting for the answer, showing.
#include "app/console_session.h"

#include <utility>

#include <fmt/format.h>

#include "base/output.h"

namespace limber {

namespace {

using Kind = ConsoleLine::Kind;

bool is_answer(Kind kind) { return kind >= Kind::done && kind <= Kind::names; }

}  // namespace

// the answer; nothing when it was given up or the program has ended
std::optional<ConsoleLine> ConsoleSession::ask(ConsoleRequest request) {
  request.id = ++asked_;
  if (!link_.send(request)) return {};
  while (true) {
    std::optional<ConsoleLine> line = link_.next(-1);
    if (line && line->id == asked_ && is_answer(line->kind)) return line;
    if (line) {
      show(*line);
    } else if (link_.ended() || given_up_()) {
      return {};
    }
  }
}

ConsoleSession::Answer ConsoleSession::evaluate(const std::string& text) {
  const std::optional<ConsoleLine> answer = ask({0, ConsoleRequest::Wish::evaluate, text});
  if (!answer) return link_.ended() ? Answer::ended : Answer::left;
  if (answer->kind == Kind::incomplete) return Answer::incomplete;
  show(*answer);
  return answer->kind == Kind::error ? Answer::failed : Answer::done;
}

std::vector<std::string> ConsoleSession::complete(const std::string& text, std::size_t& word) {
  std::optional<ConsoleLine> answer = ask({0, ConsoleRequest::Wish::complete, text});
  if (!answer || answer->word > text.size()) return {};
  word = answer->word;
  return std::move(answer->names);
}

bool ConsoleSession::has_news() {
  while (std::optional<ConsoleLine> line = link_.next(0)) news_.push_back(std::move(*line));
  return !news_.empty();
}

void ConsoleSession::show_news() {
  for (const ConsoleLine& line : news_) show(line);
  news_.clear();
}

void ConsoleSession::show(const ConsoleLine& line) const {
  switch (line.kind) {
    case Kind::value:
      print_result("{}\n", line.text);
      break;
    case Kind::print:
      if (line.id == asked_) {
        print_result("{}\n", line.text);
      } else {
        write_line(OutputTo::error, line.text);
      }
      break;
    case Kind::error:
    case Kind::refused:
      write_line(OutputTo::error, line.text);
      break;
    case Kind::warning:
      print_notice("warning: {}", line.text);
      break;
    case Kind::fault:
      print_notice("error: {}", line.text);
      break;
    case Kind::missed:
      write_line(OutputTo::error, fmt::format("({} lines are left out here: too much was said)", line.count));
      break;
    default:
      return;  // nothing to see
  }
}

}  // namespace limber
