// ErrorList: current warnings and errors. The errors of a script file are removed when it runs again without errors.
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "base/log/log.h"

namespace limber::panel {

/// One warning or error.
struct ErrorEntry {
  LogLine line;
  std::string file;      ///< File named at the beginning of an error; otherwise empty.
  std::string location;  ///< "scripts/a.lua:12", or empty.
};
/// Parses the file and line at the beginning of the text.
ErrorEntry parse_error_line(const LogLine& line);

class ErrorList {
 public:
  static constexpr std::size_t kMaxEntries = 500;  ///< If there are more, the oldest is removed.

  /// Adds a log line; a line that reports a file as fixed (kResolvedSuffix) removes that file's errors.
  void add(const LogLine& line);
  void clear() { entries_.clear(); }
  const std::deque<ErrorEntry>& entries() const { return entries_; }
  /// Number of errors without warnings.
  std::size_t error_count() const;
  /// Returns "2", "2 + 1 warning", "3 warnings" or "".
  std::string count_text() const;

 private:
  std::deque<ErrorEntry> entries_;
};

}  // namespace limber::panel
