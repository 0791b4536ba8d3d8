// FaultList: current warnings and errors. The errors of a script file are removed when it runs again without errors.
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "base/log/log.h"

namespace limber {

/// One warning or error.
struct Fault {
  LogLine line;
  std::string file;      ///< File named at the beginning of an error; otherwise empty.
  std::string location;  ///< "scripts/a.lua:12", or empty.
};
/// Parses the file and line at the beginning of the text.
Fault parse_fault(const LogLine& line);

class FaultList {
 public:
  static constexpr std::size_t kMaxFaults = 500;  ///< If there are more, the oldest is removed.

  /// Adds a log line; a line that reports a file as fixed (kResolvedSuffix) removes that file's errors.
  void add(const LogLine& line);
  void clear() { faults_.clear(); }
  const std::deque<Fault>& faults() const { return faults_; }
  /// Number of errors without warnings.
  std::size_t error_count() const;
  /// Returns "2", "2 + 1 warning", "3 warnings" or "".
  std::string count_text() const;

 private:
  std::deque<Fault> faults_;
};

}  // namespace limber
