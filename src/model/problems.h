// Collects the complaints about one file, bounded, so that a hostile file can't fill the memory with them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "model/body_model.h"

namespace limber {

class Problems {
 public:
  static constexpr std::size_t kMost = 300;
  static constexpr std::size_t kMostBytes = 600;  ///< Of one text; the rest of it is cut off.

  void note(int line, std::string text, std::string cure) {
    add(line, Severity::note, std::move(text), std::move(cure));
  }
  void warning(int line, std::string text, std::string cure) {
    add(line, Severity::warning, std::move(text), std::move(cure));
  }
  void error(int line, std::string text, std::string cure) {
    add(line, Severity::error, std::move(text), std::move(cure));
  }

  /// Everything that was added, in order; past the first 300, one line says how many more there were.
  std::vector<Problem> take() {
    if (dropped_ > 0) {
      list_.push_back({last_line_, Severity::warning, std::to_string(dropped_) + " more complaints are not listed",
                       "Mend the ones above and import again."});
    }
    dropped_ = 0;
    return std::move(list_);
  }
  const std::vector<Problem>& list() const { return list_; }

 private:
  static std::string shortened(std::string text) {
    if (text.size() <= kMostBytes) return text;
    std::size_t end = kMostBytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) --end;
    return text.substr(0, end) + "…";
  }
  void add(int line, Severity severity, std::string text, std::string cure) {
    if (list_.size() < kMost) {
      list_.push_back({line, severity, shortened(std::move(text)), shortened(std::move(cure))});
    } else {
      ++dropped_;
      last_line_ = line;
    }
  }

  std::vector<Problem> list_;
  std::size_t dropped_ = 0;
  int last_line_ = 0;
};

}  // namespace limber
