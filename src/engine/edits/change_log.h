// ChangeLog: recent changes of values: source, path, old and new value. The simulation writes, monitors read. [any]
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace limber::engine {

struct ChangeEntry {
  std::uint64_t number = 0;  ///< Counts from 1.
  double time = 0;           ///< Time of the last change, system::clock_seconds().
  std::string source;        ///< The source, formatted by sender_text().
  std::string path;
  std::string from, to;       ///< Formatted by value_text(); of merged changes the first old and the last new value.
  std::uint64_t version = 0;  ///< Version of the log when the line was added or updated.
};

class ChangeLog {
 public:
  static constexpr std::size_t kMaxEntries = 4096;

  /// Adds a line and drops the oldest if there are too many. Returns its number.
  std::uint64_t add(ChangeEntry entry);
  /// Updates time and new value of a line. Returns false if the line was dropped.
  bool update(std::uint64_t number, double time, std::string to);
  /// Returns the lines added or updated after that version, in that order.
  std::vector<ChangeEntry> after(std::uint64_t version) const;
  /// Returns the lines with this time or a later one, oldest first.
  std::vector<ChangeEntry> since(double time) const;

 private:
  mutable std::mutex mutex_;
  std::deque<ChangeEntry> entries_;
  std::uint64_t newest_ = 0;
  std::uint64_t versions_ = 0;
};

}  // namespace limber::engine
