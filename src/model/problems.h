// Problems: collects the problems found in one file, and their log messages. The list is bounded, so that a hostile
// file can't exhaust memory.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/utf8.h"
#include "model/body_model.h"

namespace limber::model {

class Problems {
 public:
  static constexpr std::size_t kMaxProblems = 300;
  static constexpr std::size_t kMaxTextBytes = 600;  ///< Longest text; longer ones are cut off.

  void note(int line, std::string text, std::string fix) { add(line, Severity::note, std::move(text), std::move(fix)); }
  void warning(int line, std::string text, std::string fix) {
    add(line, Severity::warning, std::move(text), std::move(fix));
  }
  void error(int line, std::string text, std::string fix) {
    add(line, Severity::error, std::move(text), std::move(fix));
  }

  /// Moves the collected problems out, in order. If there were more than kMaxProblems, a last entry gives their number.
  std::vector<Problem> release() {
    if (dropped_ > 0) {
      list_.push_back({last_line_, Severity::warning, std::to_string(dropped_) + " more problems are not listed",
                       "Fix the ones above and import again."});
    }
    dropped_ = 0;
    return std::move(list_);
  }
  const std::vector<Problem>& list() const { return list_; }

 private:
  static std::string shortened(std::string text) {
    if (text.size() <= kMaxTextBytes) return text;
    return std::string(utf8_prefix(text, kMaxTextBytes)) + "…";
  }
  void add(int line, Severity severity, std::string text, std::string fix) {
    if (list_.size() < kMaxProblems) {
      list_.push_back({line, severity, shortened(std::move(text)), shortened(std::move(fix))});
    } else {
      ++dropped_;
      last_line_ = line;
    }
  }

  std::vector<Problem> list_;
  std::size_t dropped_ = 0;
  int last_line_ = 0;
};

/// Returns log messages about the problems of a loaded model: one line for each kind of warning and error, "file:line:
/// text. fix", with the number of further problems of that kind, which differ only in names and numbers. Notes are
/// omitted; `limber inspect` prints them. [any]
std::vector<std::string> load_messages(const BodyModel& model);

}  // namespace limber::model
