// FaultList: warnings and errors that stand. Those of a file vanish when it is mended.
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "base/log.h"

namespace limber {

struct Fault {
  LogLine line;
  std::string file;   ///< Of an error that begins with one; else empty.
  std::string place;  ///< "scripts/a.lua:12", or empty.
};
/// Reads the place off the text's beginning.
Fault fault_of(const LogLine& line);

class FaultList {
 public:
  static constexpr std::size_t kMost = 500;  ///< The oldest go.

  /// A line of the log; one that says that a file is mended (kMended) takes that file's errors away.
  void hear(const LogLine& line);
  void clear() { faults_.clear(); }
  const std::deque<Fault>& faults() const { return faults_; }
  /// Without warnings.
  std::size_t errors() const;
  /// "2", "2 + 1 warning", "3 warnings", or nothing.
  std::string count_text() const;

 private:
  std::deque<Fault> faults_;
};

}  // namespace limber
