// The log messages group problems by their wording.
#include "model/problems.h"

#include <cctype>
#include <map>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::model {

namespace {

// the text without quoted names and numbers, as the grouping key
std::string grouping_key(std::string_view text) {
  std::string out;
  bool quoted = false;
  for (const char c : text) {
    const bool edge = c == '\'';
    if (edge) quoted = !quoted;
    if (edge || (!quoted && std::isdigit(static_cast<unsigned char>(c)) == 0)) out += c;
  }
  return out;
}

}  // namespace

std::vector<std::string> load_messages(const BodyModel& model) {
  struct Kind {
    const Problem* first;
    std::size_t more;
  };
  std::vector<Kind> kinds;
  std::map<std::string, std::size_t> index_by_key;
  for (const Problem& problem : model.problems) {
    if (problem.severity == Severity::note) continue;
    const auto [at, is_new] = index_by_key.try_emplace(grouping_key(problem.text), kinds.size());
    if (is_new) {
      kinds.push_back({&problem, 0});
    } else {
      ++kinds[at->second].more;
    }
  }
  std::vector<std::string> lines;
  for (const Kind& kind : kinds) {
    const Problem& problem = *kind.first;
    const std::string more =
        kind.more > 0 ? fmt::format(" … and {} more of this kind (limber inspect lists them)", kind.more) : "";
    lines.push_back(
        fmt::format("{}:{}: {}{}. {}", printable(model.file), problem.line, problem.text, more, problem.fix));
  }
  return lines;
}

}  // namespace limber::model
